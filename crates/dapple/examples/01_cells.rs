//! Renders Worley's cells: the distance from each pixel to the nearest of many scattered points.
//!
//! ```sh
//! cargo run -p dapple --example 01_cells
//! ```

mod out;

use dapple::hash::Seed;
use dapple::image::{Depth, write_gray_png};
use dapple::raster::{Field, Window, glam::DVec2};
use dapple::worley::{Combination, Worley2};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The texture is one line. `F1` is the distance to the nearest point, and `normalized` scales it to 0 to 1.
    let cells = Worley2::new(Seed(7))
        .combine(Combination::F1)
        .normalized()?;

    // A window of 8 × 8 cells, as 512 × 512 pixels.
    let window = Window::new(DVec2::ZERO, DVec2::splat(8.0), [512, 512])?;
    let picture = cells.to_raster(&window)?;

    let path = out::path("01_cells.png")?;
    write_gray_png(&path, &picture, Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}
