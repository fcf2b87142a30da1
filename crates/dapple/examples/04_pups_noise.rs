//! Renders noise from scattered control points (partition-of-unity parametrics): five octaves as a terrain, with its
//! normal map.
//!
//! ```sh
//! cargo run -p dapple --example 04_pups_noise
//! ```

mod out;

use dapple::color::{HeightPlane, Palette, normal_map};
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png, write_normal_png};
use dapple::points::Domain;
use dapple::pups::{OctavesOptions, octaves};
use dapple::raster::{Field, Window, Wrap, glam::DVec2};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Control points are at least 0.2 apart in the first octave. Each further octave has half the distance and half the
    // amplitude.
    let options = OctavesOptions {
        domain: Domain::torus(DVec2::ZERO, DVec2::ONE),
        spacing: 0.2.into(),
        octaves: 5,
        ..OctavesOptions::default()
    };
    let window = Window::unit([512, 512])?;
    let noise = octaves(&options, Seed(7))?.normalized();
    let height = noise.to_raster(&window)?;

    // Most values are in the middle of the range, so spread the colors over this part.
    let land = height.map(|&height| 0.5 + 2.0 * (height - 0.5));
    let path = out::path("04_pups_noise.png")?;
    write_color_png(&path, &Palette::Terrain.ramp().apply(&land), Depth::Eight)?;
    out::wrote(&path);

    // A height of 1 is a tenth of the tile. The map repeats because the height repeats.
    let plane = HeightPlane {
        strength: 0.1,
        ..HeightPlane::for_window(&window, [Wrap::Repeat; 2])
    };
    let path = out::path("04_pups_noise_normal.png")?;
    write_normal_png(&path, &normal_map(&height, &plane.into())?, Depth::Eight)?;
    out::wrote(&path);
    Ok(())
}
