//! Lit previews of a baked material, on a plane seen at an angle, a sphere or a torus.

use crate::baking::advise;
use anyhow::{Result, bail};
use dapple::color::{LinearRgb, NormalY};
use dapple::points::glam::{DVec2, DVec3, Vec3};
use dapple::preview::{
    Camera, Environment, Light, Material, Mirror, Object, Scene, Shape, Sky, Supersampling, Surface,
};
use dapple::raster::{Raster, Wrap};
use dapple::recipe::{Bake, BakeOptions, Images, MapKind, MapRows, Plan, Recipe};

/// Side of the preview, in pixels.
const SIDE: u32 = 512;
/// Longer side of the baked maps, in pixels.
const TILE: u32 = 512;

/// The maps of a preview. The last four are optional.
const MAPS: [MapKind; 7] = [
    MapKind::Normal,
    MapKind::Albedo,
    MapKind::Orm,
    MapKind::Emission,
    MapKind::Opacity,
    MapKind::Specular,
    MapKind::Clearcoat,
];

/// The color behind transparent parts of a material.
const BEHIND: LinearRgb = LinearRgb::gray(0.25);

/// Radii of the torus: from its center to the middle of the tube, and of the tube.
const RING: [f64; 2] = [0.9, 0.4];

dapple::raster::named! {
    /// The shape with the material.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(crate) enum Thing {
        /// A plane of 2 x 2 tiles.
        Plane = "plane",
        /// A ball.
        Sphere = "sphere",
        /// A ring.
        Torus = "torus",
    }
}

/// The baked maps of a tile.
struct Maps {
    normal: Raster<Vec3>,
    albedo: Raster<LinearRgb>,
    /// Occlusion, roughness and metalness, packed in x, y and z.
    orm: Raster<Vec3>,
    emission: Option<Raster<LinearRgb>>,
    emission_strength: f32,
    opacity: Option<Raster<f32>>,
    /// Opacity below which a pixel is not drawn; `None` for alpha blending.
    opacity_cutoff: Option<f32>,
    specular: Option<Raster<f32>>,
    clearcoat: Option<Raster<f32>>,
    /// Number of repeats of the tile along u and v.
    tiles: DVec2,
}

/// Renders the material of a recipe on a shape.
///
/// # Errors
///
/// If the recipe cannot be baked.
pub(crate) fn picture(
    recipe: &Recipe,
    images: &Images,
    time: f64,
    thing: Thing,
) -> Result<Raster<LinearRgb>> {
    let aspect = recipe.extent[0] / recipe.extent[1];
    let (shape, camera, tiles) = match thing {
        Thing::Plane => {
            let half = [aspect.min(1.0), (1.0 / aspect).min(1.0)];
            let camera = Camera::look_at(DVec3::new(0.0, 3.1, 1.9), DVec3::new(0.0, 0.0, 0.06));
            // The longer side of the rectangle has the half-length 1. Repeat the tile twice along each side.
            let tiles = DVec2::new(1.0 / half[0], 1.0 / half[1]);
            (Shape::rectangle(half[0], half[1]), camera, tiles)
        }
        Thing::Sphere => {
            let camera = Camera::look_at(DVec3::new(0.0, 0.6, 3.2), DVec3::ZERO);
            // The equator is twice as long as a meridian from pole to pole. Round the number of tiles around it to a
            // whole number.
            let around = (2.0 / aspect).round().max(1.0);
            (Shape::sphere(1.0), camera, DVec2::new(around, 1.0))
        }
        Thing::Torus => {
            let camera = Camera::look_at(DVec3::new(0.0, 2.6, 2.9), DVec3::ZERO);
            // The circumference of the ring is the circumference of the tube times the ratio of their radii.
            let around = (RING[0] / RING[1] / aspect).round().max(1.0);
            let shape = Shape::torus(RING[0], RING[1]);
            (shape, camera, DVec2::new(around, 1.0))
        }
    };
    let maps = Maps::bake(recipe, images, time, tiles)?;
    let sky = Sky {
        nadir: LinearRgb::gray(0.03),
        horizon: LinearRgb::gray(0.5),
        zenith: LinearRgb::new(0.25, 0.35, 0.55),
    };
    let scene = Scene::new(camera)
        .with_object(Object::new(shape, move |surface| maps.material(surface)))
        .with_light(Light::directional(
            DVec3::new(-1.0, 1.3, 0.6),
            LinearRgb::gray(0.95),
        ))
        .with_ambient(LinearRgb::gray(0.18))
        .with_environment(Environment::Sky(sky));
    Ok(scene.render([SIDE; 2], Supersampling(3))?)
}

