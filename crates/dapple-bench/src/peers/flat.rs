//! The crate `texture-synthesis` with its defaults, on one thread, where its result is deterministic.
//!
//! It starts its own thread, so it is timed by the processor time of this process, in which nothing else runs.

use anyhow::Result;
use cpu_time::ProcessTime;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use std::hint::black_box;
use texture_synthesis::image::{DynamicImage, Rgba, RgbaImage};
use texture_synthesis::{Dims, Example, Session};

/// Makes a flat square image that looks like an exemplar; returns the processor time in seconds and the image.
pub(crate) fn synthesize(
    exemplar: &Raster<LinearRgb>,
    side: u32,
) -> Result<(f64, Raster<LinearRgb>)> {
    let [width, height] = exemplar.size();
    let image = RgbaImage::from_fn(width, height, |column, row| {
        let [red, green, blue] = exemplar.row(row)[column as usize].to_srgb::<u8>();
        Rgba([red, green, blue, u8::MAX])
    });
    let example = Example::new(DynamicImage::ImageRgba8(image));
    let start = ProcessTime::now();
    let session = Session::builder()
        .add_example(example)
        .seed(1)
        .output_size(Dims::square(side))
        .max_thread_count(1)
        .build()?;
    let made = black_box(session.run(None).into_image()).to_rgba8();
    let seconds = start.elapsed().as_secs_f64();
    let colors = Raster::from_fn([side; 2], |column, row| {
        let [red, green, blue, _] = made.get_pixel(column, row).0;
        LinearRgb::from_srgb([red, green, blue])
    })?;
    Ok((seconds, colors))
}
