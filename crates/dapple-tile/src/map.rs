//! The maps of a material, and their conversion to and from planes.

use crate::{TileError, TileErrorKind};
use core::mem::discriminant;
use dapple_color::{LinearRgb, Normal};
use dapple_raster::Raster;

/// One map of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum Map {
    /// One number per pixel, such as height, roughness or a mask.
    Value(Raster<f32>),
    /// Linear color.
    Color(Raster<LinearRgb>),
    /// Normals. They are processed as slopes (x/z, y/z). Results are unit vectors.
    Normal(Raster<Normal>),
}

/// Minimum z of a normal when it is converted to a slope. Slopes of unit vectors are therefore at most 1000.
const LEAST_Z: f32 = 1e-3;

impl Map {
    /// Returns the number of columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Value(raster) => raster.size(),
            Self::Color(raster) => raster.size(),
            Self::Normal(raster) => raster.size(),
        }
    }

    /// Returns the number of planes of the map: 1 for values, 3 for colors, 2 for normals (slopes).
    pub(crate) fn n_planes(&self) -> usize {
        match self {
            Self::Value(_) => 1,
            Self::Color(_) => 3,
            Self::Normal(_) => 2,
        }
    }

    /// Returns the planes of the map, one raster for each channel.
    pub(crate) fn planes(&self) -> Vec<Raster<f32>> {
        match self {
            Self::Value(raster) => vec![raster.clone()],
            Self::Color(raster) => color_planes(raster).into(),
            // Represent normals by their slopes along x and y.
            Self::Normal(raster) => vec![
                raster.map(|normal| slope(normal.x, normal.z)),
                raster.map(|normal| slope(normal.y, normal.z)),
            ],
        }
    }

    /// Returns the map with [centered](Normal::centered) normals.
    pub(crate) fn centered(&self) -> Self {
        match self {
            Self::Normal(raster) => Self::Normal(raster.map(|normal| normal.centered())),
            other => other.clone(),
        }
    }

    /// Returns, for each plane, the factors for reflecting the map along x and along y, in the order of
    /// [`planes`](Self::planes).
    ///
    /// A slope along the axis of reflection changes its sign.
    pub(crate) fn reflections(&self) -> &'static [[f32; 2]] {
        match self {
            Self::Value(_) => &[[1.0; 2]],
            Self::Color(_) => &[[1.0; 2]; 3],
            Self::Normal(_) => &[[-1.0, 1.0], [1.0, -1.0]],
        }
    }

    /// Returns the planes of the maps of several materials.
    ///
    /// Fails if the number of maps is 0 or differs from the first material, if kinds or sizes differ, or if a pixel is
    /// not finite.
    pub(crate) fn planes_of_all(
        materials: &[Vec<Self>],
    ) -> Result<Vec<Vec<Raster<f32>>>, TileError> {
        let mut all = Vec::new();
        for maps in materials {
            // Every material must have the kinds of maps of the first one, in its size.
            let first = &materials[0];
            if maps.is_empty() || maps.len() != first.len() {
                return Err(TileError::new(TileErrorKind::Count {
                    what: "maps",
                    count: maps.len(),
                    needed: "as many as the first has, at least 1",
                }));
            }
            let mut pairs = maps.iter().zip(first);
            if let Some(map) = pairs.position(|(a, b)| discriminant(a) != discriminant(b)) {
                return Err(TileError::new(TileErrorKind::KindMismatch { map }));
            }
            let planes: Vec<_> = maps.iter().flat_map(Self::planes).collect();
            check_planes(&planes)?;
            planes[0].check_same_size(first[0].size())?;
            all.push(planes);
        }
        Ok(all)
    }

    /// Builds maps from the planes of all maps. The kinds are taken from `maps`.
    pub(crate) fn all_with_planes(
        maps: &[Self],
        planes: Vec<Raster<f32>>,
    ) -> Result<Vec<Self>, TileError> {
        let mut planes = planes.into_iter();
        maps.iter()
            .map(|map| map.with_planes(planes.by_ref().take(map.n_planes()).collect()))
            .collect()
    }

    /// Builds a map of this kind from its planes, in the order of [`planes`](Self::planes).
    pub(crate) fn with_planes(&self, planes: Vec<Raster<f32>>) -> Result<Self, TileError> {
        Ok(match self {
            Self::Value(_) => {
                let [value] = exactly(planes)?;
                Self::Value(value)
            }
            Self::Color(_) => Self::Color(color_from_planes(planes)?),
            Self::Normal(_) => {
                let [x, y] = exactly(planes)?;
                Self::Normal(x.zip_map(&y, |&x, &y| from_slopes(x, y))?)
            }
        })
    }
}

/// Returns the red, green and blue planes of a color raster.
pub(crate) fn color_planes(image: &Raster<LinearRgb>) -> [Raster<f32>; 3] {
    [
        image.map(|color| color.r),
        image.map(|color| color.g),
        image.map(|color| color.b),
    ]
}

/// Builds a color raster from its red, green and blue planes.
pub(crate) fn color_from_planes(planes: Vec<Raster<f32>>) -> Result<Raster<LinearRgb>, TileError> {
    let [r, g, b] = exactly(planes)?;
    let rg = r.zip_map(&g, |&r, &g| [r, g])?;
    Ok(rg.zip_map(&b, |&[r, g], &b| LinearRgb::new(r, g, b))?)
}

/// Converts the planes to an array of exactly `N` planes.
pub(crate) fn exactly<const N: usize>(
    planes: Vec<Raster<f32>>,
) -> Result<[Raster<f32>; N], TileError> {
    planes.try_into().map_err(|planes: Vec<_>| {
        TileError::new(TileErrorKind::Count {
            what: "planes",
            count: planes.len(),
            needed: "as many as the map has channels",
        })
    })
}

/// Converts a component of a normal to a slope; NaN if `z` is not finite.
fn slope(part: f32, z: f32) -> f32 {
    if z.is_finite() {
        part / z.max(LEAST_Z)
    } else {
        f32::NAN
    }
}

/// Returns the unit vector along (x, y, 1), computed in `f64`, where the squares of all slopes are finite.
fn from_slopes(x: f32, y: f32) -> Normal {
    let [x, y] = [x, y].map(f64::from);
    let length = (x * x + y * y + 1.0).sqrt();
    let [x, y, z] = [x, y, 1.0].map(|part| (part / length) as f32);
    Normal { x, y, z }
}

/// Checks that there is at least one plane, that all planes are the same size, and that all pixels are finite. Returns
/// the size.
pub(crate) fn check_planes(planes: &[Raster<f32>]) -> Result<[u32; 2], TileError> {
    let first = planes.first().ok_or(TileError::new(TileErrorKind::Count {
        what: "maps",
        count: 0,
        needed: "at least 1",
    }))?;
    for plane in planes {
        first.check_same_size(plane.size())?;
        check_finite(plane)?;
    }
    Ok(first.size())
}

/// Returns an error for the raster's first pixel that is not finite.
pub(crate) fn check_finite(raster: &Raster<f32>) -> Result<(), TileError> {
    let bad = raster.pixels().iter().position(|value| !value.is_finite());
    bad.map_or(Ok(()), |index| {
        let width = raster.width() as usize;
        Err(TileError::new(TileErrorKind::NotFinite {
            column: (index % width) as u32,
            row: (index / width) as u32,
            value: raster.pixels()[index],
        }))
    })
}
