//! Makes an image that does not repeat into a seamless tile, and reports the changes.
//!
//! Instead of a photograph, the example uses a crop of a paving with light that fades to the right. To read your own
//! photograph, use `dapple::image::read_image("photo.png", &Default::default())?.color()?`.
//!
//! ```sh
//! cargo run -p dapple --example 07_make_a_photo_tile
//! ```
#![expect(clippy::print_stdout, reason = "an example talks")]

mod out;

use dapple::color::LinearRgb;
use dapple::image::{Depth, write_color_png};
use dapple::raster::Raster;
use dapple::recipe::{Images, Plan, Recipe};
use dapple::tile::{Method, SeamOptions, SeamReport, Seamless, SoftCut};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let photo = photo()?;

    // First take the periodic part, which evens out the light. Then overlap a margin of 48 pixels with the opposite
    // side, and cut it where the cut is least visible.
    let even = Seamless::new(Method::Periodic).apply_color(&photo)?;
    let cut = SoftCut {
        margin: Some(48),
        ..SoftCut::default()
    };
    let tile = Seamless::new(Method::SoftCut(cut)).apply_color(&even)?;

    // Measure differences across the seam relative to differences inside, at four distances, and the preserved
    // detail.
    let [before, after] = [&photo, &tile].map(|picture| picture.map(|color| color.luminance()));
    let options = SeamOptions::default();
    println!("before:\n{}\n", SeamReport::of(&before, &options)?);
    println!("after:\n{}", SeamReport::beside(&before, &after, &options)?);

    // Two copies in each direction make seams visible.
    for (name, picture) in [("before", &photo), ("after", &tile)] {
        let path = out::path(&format!("07_make_a_photo_tile_{name}.png"))?;
        write_color_png(&path, &picture.tile([2, 2])?, Depth::Eight)?;
        out::wrote(&path);
    }
    Ok(())
}

fn photo() -> Result<Raster<LinearRgb>, Box<dyn std::error::Error>> {
    let plan = Plan::new(&Recipe::builtin("flagstone")?, &Images::new(), 0.0)?;
    let whole = plan.window([512, 512])?;
    let paving = plan.colors("albedo")?;
    let paving = paving.to_raster(&whole.crop([40, 70], [320, 320])?)?;
    let light = |x: u32| 1.0 - 0.2 * x as f32 / 320.0;
    Ok(Raster::from_fn(paving.size(), |x, y| {
        paving.row(y)[x as usize] * light(x)
    })?)
}
