//! Blends two materials along the features of one of them: moss grows from the joints between stones, and more so
//! toward the right.
//!
//! ```sh
//! cargo run -p dapple --example 08_blend_materials
//! ```

mod out;

use dapple::color::ColorRamp;
use dapple::hash::Seed;
use dapple::image::{Depth, write_color_png, write_gray_png};
use dapple::raster::{Field, Raster};
use dapple::recipe::{Images, Plan, Recipe};
use dapple::tile::{Blend, BlendMap, Layer, Map, Mixing, Weighting, blend_by_tile, rank_equalize};
use dapple::wavelet::wavelet_tile;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A material is a list of maps: here a color and a height. The stones come from a recipe.
    let plan = Plan::new(&Recipe::builtin("flagstone")?, &Images::new(), 0.0)?;
    let window = plan.window([512, 512])?;
    let stones = plan.height()?.to_raster(&window)?;
    let stone_color = plan.colors("albedo")?.to_raster(&window)?;

    // The moss is noise.
    let grain = wavelet_tile(window.size, &[0.5, 1.0, 0.5], Seed(8))?;
    let moss = grain.map(|value| 0.5 + 0.12 * value);
    let moss_color = ColorRamp::from_hex(&["#16240d", "#4d6b22", "#a2b552"])?.apply(&moss);

    // The mask is low in the joints, and the fraction of its pixels below any threshold equals the threshold.
    let mask = rank_equalize(&BlendMap::new(56.0).apply(&stones)?)?;
    let of_moss = Raster::from_window(&window, |at| (at.x / plan.extent().x) as f32)?;
    let of_stone = of_moss.map(|moss| 1.0 - moss);

    let moss = [Map::Color(moss_color), Map::Value(moss)];
    let stone = [Map::Color(stone_color), Map::Value(stones)];
    let layers = [
        Layer {
            maps: &moss,
            weight: &of_moss,
            height: None,
        },
        Layer {
            maps: &stone,
            weight: &of_stone,
            height: None,
        },
    ];
    let how = Blend::new(Weighting::Mask { gain: 6.0 }, Mixing::Linear);
    for map in blend_by_tile(&layers, &mask, &how)? {
        match map {
            Map::Color(color) => {
                let path = out::path("08_blend_materials.png")?;
                write_color_png(&path, &color, Depth::Eight)?;
                out::wrote(&path);
            }
            Map::Value(height) => {
                let path = out::path("08_blend_materials_height.png")?;
                write_gray_png(&path, &height, Depth::Sixteen)?;
                out::wrote(&path);
            }
            Map::Normal(_) => {}
        }
    }
    Ok(())
}
