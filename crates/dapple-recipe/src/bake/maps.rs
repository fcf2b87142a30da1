//! Defines the kinds of maps, and computes them for a band.

use super::heights::Margined;
use crate::plan::{TileSamples, Watch};
use crate::{Plan, RecipeError, Values, Whole};
use dapple_color::{
    CurvatureOptions, HeightPlane, LinearRgb, Normal, NormalOptions, OcclusionOptions,
    TexturePixel, TextureRaster as _, ambient_occlusion_of_part_cancellable, curvature_of_part,
    curvature_to_gray, normal_map_of_part,
};
use dapple_raster::{Raster, RasterError, Window, Wrap};
use glam::DVec2;

/// A map of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum MapKind {
    /// The height, from 0 to 1 unless the recipe's values leave this range.
    Height,
    /// The surface normals of the height.
    Normal,
    /// Ambient occlusion, the visible fraction of the sky, from 0 to 1.
    Occlusion,
    /// The curvature as a gray value, which is ½ on flat areas, higher on edges and lower in grooves.
    Curvature,
    /// The base color.
    Albedo,
    /// The roughness, from 0 for a mirror to 1 for chalk.
    Roughness,
    /// The metalness, from 0 for no metal to 1 for pure metal.
    Metallic,
    /// Occlusion, roughness and metalness packed into red, green and blue, as in glTF and game engines.
    Orm,
    /// The emitted light as a color, black by default, without the material's `emission_strength`.
    Emission,
    /// The opacity, from 0 for transparent to 1 for opaque; 1 by default.
    Opacity,
    /// The strength of the specular reflection, from 0 to 1; 1 by default.
    Specular,
    /// The strength of the clear coat, from 0 to 1; 0 by default.
    Clearcoat,
}

/// The side of a map at which another part of it is appended.
#[derive(Clone, Copy, Debug)]
pub(super) enum Side {
    Below,
    Right,
}

/// Consecutive rows of a map, by pixel type.
#[derive(Clone, Debug, PartialEq)]
pub enum MapRows {
    /// Numbers, one per pixel.
    Gray(Raster<f32>),
    /// Colors.
    Color(Raster<LinearRgb>),
    /// Normals.
    Normal(Raster<Normal>),
    /// Three independent numbers per pixel, such as occlusion, roughness and metallic.
    Packed(Raster<[f32; 3]>),
}

impl MapKind {
    /// All map kinds, in the order of their definition.
    pub const ALL: [Self; 12] = [
        Self::Height,
        Self::Normal,
        Self::Occlusion,
        Self::Curvature,
        Self::Albedo,
        Self::Roughness,
        Self::Metallic,
        Self::Orm,
        Self::Emission,
        Self::Opacity,
        Self::Specular,
        Self::Clearcoat,
    ];

    /// Returns the map called `name`, which is its [name](Self::name) or an alias: `basecolor` and `base_color` for
    /// `albedo`, `occlusion` for `ao`.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        match name {
            "basecolor" | "base_color" => Some(Self::Albedo),
            "occlusion" => Some(Self::Occlusion),
            _ => Self::ALL.into_iter().find(|kind| kind.name() == name),
        }
    }

    /// Returns the name of the map in file names and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Height => "height",
            Self::Normal => "normal",
            Self::Occlusion => "ao",
            Self::Curvature => "curvature",
            Self::Albedo => "albedo",
            Self::Roughness => "roughness",
            Self::Metallic => "metallic",
            Self::Orm => "orm",
            Self::Emission => "emission",
            Self::Opacity => "opacity",
            Self::Specular => "specular",
            Self::Clearcoat => "clearcoat",
        }
    }
}

impl Side {
    /// Appends a raster at this side of `other`. Both must have the same width for `Below`, and the same height for
    /// `Right`.
    fn join<T: Copy>(self, raster: Raster<T>, other: &Raster<T>) -> Result<Raster<T>, RasterError> {
        let [width, height] = raster.size();
        match self {
            Self::Below => {
                let size = [width, height.saturating_add(other.height())];
                let mut pixels = raster.into_pixels();
                pixels.extend(other.pixels());
                Raster::from_vec(size, pixels)
            }
            Self::Right => {
                let rows = (0..height).map(|row| [raster.row(row), other.row(row)].concat());
                let size = [width.saturating_add(other.width()), height];
                Raster::from_vec(size, rows.flatten().collect())
            }
        }
    }
}

