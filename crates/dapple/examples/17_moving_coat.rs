//! Renders an animal coat as a looping animation of 24 frames; the last frame leads back to the first.
//!
//! ```sh
//! cargo run -p dapple --example 17_moving_coat
//! ```

mod out;

use dapple::color::Palette;
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png};
use dapple::pups::{CellsOptions, Orbits, cells};
use dapple::raster::{Raster, prelude::*};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Number of frames in the loop.
const N_FRAMES: u32 = 24;

/// Returns the values of the coat in a frame of the loop.
fn frame(index: u32, size: u32) -> Result<Raster<f32>> {
    let mut options = CellsOptions::of_three_or_four();
    options.spacing = 0.2.into();
    // Each control point makes one orbit around its position per loop.
    options.net.motion = Some(Orbits { radius: 0.25 });
    options.net.time = f64::from(index) / f64::from(N_FRAMES);
    let domain = options.domain;
    let window = Window::new(domain.origin, domain.size, [size; 2])?;
    Ok(cells(&options, Seed(7))?.to_raster(&window)?)
}

fn main() -> Result<()> {
    for index in [0, N_FRAMES / 4, N_FRAMES / 2] {
        let colors = Palette::Giraffe.ramp().apply(&frame(index, 256)?);
        let path = out::path(&format!("17_moving_coat_{index:02}.png"))?;
        write_color_png(&path, &colors, Depth::Eight)?;
        out::wrote(&path);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{N_FRAMES, frame};

    #[test]
    fn the_loop_closes_and_moves_a_little_in_each_frame() {
        let frames: Vec<_> = (0..=N_FRAMES)
            .map(|index| frame(index, 64).unwrap())
            .collect();
        assert_eq!(frames[0], frames[N_FRAMES as usize]);
        for pair in frames.windows(2) {
            let pixels = pair[0].pixels().iter().zip(pair[1].pixels());
            let n_changed = pixels.filter(|(before, after)| before != after).count();
            // Every frame differs from the previous one, but only slightly: most pixels keep their cell.
            assert!((1..64 * 64 / 2).contains(&n_changed), "{n_changed}");
        }
    }
}
