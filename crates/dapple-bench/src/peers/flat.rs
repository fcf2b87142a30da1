//! Runs the crate `texture-synthesis` with its defaults, on one thread, where its result is deterministic.
//!
//! It starts its own thread, so it is timed by the processor time of this process, in which nothing else runs.

use anyhow::Result;
use cpu_time::ProcessTime;
use dapple_color::LinearRgb;
use dapple_raster::Raster;
use std::hint::black_box;
use texture_synthesis::image::{DynamicImage, Rgba, RgbaImage};
use texture_synthesis::{Dims, Example, Session, SessionBuilder};

/// Synthesizes a flat square image that resembles `exemplar`. Returns the processor time in seconds and the image.
pub(crate) fn synthesize(
    exemplar: &Raster<LinearRgb>,
    side: u32,
) -> Result<(f64, Raster<LinearRgb>)> {
    let example = Example::new(image(exemplar));
    run(Session::builder()
        .add_example(example)
        .output_size(Dims::square(side)))
}

/// Converts an image to the peer's type.
pub(crate) fn image(colors: &Raster<LinearRgb>) -> DynamicImage {
    let [width, height] = colors.size();
    DynamicImage::ImageRgba8(RgbaImage::from_fn(width, height, |column, row| {
        let [red, green, blue] = colors.row(row)[column as usize].to_srgb::<u8>();
        Rgba([red, green, blue, u8::MAX])
    }))
}

/// Runs a synthesis session. Returns its processor time in seconds and the image.
pub(crate) fn run(session: SessionBuilder<'_>) -> Result<(f64, Raster<LinearRgb>)> {
    let start = ProcessTime::now();
    let session = session.seed(1).max_thread_count(1).build()?;
    let made = black_box(session.run(None).into_image()).to_rgba8();
    let seconds = start.elapsed().as_secs_f64();
    let (width, height) = made.dimensions();
    let colors = Raster::from_fn([width, height], |column, row| {
        let [red, green, blue, _] = made.get_pixel(column, row).0;
        LinearRgb::from_srgb([red, green, blue])
    })?;
    Ok((seconds, colors))
}