impl MapRows {
    /// Returns the number of columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Gray(raster) => raster.size(),
            Self::Color(raster) => raster.size(),
            Self::Normal(raster) => raster.size(),
            Self::Packed(raster) => raster.size(),
        }
    }

    /// Converts the rows to the bytes of a GPU texture: 4 bytes per pixel, row by row from the top. Colors are sRGB
    /// encoded (`Rgba8UnormSrgb`); all other maps are linear (`Rgba8Unorm`).
    #[must_use]
    pub fn to_rgba8(&self) -> Vec<u8> {
        match self {
            Self::Gray(raster) => raster.to_rgba8(),
            Self::Color(raster) => raster.to_rgba8_srgb(),
            Self::Normal(raster) => raster.to_rgba8(),
            Self::Packed(raster) => raster.to_rgba8(),
        }
    }

    /// Returns the mip levels of an entire map, as in [`mip_levels`](dapple_color::TextureRaster::mip_levels).
    ///
    /// # Errors
    ///
    /// Same as [`mip_levels`](dapple_color::TextureRaster::mip_levels).
    pub fn mip_levels(&self) -> Result<Vec<Self>, RecipeError> {
        fn levels<T: TexturePixel>(
            raster: &Raster<T>,
            of: fn(Raster<T>) -> MapRows,
        ) -> Result<Vec<MapRows>, RecipeError> {
            Ok(raster.mip_levels()?.into_iter().map(of).collect())
        }
        match self {
            Self::Gray(raster) => levels(raster, Self::Gray),
            Self::Color(raster) => levels(raster, Self::Color),
            Self::Normal(raster) => levels(raster, Self::Normal),
            Self::Packed(raster) => levels(raster, Self::Packed),
        }
    }

    /// Appends `other`, a piece of the same map, at `side`.
    pub(super) fn joined(self, other: Self, side: Side) -> Result<Self, RecipeError> {
        Ok(match (self, other) {
            (Self::Gray(map), Self::Gray(other)) => Self::Gray(side.join(map, &other)?),
            (Self::Color(map), Self::Color(other)) => Self::Color(side.join(map, &other)?),
            (Self::Normal(map), Self::Normal(other)) => Self::Normal(side.join(map, &other)?),
            (Self::Packed(map), Self::Packed(other)) => Self::Packed(side.join(map, &other)?),
            // Not reached: all parts of a map are of one kind.
            (map, _) => map,
        })
    }

    /// Returns `range`, a minimum and a maximum, extended to include the finite values of these rows.
    #[must_use]
    pub fn range(&self, range: [f32; 2]) -> [f32; 2] {
        fn widened(range: [f32; 2], numbers: impl Iterator<Item = f32>) -> [f32; 2] {
            numbers
                .filter(|number| number.is_finite())
                .fold(range, |[min, max], number| {
                    [
                        if number < min { number } else { min },
                        if number > max { number } else { max },
                    ]
                })
        }
        match self {
            Self::Gray(raster) => widened(range, raster.pixels().iter().copied()),
            Self::Color(raster) => widened(
                range,
                raster.pixels().iter().flat_map(|color| color.to_array()),
            ),
            Self::Normal(raster) => widened(
                range,
                raster.pixels().iter().flat_map(|normal| normal.to_array()),
            ),
            Self::Packed(raster) => widened(range, raster.pixels().iter().flatten().copied()),
        }
    }
}

/// Halo of normals. A pixel's normal depends on one column and one row at each side.
pub(super) const NORMAL_HALO: [u32; 2] = [1; 2];

/// Returns the scale of a plan's heights: its relief, and `extent`, the width and height of the tile's pixels in units
/// of the plane. The axes are clamped; wrapping is not needed, because the margin covers all pixels that are read.
fn height_plane(plan: &Plan, extent: DVec2) -> HeightPlane {
    HeightPlane {
        strength: plan.material().relief,
        extent,
        wrap: [Wrap::Clamp; 2],
    }
}

