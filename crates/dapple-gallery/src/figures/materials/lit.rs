//! Lights a baked material as seen straight from above, so that the image repeats as the maps do.

use dapple_color::{LinearRgb, Normal};
use dapple_raster::Raster;
use dapple_recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Plan, Recipe};
use glam::DVec3;

/// Reflectance of a dielectric (any material except metal) at normal incidence.
const DIELECTRIC: f32 = 0.04;

/// Bakes and lights a recipe that needs no images; the image has `size` pixels along its longer side.
pub(crate) fn lit(recipe: &Recipe, size: u32) -> anyhow::Result<Raster<LinearRgb>> {
    let plan = Plan::new(recipe, &Images::new(), 0.0)?;
    let sides = plan.extent() / plan.extent().max_element() * f64::from(size);
    let sides = <[f64; 2]>::from(sides).map(|side| side.round() as u32);
    let (normals, packed, albedo) = maps(&plan, sides)?;
    let surface = normals.zip_map(&packed, |&normal, &orm| (normal, orm))?;
    Ok(surface.zip_map(&albedo, |&(normal, orm), &color| shaded(normal, orm, color))?)
}

/// Maps of a tile: normals; occlusion, roughness and metallic; base color.
type Maps = (Raster<Normal>, Raster<[f32; 3]>, Raster<LinearRgb>);

fn maps(plan: &Plan, size: [u32; 2]) -> anyhow::Result<Maps> {
    let options = BakeOptions {
        size,
        maps: vec![MapKind::Normal, MapKind::Orm, MapKind::Albedo],
        ..BakeOptions::default()
    };
    let maps = Bake::new(plan, &options)?.whole_maps()?;
    let mut maps = maps.into_iter().map(|(_, map)| map);
    match (maps.next(), maps.next(), maps.next()) {
        (
            Some(MapRows::Normal(normals)),
            Some(MapRows::Packed(packed)),
            Some(MapRows::Color(albedo)),
        ) => Ok((normals, packed, albedo)),
        _ => anyhow::bail!("a map was not baked"),
    }
}

/// Returns the light that a point reflects. It is a diffuse part, unless the point is metal, plus a reflection that is
/// blurrier on rough surfaces. `free` is the ambient occlusion.
fn shaded(normal: Normal, [free, roughness, metallic]: [f32; 3], color: LinearRgb) -> LinearRgb {
    let normal = DVec3::from_array(normal.to_array().map(f64::from));
    let toward = DVec3::new(-0.5, 0.6, 0.75).normalize();
    let sun = normal.dot(toward).max(0.0) as f32;
    let scattered = color * ((1.0 - metallic) * (0.9 * sun + 0.3 * free));

    let half = (toward + DVec3::Z).normalize();
    let gloss = 1.0 - roughness.clamp(0.05, 1.0);
    let exponent = libm::exp2f(1.0 + 8.0 * gloss);
    let highlight = 0.1 * exponent * libm::powf(normal.dot(half).max(0.0) as f32, exponent);
    // Direction of the mirror reflection; the eye is above, at Z.
    let mirrored = 2.0 * normal.z * normal - DVec3::Z;
    let sky = (0.6 + 0.4 * (mirrored.y - mirrored.x).clamp(-1.0, 1.0)) as f32;
    let straight = LinearRgb::gray(DIELECTRIC).lerp(color, metallic);
    scattered + straight * (free * (sky + highlight))
}
