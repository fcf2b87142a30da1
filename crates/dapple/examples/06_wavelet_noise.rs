//! Renders wavelet noise in bands of one octave each, so that nothing flickers if distant views omit a band.
//!
//! ```sh
//! cargo run -p dapple --example 06_wavelet_noise
//! ```

mod out;

use dapple::hash::Seed;
use dapple::image::{Depth, write_gray_png};
use dapple::raster::{Field, Window, glam::DVec2};
use dapple::wavelet::WaveletNoise2;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A tile of 16 × 16 cells, in four bands. Each band has twice the frequency of the previous one.
    let weights = [1.0, 0.6, 0.36, 0.2];
    let noise = WaveletNoise2::new(16, Seed(7))?.with_weights(&weights)?;
    let window = Window::new(DVec2::ZERO, DVec2::splat(16.0), [512, 512])?;
    let values = noise.to_raster(&window)?;

    // Values are nearly normally distributed around 0, and their variance is the sum of the squared weights. Map
    // three standard deviations on both sides to the range of the file.
    let variance: f32 = weights.iter().map(|weight| weight * weight).sum();
    let gray = values.map(|value| 0.5 + value / (6.0 * variance.sqrt()));

    let path = out::path("06_wavelet_noise.png")?;
    write_gray_png(&path, &gray, Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}