/// Returns a plan's options for ambient occlusion.
pub(super) fn occlusion_options(
    plan: &Plan,
    extent: DVec2,
) -> Result<OcclusionOptions, RecipeError> {
    let material = plan.material();
    let radius = material
        .occlusion_radius
        .unwrap_or(plan.extent().min_element() / 20.0);
    let holds = radius > 0.0 && radius <= plan.extent().max_element();
    RecipeError::check(
        holds,
        "occlusion radius",
        radius,
        "above 0 and at most the extent",
    )?;
    Ok(OcclusionOptions {
        radius,
        plane: height_plane(plan, extent),
        ..OcclusionOptions::default()
    })
}

/// Returns a plan's options for curvature.
pub(super) fn curvature_options(
    plan: &Plan,
    extent: DVec2,
) -> Result<CurvatureOptions, RecipeError> {
    let material = plan.material();
    let radius = material
        .curvature_radius
        .unwrap_or(plan.extent().min_element() / 100.0);
    let holds = radius > 0.0 && radius <= plan.extent().max_element();
    RecipeError::check(
        holds,
        "curvature radius",
        radius,
        "above 0 and at most the extent",
    )?;
    Ok(CurvatureOptions {
        radius,
        plane: height_plane(plan, extent),
    })
}

/// Returns the plan steps of the maps that are not computed from the height, in the order of `kinds`.
pub(super) fn beside_height(plan: &Plan, kinds: &[MapKind]) -> Vec<usize> {
    let channels = plan.channels();
    let of_kind = |kind: &MapKind| match kind {
        MapKind::Albedo => vec![channels.albedo],
        MapKind::Roughness => vec![channels.roughness],
        MapKind::Metallic => vec![channels.metallic],
        MapKind::Orm => vec![channels.roughness, channels.metallic],
        MapKind::Emission => vec![channels.emission],
        MapKind::Opacity => vec![channels.opacity],
        MapKind::Specular => vec![channels.specular],
        MapKind::Clearcoat => vec![channels.clearcoat],
        MapKind::Height | MapKind::Normal | MapKind::Occlusion | MapKind::Curvature => Vec::new(),
    };
    kinds.iter().flat_map(of_kind).collect()
}

/// Computes the maps of a band from its heights and the other steps of the plan.
pub(super) fn maps(
    plan: &Plan,
    whole: &Whole,
    band: &Window,
    tile: &TileSamples,
    heights: &Margined,
    kinds: &[MapKind],
) -> Result<Vec<(MapKind, MapRows)>, RecipeError> {
    let supersample = heights.supersample;
    let wanted = beside_height(plan, kinds);
    let mut values = plan
        .values(whole, &supersample.window(band), &wanted, &heights.shared)?
        .into_iter()
        .map(|values| supersample.average(values, band.size[0]));
    let mut local = || values.next().unwrap_or(Values::Numbers(Vec::new()));
    let mut around = Around {
        plan,
        watch: &whole.watch,
        tile,
        size: band.size,
        heights,
        occlusion: None,
    };
    // Compute occlusion once: it is the slowest, and both `Occlusion` and `Orm` show it.
    let shows_occlusion = |kind: &MapKind| matches!(kind, MapKind::Occlusion | MapKind::Orm);
    if kinds.iter().any(shows_occlusion) {
        around.occlusion = Some(around.make_occlusion()?);
    }
    let mut maps = Vec::with_capacity(kinds.len());
    for &kind in kinds {
        whole.watch.check()?;
        let rows = match kind {
            MapKind::Height => MapRows::Gray(around.height()?),
            MapKind::Normal => MapRows::Normal(around.normal()?),
            MapKind::Occlusion => MapRows::Gray(around.occlusion()?.clone()),
            MapKind::Curvature => MapRows::Gray(around.curvature()?),
            MapKind::Albedo | MapKind::Emission => {
                MapRows::Color(Raster::from_vec(band.size, local().into_colors())?)
            }
            MapKind::Roughness
            | MapKind::Metallic
            | MapKind::Opacity
            | MapKind::Specular
            | MapKind::Clearcoat => {
                MapRows::Gray(Raster::from_vec(band.size, local().into_grays())?)
            }
            MapKind::Orm => {
                let roughness = Raster::from_vec(band.size, local().into_grays())?;
                let metallic = Raster::from_vec(band.size, local().into_grays())?;
                MapRows::Packed(pack(around.occlusion()?, &roughness, &metallic)?)
            }
        };
        maps.push((kind, rows));
    }
    Ok(maps)
}

