//! The maps of a material, and the planes of numbers that they are made of.

use crate::{TileError, TileErrorKind};
use dapple_color::{LinearRgb, Normal};
use dapple_raster::Raster;

/// One map of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum Map {
    /// One number per pixel: height, roughness, a mask.
    Value(Raster<f32>),
    /// Linear color.
    Color(Raster<LinearRgb>),
    /// Normals. They are added up as slopes (x/z, y/z), and come back as long as 1.
    Normal(Raster<Normal>),
}

/// The smallest z that a normal is given before it becomes a slope: slopes are at most 1000.
const LEAST_Z: f32 = 1e-3;

impl Map {
    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Value(raster) => raster.size(),
            Self::Color(raster) => raster.size(),
            Self::Normal(raster) => raster.size(),
        }
    }

    /// The numbers of the map, a raster for each channel: 1, 3, or 2 for slopes.
    pub(crate) fn planes(&self) -> Vec<Raster<f32>> {
        match self {
            Self::Value(raster) => vec![raster.clone()],
            Self::Color(raster) => vec![
                raster.map(|color| color.r),
                raster.map(|color| color.g),
                raster.map(|color| color.b),
            ],
            Self::Normal(raster) => vec![
                raster.map(|normal| normal.x / normal.z.max(LEAST_Z)),
                raster.map(|normal| normal.y / normal.z.max(LEAST_Z)),
            ],
        }
    }

    /// A map of this kind from its planes, in the order of [`planes`](Self::planes).
    pub(crate) fn with_planes(&self, planes: Vec<Raster<f32>>) -> Result<Self, TileError> {
        let count = planes.len();
        let mut planes = planes.into_iter();
        let mut next = || {
            planes.next().ok_or(TileError::new(TileErrorKind::Count {
                what: "planes",
                count,
                needed: "more",
            }))
        };
        Ok(match self {
            Self::Value(_) => Self::Value(next()?),
            Self::Color(_) => {
                let [r, g, b] = [next()?, next()?, next()?];
                let rg = r.zip_map(&g, |&r, &g| [r, g])?;
                Self::Color(rg.zip_map(&b, |&[r, g], &b| LinearRgb::new(r, g, b))?)
            }
            Self::Normal(_) => {
                let [x, y] = [next()?, next()?];
                Self::Normal(x.zip_map(&y, |&x, &y| from_slopes(x, y))?)
            }
        })
    }
}

/// The unit vector along (x, y, 1).
fn from_slopes(x: f32, y: f32) -> Normal {
    let length = (x * x + y * y + 1.0).sqrt();
    Normal {
        x: x / length,
        y: y / length,
        z: 1.0 / length,
    }
}

/// Refuses planes that differ in size, that have none, and pixels that are not finite.
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

/// Refuses a raster with a pixel that is not finite, and names the first.
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
