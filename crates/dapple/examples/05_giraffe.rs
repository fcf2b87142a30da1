//! Renders a space giraffe's coat: every position of the plane belongs to the control point with the largest weight
//! there.
//!
//! ```sh
//! cargo run -p dapple --example 05_giraffe
//! ```

mod out;

use dapple::color::Palette;
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png};
use dapple::pups::{SpaceGiraffeOptions, space_giraffe};
use dapple::raster::Window;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Spots whose centers are at least 0.25 apart, in a square of two units that repeats.
    let options = SpaceGiraffeOptions {
        spacing: 0.25.into(),
        ..SpaceGiraffeOptions::default()
    };
    let coat = space_giraffe(&options, Seed(7))?;

    // Each pixel has a label, 0 between the spots and 1 on them, which is mapped to a color.
    let domain = options.domain;
    let window = Window::new(domain.origin, domain.size, [512, 512])?;
    let labels = coat.label_raster(&window)?;
    let colors = labels.map(|&label| Palette::Giraffe.color(label));

    let path = out::path("05_giraffe.png")?;
    write_color_png(&path, &colors, Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}