/// Packs three rasters of equal size into the channels of one.
fn pack(
    red: &Raster<f32>,
    green: &Raster<f32>,
    blue: &Raster<f32>,
) -> Result<Raster<[f32; 3]>, RecipeError> {
    let two = red.zip_map(green, |&red, &green| [red, green])?;
    Ok(two.zip_map(blue, |&[red, green], &blue| [red, green, blue])?)
}

/// Computes the maps of a band that depend on the neighborhood of each pixel, such as normals.
struct Around<'a> {
    plan: &'a Plan,
    watch: &'a Watch,
    tile: &'a TileSamples,
    size: [u32; 2],
    heights: &'a Margined,
    /// Ambient occlusion, computed once for all maps that contain it; `None` if there is no such map.
    occlusion: Option<Raster<f32>>,
}

impl Around<'_> {
    /// Returns the heights with the margin; an error if they have not been computed.
    fn margined(&self) -> Result<&Raster<f32>, RecipeError> {
        foreseen(self.heights.raster.as_ref())
    }

    /// Returns the occlusion; an error if it has not been computed.
    fn occlusion(&self) -> Result<&Raster<f32>, RecipeError> {
        foreseen(self.occlusion.as_ref())
    }

    fn height(&self) -> Result<Raster<f32>, RecipeError> {
        self.within([0; 2])
    }

    /// Returns the heights of the band with a margin of `margin` columns and rows at each side. `margin` is at most the
    /// halo of all maps.
    fn within(&self, margin: [u32; 2]) -> Result<Raster<f32>, RecipeError> {
        let first = [0, 1].map(|axis| self.heights.halo[axis] - margin[axis]);
        let size = [0, 1].map(|axis| self.size[axis] + 2 * margin[axis]);
        Ok(self.margined()?.crop(first, size)?)
    }

    fn normal(&self) -> Result<Raster<Normal>, RecipeError> {
        let material = self.plan.material();
        let options = NormalOptions {
            y: material.normal_y,
            plane: height_plane(self.plan, self.tile.extent),
        };
        let normals =
            normal_map_of_part(&self.within(NORMAL_HALO)?, self.tile.window.size, &options)?;
        Ok(normals.crop(NORMAL_HALO, self.size)?)
    }

    fn make_occlusion(&self) -> Result<Raster<f32>, RecipeError> {
        let (heights, margin) = (self.margined()?, self.heights.halo);
        let options = occlusion_options(self.plan, self.tile.extent)?;
        let size = self.tile.window.size;
        let is_cancelled = || self.watch.is_cancelled();
        let seen =
            ambient_occlusion_of_part_cancellable(heights, margin, size, &options, &is_cancelled);
        seen.map_err(|error| self.watch.reason(error.into()))
    }

    fn curvature(&self) -> Result<Raster<f32>, RecipeError> {
        let options = curvature_options(self.plan, self.tile.extent)?;
        let size = self.tile.window.size;
        let halo = options.halo(size);
        let curved = curvature_of_part(&self.within(halo)?, size, &options)?;
        let gray = curved.map(|&curvature| curvature_to_gray(curvature, options.radius as f32));
        Ok(gray.crop(halo, self.size)?)
    }
}

/// Unwraps a raster that was computed beforehand for several maps of a band. Fails if it is missing.
fn foreseen(raster: Option<&Raster<f32>>) -> Result<&Raster<f32>, RecipeError> {
    raster.ok_or_else(|| {
        let rule = "a map was not foreseen";
        RecipeError::new(crate::RecipeErrorKind::Conflict { rule })
    })
}
