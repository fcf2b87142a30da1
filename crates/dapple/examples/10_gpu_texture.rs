//! Converts a raster to the layout of a graphics API: the bytes of all mip levels, rows padded to 256 bytes, and the
//! texture format.
//!
//! This needs no engine. `upload/mod.rs` computes the bytes; `tests/gpu/main.rs` of this repository uploads them to a
//! real GPU with `wgpu` and reads them back.
//!
//! ```sh
//! cargo run -p dapple --example 10_gpu_texture
//! ```
#![expect(clippy::print_stdout, reason = "an example talks")]

mod out;
mod upload;

use dapple::color::{HeightPlane, Palette, normal_map};
use dapple::hash::Seed;
use dapple::image::{Transfer, write_png};
use dapple::pups::{CellsOptions, cells};
use dapple::raster::{Field, Raster, Window, Wrap};
use upload::Upload;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = CellsOptions::default();
    let domain = options.domain;
    let window = Window::new(domain.origin, domain.size, [256, 256])?;
    let values = cells(&options, Seed(7))?.to_raster(&window)?;
    let upload = Upload::color(&Palette::Ember.ramp().apply(&values))?;
    let normals = normal_map(
        &values,
        &HeightPlane::for_window(&window, [Wrap::Repeat; 2]).into(),
    )?;
    for upload in [&upload, &Upload::normal(&normals)?] {
        tell(upload);
    }

    // Place the levels next to each other, read from their bytes.
    let widths: Vec<u32> = upload.levels.iter().map(|level| level.size[0]).collect();
    let mut picture = Raster::filled([widths.iter().sum(), 256], [0, 0, 0, 0])?;
    let mut left = 0;
    for level in &upload.levels {
        for (y, row) in (0..).zip(level.rows()) {
            let mut rows = picture.view_mut();
            let place = rows.row_mut(y)[left..].iter_mut();
            for (pixel, codes) in place.zip(row.chunks_exact(4)) {
                pixel.copy_from_slice(codes);
            }
        }
        left += level.size[0] as usize;
    }
    let path = out::path("10_gpu_texture.png")?;
    write_png(&path, picture.view(), Transfer::Srgb)?;
    out::wrote(&path);
    Ok(())
}

fn tell(upload: &Upload) {
    println!(
        "{:?}, with a sampler that repeats along both axes:",
        upload.format
    );
    for (number, level) in upload.levels.iter().enumerate() {
        let [width, height] = level.size;
        let (row, all) = (level.bytes_per_row, level.bytes.len());
        println!("  level {number}: {width} × {height}, {row} bytes a row, {all} in all");
    }
}
