//! spaceship-hull.
//!
//! The plating of a spaceship: Worley's cells in the Manhattan metric, with channels at right angles between plates.
//!
//! The tile is 4 × 4 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::{self, LinearRgb};
use dapple::recipe;
use dapple::wavelet;
use dapple::worley;
use dapple::hash::Seed;
use dapple::raster::Field as _;
use dapple::raster::glam::DVec2;

/// What a material is at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The height, from 0 to 1 where the recipe keeps to it.
    pub height: f32,
    /// The color, linear.
    pub albedo: LinearRgb,
    /// From 0, a mirror, to 1, chalk.
    pub roughness: f32,
    /// From 0, no metal, to 1, all metal.
    pub metallic: f32,
}

/// The material at every position of the plane.
///
/// # Errors
///
/// If a number of the recipe is out of its range.
pub fn material()
-> Result<impl Fn(DVec2) -> Surface + Send + Sync, Box<dyn std::error::Error + Send + Sync>> {
    let seed = Seed(30);
    let boxes_field = worley::Worley2::new(seed.child("boxes", 0)).with_period([Some(32), Some(32)])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Jittered { jitter: 0.5 })?.combine(worley::Combination::F1);
    let plate_field = worley::Worley2::new(seed.child("channel", 0)).with_period([Some(4), Some(4)])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.cell_values();
    let panel_field = worley::Worley2::new(seed.child("seam", 0)).with_period([Some(16), Some(16)])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.cell_values();
    let seam_field = worley::Worley2::new(seed.child("seam", 0)).with_period([Some(16), Some(16)])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.combine(worley::Combination::F2_MINUS_F1);
    let channel_field = worley::Worley2::new(seed.child("channel", 0)).with_period([Some(4), Some(4)])?.with_metric(worley::Metric::Manhattan)?.with_scatter(worley::Scatter::Poisson { density: 1.0 })?.combine(worley::Combination::F2_MINUS_F1);
    let ramp_1 = color::ColorRamp::even(&[LinearRgb::from_srgb([0x7d_u8, 0x82, 0x88]), LinearRgb::from_srgb([0x8c_u8, 0x91, 0x96]), LinearRgb::from_srgb([0x9b_u8, 0x9f, 0xa3]), LinearRgb::from_srgb([0x86_u8, 0x8a, 0x8c]), LinearRgb::from_srgb([0xa5_u8, 0xa7, 0xa8]), LinearRgb::from_srgb([0x7f_u8, 0x88, 0x90])])?;
    let dirt_field = wavelet::WaveletNoise2::new(4, seed.child("dirt", 0))?.with_weights(&[0.1194295, 0.08360065, 0.05852045, 0.040964317, 0.028675022, 0.020072516, 0.01405076])?;
    Ok(move |at: DVec2| {
        let boxes: f32 = boxes_field.sample(at * DVec2::new(8.0, 8.0));
        let machines: f32 = recipe::levels(boxes, [0.34, 0.3], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let floor: f32 = machines * 0.12;
        let plate: f32 = plate_field.sample(at);
        let step: f32 = recipe::levels(plate, [0.0, 1.0], [0.2, 0.5], recipe::LevelsCurve::Linear);
        let panel: f32 = panel_field.sample(at * DVec2::new(4.0, 4.0));
        let tier: f32 = recipe::levels(panel, [0.0, 1.0], [0.0, 0.16], recipe::LevelsCurve::Linear);
        let armored: f32 = recipe::levels(plate, [0.3, 0.32], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let panels: f32 = tier * armored;
        let seam: f32 = seam_field.sample(at * DVec2::new(4.0, 4.0));
        let groove: f32 = recipe::levels(seam, [0.03, 0.06], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let lines: f32 = groove * 0.12;
        let bare: f32 = recipe::levels(plate, [0.32, 0.3], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let box_: f32 = machines * bare * 0.14;
        let surface: f32 = step + panels + lines + box_ + 0.1;
        let channel: f32 = channel_field.sample(at);
        let trench: f32 = recipe::levels(channel, [0.035, 0.055], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let height: f32 = recipe::mix(floor, surface, trench);
        let paint: LinearRgb = ramp_1.at(panel);
        let tint: f32 = recipe::levels(plate, [0.0, 1.0], [0.75, 1.1], recipe::LevelsCurve::Linear);
        let dirt: f32 = (0.5 + dirt_field.sample(at)).clamp(0.0, 1.0);
        let grime: f32 = recipe::levels(dirt, [0.2, 0.8], [0.7, 1.1], recipe::LevelsCurve::Linear);
        let painted: LinearRgb = recipe::multiply_colors(recipe::multiply_colors(paint, LinearRgb::gray(tint)), LinearRgb::gray(grime));
        let cut: f32 = recipe::minimum(trench, groove);
        let albedo: LinearRgb = recipe::mix_colors(LinearRgb::from_srgb([0x47_u8, 0x4b, 0x4f]), painted, cut);
        let polish: f32 = recipe::levels(panel, [0.0, 1.0], [0.3, 0.5], recipe::LevelsCurve::Linear);
        let smear: f32 = recipe::levels(dirt, [0.0, 1.0], [-0.15, 0.2], recipe::LevelsCurve::Linear);
        let roughness: f32 = polish + smear;
        Surface {
            height,
            albedo,
            roughness,
            metallic: 1.0,
        }
    })
}
