//! Renders cracked ground as game textures: color and normals with mip levels, in bytes for a GPU. It tiles exactly.
//!
//! ```sh
//! cargo run -p dapple --example 15_cracked_ground
//! ```

mod out;

use dapple::color::{
    ColorRamp, HeightPlane, LinearRgb, Normal, NormalOptions, TextureRaster as _, normal_map,
};
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png, write_normal_png};
use dapple::noise::GradientNoise2;
use dapple::raster::{FractalShape, Wrap, prelude::*};
use dapple::worley::{Combination, Worley2};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Returns the heights of ground that repeats with a period of one unit.
fn ground(seed: Seed) -> Result<impl Field> {
    let plates = Worley2::new(seed.child("plates", 0)).with_period([Some(6); 2])?;
    // 0 in the cracks between plates and 1 inside the plates.
    let plates = plates.combine(Combination::F2_MINUS_F1).frequency(6.0);
    let flat = plates.mul(8.0).min(1.0);
    let rough = GradientNoise2::new(seed.child("rough", 0)).with_period([Some(8); 2])?;
    let rough = rough
        .fractal(5, 0.5, 2.0, FractalShape::Sum)?
        .frequency(8.0);
    Ok(flat.add(rough.mul(0.15)))
}

/// Returns the color and the normals of the ground.
fn maps(seed: Seed, size: u32) -> Result<(Raster<LinearRgb>, Raster<Normal>)> {
    let window = Window::unit([size; 2])?;
    let heights = ground(seed)?.to_raster(&window)?;
    let colors = ColorRamp::from_hex(&["#1c130d", "#6f5233", "#a9875a"])?.apply(&heights);
    // Both axes wrap, since the heights repeat.
    let plane = HeightPlane {
        strength: 0.02,
        ..HeightPlane::for_window(&window, [Wrap::Repeat; 2])
    };
    let normals = normal_map(&heights, &NormalOptions::from(plane))?;
    Ok((colors, normals))
}

fn main() -> Result<()> {
    let (colors, normals) = maps(Seed(7), 512)?;
    // Data of the GPU textures: `Rgba8UnormSrgb` and `Rgba8Unorm`.
    let colors_of_levels: Vec<Vec<u8>> = (colors.mip_levels()?.iter())
        .map(Raster::to_rgba8_srgb)
        .collect();
    let normals_of_levels: Vec<Vec<u8>> = (normals.mip_levels()?.iter())
        .map(Raster::to_rgba8)
        .collect();
    assert_eq!(
        colors_of_levels.len(),
        normals_of_levels.len(),
        "both maps have the same levels"
    );

    let path = out::path("15_cracked_ground_color.png")?;
    write_color_png(&path, &colors, Depth::Eight)?;
    out::wrote(&path);
    let path = out::path("15_cracked_ground_normal.png")?;
    write_normal_png(&path, &normals, Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{ground, maps};
    use dapple::color::TextureRaster as _;
    use dapple::hash::Seed;
    use dapple::raster::prelude::*;

    #[test]
    fn the_ground_repeats_and_has_bytes_for_all_levels() {
        let field = ground(Seed(7)).unwrap();
        assert_eq!(field.period(), [Some(1.0); 2]);
        assert_eq!(field.sample([0.125, 0.75]), field.sample([3.125, -4.25]));
        let (colors, normals) = maps(Seed(7), 128).unwrap();
        let levels = colors.mip_levels().unwrap();
        let lengths: Vec<_> = levels
            .iter()
            .map(|level| level.to_rgba8_srgb().len())
            .collect();
        assert_eq!(lengths, [65536, 16384, 4096, 1024, 256, 64, 16, 4]);
        // Cracks are steep, and plates are not.
        let up = normals.pixels().iter().map(|normal| normal.z);
        let [steepest, flattest] = [up.clone().fold(1.0, f32::min), up.fold(0.0, f32::max)];
        assert!(
            steepest < 0.8 && flattest > 0.95,
            "{steepest} and {flattest}"
        );
    }
}
