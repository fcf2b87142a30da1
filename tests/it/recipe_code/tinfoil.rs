//! tinfoil.
//!
//! Crinkled foil: Worley's fractal F1 as a relief, as for crumpled paper, but sharper, finer and on a mirror.
//!
//! The tile is 4 × 4 units of the plane. Made from a recipe; needs the crate `dapple`.

use dapple::color::LinearRgb;
use dapple::recipe;
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
    let seed = Seed(31);
    let front_field = worley::Worley4::new(seed.child("front", 0)).with_period([Some(8), Some(8), None, Some(1)])?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 3, gain: 0.36, ..worley::Octaves::default() })?;
    let back_field = worley::Worley4::new(seed.child("back", 0)).with_period([Some(8), Some(8), None, Some(1)])?.combine(worley::Combination::F1).fractal(worley::Octaves { count: 3, gain: 0.36, ..worley::Octaves::default() })?;
    let sheet_field = worley::Worley4::new(seed.child("sheet", 0)).with_period([Some(2), Some(2), None, Some(1)])?.combine(worley::Combination::F1);
    let roll_field = worley::Worley2::new(seed.child("roll", 0)).with_period([Some(512), Some(4)])?.combine(worley::Combination::F1);
    Ok(move |at: DVec2| {
        let front: f32 = { let p: DVec2 = at * DVec2::new(2.0, 2.0); front_field.value([p.x, p.y, 0.0, 0.0]) };
        let back: f32 = { let p: DVec2 = at * DVec2::new(2.0, 2.0); back_field.value([p.x, p.y, 0.0, 0.0]) };
        let crinkles: f32 = front - back;
        let sheet: f32 = { let p: DVec2 = at * DVec2::new(0.5, 0.5); sheet_field.value([p.x, p.y, 0.0, 0.0]) };
        let sum: f32 = crinkles + sheet;
        let height: f32 = recipe::levels(sum, [-0.42, 1.4], [0.0, 1.0], recipe::LevelsCurve::Linear);
        let roll: f32 = roll_field.sample(at * DVec2::new(128.0, 1.0));
        let albedo: f32 = recipe::levels(roll, [0.0, 1.0], [0.88, 0.78], recipe::LevelsCurve::Linear);
        let roughness: f32 = recipe::levels(roll, [0.0, 1.0], [0.14, 0.36], recipe::LevelsCurve::Linear);
        Surface {
            height,
            albedo: LinearRgb::gray(albedo),
            roughness,
            metallic: 1.0,
        }
    })
}
