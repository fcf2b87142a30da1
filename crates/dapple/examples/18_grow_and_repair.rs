//! Synthesizes a larger texture from a small image, and replaces a scratch in the image with texture.
//!
//! ```sh
//! cargo run -p dapple --example 18_grow_and_repair
//! ```

mod out;

use core::ops::ControlFlow;
use dapple::color::{LinearRgb, Palette};
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png};
use dapple::noise::GradientNoise2;
use dapple::raster::{FractalShape, prelude::*};
use dapple::synth::{Edges, Exemplar, Options, PlaneTexture, synthesize_plane};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Returns a drawn substitute for a photograph with a scratch, and a mask of its clean pixels.
fn photo() -> Result<(Raster<LinearRgb>, Raster<bool>)> {
    let window = Window::new([0.0; 2], [8.0; 2], [64, 64])?;
    let rock = GradientNoise2::new(Seed(7)).fractal(3, 0.5, 2.0, FractalShape::Ridged)?;
    let rock = rock.remap([0.9, 1.75], [0.0, 1.0])?.to_raster(&window)?;
    let mut photo = Palette::Ember.ramp().apply(&rock);
    let clean = Raster::from_fn(photo.size(), |x, y| x.abs_diff(y / 2 + 16) > 2)?;
    for (pixel, &is_clean) in photo.pixels_mut().iter_mut().zip(clean.pixels()) {
        if !is_clean {
            *pixel = LinearRgb::WHITE;
        }
    }
    Ok((photo, clean))
}

/// Returns the photograph without its scratch. All clean pixels are unchanged.
fn repair(photo: &Raster<LinearRgb>, clean: &Raster<bool>) -> Result<Raster<LinearRgb>> {
    let exemplar = Exemplar::new(photo, Edges::Cut)?.with_mask(clean)?;
    let hole = clean.map(|is_clean| !is_clean);
    let options = Options {
        n_levels: 3,
        ..Options::default()
    };
    let texture = PlaneTexture::identity(&exemplar)?;
    let texture = texture.repair(&exemplar, &hole, &options, |_| ControlFlow::Continue(()))?;
    Ok(texture.transfer(photo)?)
}

/// Returns a tile that resembles the photograph, with `size` pixels along each side.
fn grow(photo: &Raster<LinearRgb>, size: u32) -> Result<Raster<LinearRgb>> {
    let exemplar = Exemplar::new(photo, Edges::Cut)?;
    let texture = synthesize_plane(&exemplar, [size; 2], [Edges::Wrap; 2], &Options::default())?;
    Ok(texture.transfer(photo)?)
}

fn main() -> Result<()> {
    let (photo, clean) = photo()?;
    let repaired = repair(&photo, &clean)?;
    let grown = grow(&repaired, 160)?;
    for (name, image) in [
        ("photo", &photo),
        ("repaired", &repaired),
        ("grown", &grown),
    ] {
        let path = out::path(&format!("18_grow_and_repair_{name}.png"))?;
        write_color_png(&path, image, Depth::Eight)?;
        out::wrote(&path);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{grow, photo, repair};
    use dapple::color::LinearRgb;

    #[test]
    fn the_scratch_is_gone_and_the_rest_stays() {
        let (photo, clean) = photo().unwrap();
        let repaired = repair(&photo, &clean).unwrap();
        for ((before, after), &is_clean) in
            (photo.pixels().iter().zip(repaired.pixels())).zip(clean.pixels())
        {
            assert!(if is_clean {
                before == after
            } else {
                *after != LinearRgb::WHITE
            });
        }
        let grown = grow(&repaired, 48).unwrap();
        assert!(
            grown
                .pixels()
                .iter()
                .all(|pixel| repaired.pixels().contains(pixel))
        );
    }
}
