//! Synthesizes a tile of 192 × 192 pixels from an exemplar of 56 × 56 pixels.
//!
//! The exemplar is drawn here; any small image works.
//!
//! ```sh
//! cargo run -p dapple --example 11_synthesize_plane
//! ```

mod out;

use dapple::color::{LinearRgb, Palette};
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png};
use dapple::pups::{CellsOptions, cells};
use dapple::raster::{Field, Raster, Window, glam::DVec2};
use dapple::synth::{Edges, Exemplar, Options, synthesize_plane};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let example = example()?;
    let exemplar = Exemplar::new(&example, Edges::Cut)?;
    let texture = synthesize_plane(&exemplar, [192, 192], [Edges::Wrap; 2], &Options::default())?;

    // A texture maps each pixel to a pixel of the exemplar, so the exemplar's other maps can be transferred in the
    // same way.
    let tile = texture.transfer(&example)?;

    for (name, picture) in [("example", &example), ("tile", &tile)] {
        let path = out::path(&format!("11_synthesize_plane_{name}.png"))?;
        write_color_png(&path, picture, Depth::Eight)?;
        out::wrote(&path);
    }
    Ok(())
}

/// Returns an image of cells, each in a single color. The image does not repeat.
fn example() -> Result<Raster<LinearRgb>, Box<dyn std::error::Error>> {
    let window = Window::new(DVec2::ZERO, DVec2::splat(0.9), [56, 56])?;
    let cells = cells(&CellsOptions::default(), Seed(7))?;
    Ok(Palette::Ember.ramp().apply(&cells.to_raster(&window)?))
}