impl Maps {
    fn bake(recipe: &Recipe, images: &Images, time: f64, tiles: DVec2) -> Result<Self> {
        let mut recipe = recipe.clone();
        recipe.material.normal_y = NormalY::OpenGl;
        let longer = recipe.extent[0].max(recipe.extent[1]);
        let side = |extent: f64| (extent / longer * f64::from(TILE)).round().max(1.0) as u32;
        let size = recipe.extent.map(side);
        let plan = Plan::new(&recipe, images, time).map_err(advise)?;
        let material = &recipe.material;
        let is_there = |&kind: &MapKind| material.has(kind);
        let options = BakeOptions {
            size,
            maps: MAPS.into_iter().filter(is_there).collect(),
            ..BakeOptions::default()
        };
        let bake = Bake::new(&plan, &options).map_err(advise)?;
        let mut maps = bake
            .whole_maps()
            .map_err(advise)?
            .into_iter()
            .map(|(_, map)| map);
        let (
            Some(MapRows::Normal(normal)),
            Some(MapRows::Color(albedo)),
            Some(MapRows::Packed(orm)),
        ) = (maps.next(), maps.next(), maps.next())
        else {
            bail!("a map of the preview was not baked");
        };
        let mut next = |kind| material.has(kind).then(|| maps.next()).flatten();
        let emission = match next(MapKind::Emission) {
            Some(MapRows::Color(emission)) => Some(emission),
            _ => None,
        };
        let mut gray = |kind| match next(kind) {
            Some(MapRows::Gray(numbers)) => Some(numbers),
            _ => None,
        };
        Ok(Self {
            emission,
            emission_strength: material.emission_strength.unwrap_or(1.0) as f32,
            opacity: gray(MapKind::Opacity),
            opacity_cutoff: material.opacity_cutoff.map(|cutoff| cutoff as f32),
            specular: gray(MapKind::Specular),
            clearcoat: gray(MapKind::Clearcoat),
            normal: normal.map(|normal| Vec3::from(normal.to_array())),
            albedo,
            orm: orm.map(|&orm| Vec3::from(orm)),
            tiles,
        })
    }

    /// Returns the material for shading a surface point.
    fn material(&self, surface: &Surface) -> Material {
        let uv = surface.uv().unwrap_or_default() * self.tiles;
        let wrap = [Wrap::Repeat; 2];
        let normal = self.normal.sample_bilinear(uv, wrap);
        let color = self.albedo.sample_bilinear(uv, wrap);
        let [free, roughness, metallic] = self.orm.sample_bilinear(uv, wrap).to_array();
        let gloss = 1.0 - roughness.clamp(0.1, 1.0);
        let rough = roughness.clamp(0.1, 1.0) * roughness.clamp(0.1, 1.0);
        let [right, up] = directions(surface);
        // Limit the slope, which is infinite where a normal is horizontal.
        let slope = normal.as_dvec3() / f64::from(normal.z.max(0.05));
        let number = |map: &Option<Raster<f32>>, default| match map {
            Some(map) => map.sample_bilinear(uv, wrap),
            None => default,
        };
        let specular = number(&self.specular, 1.0);
        let coat = number(&self.clearcoat, 0.0).clamp(0.0, 1.0);
        let metal = metallic * gloss * gloss * 0.6;
        let mirror = match coat > metal {
            true => Mirror::Fresnel(0.04 * coat),
            false => Mirror::Constant(metal),
        };
        let mut material = Material::matte(color * free)
            .with_bump(-slope.x * right - slope.y * up)
            .with_specular(
                gloss * (0.1 * specular + 0.6 * metallic),
                2.0 / (rough * rough),
            )
            .with_mirror(mirror);
        if let Some(emission) = &self.emission {
            let emission = emission.sample_bilinear(uv, wrap) * self.emission_strength;
            material = material.with_emission(emission);
        }
        let opacity = number(&self.opacity, 1.0);
        let opacity = match self.opacity_cutoff {
            Some(cutoff) => f32::from(u8::from(opacity >= cutoff)),
            None => opacity.clamp(0.0, 1.0),
        };
        see_through(material, opacity)
    }
}

/// Returns a material blended with the gray of [`BEHIND`] by its opacity, as if a gray wall was directly behind the
/// surface.
fn see_through(material: Material, opacity: f32) -> Material {
    if opacity >= 1.0 {
        return material;
    }
    let behind = BEHIND * (1.0 - opacity);
    Material {
        color: material.color * opacity,
        emission: material.emission * opacity + behind,
        bump: material.bump * f64::from(opacity),
        specular: material.specular * opacity,
        mirror: if opacity > 0.5 {
            material.mirror
        } else {
            Mirror::None
        },
        ..material
    }
}

/// Returns the unit vectors in which the maps' right and up directions point at a surface point.
fn directions(surface: &Surface) -> [DVec3; 2] {
    let at = surface.position;
    let outward = DVec2::new(at.x, at.z).length();
    if surface.normal.y.abs() > 0.999_999 || outward == 0.0 {
        return [DVec3::X, -DVec3::Z];
    }
    let right = DVec3::new(at.z, 0.0, -at.x) / outward;
    [right, surface.normal.cross(right)]
}
