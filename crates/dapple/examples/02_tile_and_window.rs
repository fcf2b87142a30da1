//! Renders a texture with a period: an image that repeats exactly, and windows whose pixels equal its crops exactly.
//!
//! The image repeats without blending or mirroring, so it looks equally natural everywhere. With windows, a large
//! image can be rendered in parts, sequentially or on several machines.
//!
//! ```sh
//! cargo run -p dapple --example 02_tile_and_window
//! ```

mod out;

use dapple::color::Palette;
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png};
use dapple::raster::{Field, FieldExt as _, Window, glam::DVec2};
use dapple::worley::{Combination, Worley2};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The texture repeats after 6 cells to the right and 4 cells down.
    let cracks = Worley2::new(Seed(7))
        .with_period([Some(6), Some(4)])?
        .combine(Combination::F2_MINUS_F1)
        .normalized()?;
    let period = DVec2::new(6.0, 4.0);
    let window = Window::new(DVec2::ZERO, period, [384, 256])?;
    let tile = cracks.to_raster(&window)?;

    // All assertions hold bit for bit.
    let position = DVec2::new(1.375, 2.25);
    let [here, further] = [position, position + period].map(|at| cracks.sample(at));
    assert_eq!(here, further, "a period further is the same value");

    let part = cracks.to_raster(&window.crop([100, 40], [200, 150])?)?;
    let crop = tile.crop([100, 40], [200, 150])?;
    assert_eq!(part, crop, "a window is the crop of the whole");

    let four = Window::new(DVec2::ZERO, 2.0 * period, [768, 512])?;
    let copies = tile.tile([2, 2])?;
    assert_eq!(
        cracks.to_raster(&four)?,
        copies,
        "four periods are four tiles"
    );

    let path = out::path("02_tile_and_window.png")?;
    write_color_png(&path, &Palette::Lagoon.ramp().apply(&copies), Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}
