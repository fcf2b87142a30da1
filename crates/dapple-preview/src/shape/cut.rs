//! Cuts through solids, which reveal the solid texture inside.
//!
//! A cut is a convex wedge of at most two half-spaces. Either its inside or its outside is kept. A ray intersects a
//! wedge in a single interval, so a cut is an operation on intervals. This is constructive solid geometry after Scott
//! D. Roth, "Ray Casting for Modeling Solids", Computer Graphics and Image Processing 18(2), 1982, doi
//! 10.1016/0146-664X(82)90169-1.

use super::solid::{Boundary, Face, Stretch};
use crate::PreviewError;
use crate::ray::Ray;
use core::f64::consts::{PI, TAU};
use glam::DVec3;

/// A cut that removes part of a solid, in object space. The solid remains closed, because the faces of the cut become
/// part of its surface.
///
#[cfg_attr(doc, doc = include_str!("../../docs/cut.md"))]
///
/// # Examples
///
/// ```
/// use dapple_preview::{Cut, glam::DVec3};
/// use std::f64::consts::{FRAC_PI_2, PI};
///
/// // The lower half, and all but the quarter between +x and -z.
/// let half = Cut::HalfSpace { normal: DVec3::Y, offset: 0.0 };
/// let three_quarters = Cut::Sector { start: FRAC_PI_2, sweep: 1.5 * PI };
/// # let _ = (half, three_quarters);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Cut {
    /// Keeps the points `p` with `normal · p ≤ offset` for the normalized normal.
    HalfSpace {
        /// The direction toward the removed part. Any length except zero.
        normal: DVec3,
        /// The distance of the face from the origin along the normal.
        offset: f64,
    },
    /// Keeps the points whose angle around the y axis is within a range.
    Sector {
        /// The start of the range, in radians: 0 is +x, π/2 is -z.
        start: f64,
        /// The length of the range, in radians, above 0 and below 2π.
        sweep: f64,
    },
}

/// A validated cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wedge {
    /// The outward unit normals and offsets of the half-spaces. A single half-space is listed twice.
    faces: [(DVec3, f64); 2],
    keeps: Keeps,
}

#[derive(Clone, Copy, Debug)]
enum Keeps {
    Inside,
    Outside,
}

impl Cut {
    pub(crate) fn prepare(&self) -> Result<Wedge, PreviewError> {
        match *self {
            Self::HalfSpace { normal, offset } => {
                let normal = PreviewError::direction("normal of a cut", normal)?;
                let holds = offset.abs() <= 1e30;
                PreviewError::check(holds, "offset of a cut", offset, "from -1e30 to 1e30")?;
                Ok(Wedge {
                    faces: [(normal, offset); 2],
                    keeps: Keeps::Inside,
                })
            }
            Self::Sector { start, sweep } => {
                let holds = start.abs() <= 1e3;
                PreviewError::check(holds, "start of a sector", start, "from -1000 to 1000")?;
                let holds = sweep > 0.0 && sweep < TAU;
                let range = "above 0 and below 2π";
                PreviewError::check(holds, "sweep of a sector", sweep, range)?;
                // Use the smaller of the sector and its complement as the wedge, which must be convex.
                Ok(if sweep <= PI {
                    Wedge::sector(start, sweep, Keeps::Inside)
                } else {
                    Wedge::sector(start + sweep, TAU - sweep, Keeps::Outside)
                })
            }
        }
    }
}

impl Wedge {
    /// Creates a wedge around the y axis that spans at most half a turn.
    fn sector(start: f64, sweep: f64, keeps: Keeps) -> Self {
        // The unit vector a quarter turn ahead of an angle.
        let ahead = |angle: f64| DVec3::new(-libm::sin(angle), 0.0, -libm::cos(angle));
        Self {
            faces: [(-ahead(start), 0.0), (ahead(start + sweep), 0.0)],
            keeps,
        }
    }

    /// Returns the unit normal of a face of the cut. It may point to either side.
    pub(crate) fn normal(&self, face: usize) -> DVec3 {
        self.faces[face].0
    }

    /// Applies the cut to the intervals of a ray within a solid. Unused elements are `None`.
    pub(crate) fn apply(&self, ray: &Ray, stretches: [Option<Stretch>; 2]) -> [Option<Stretch>; 4] {
        let wedge = self.stretch(ray);
        match (self.keeps, wedge) {
            (Keeps::Inside, None) => [None; 4],
            (Keeps::Outside, None) => [stretches[0], stretches[1], None, None],
            (Keeps::Inside, Some(wedge)) => {
                let [a, b] = stretches.map(|stretch| stretch?.and(wedge));
                [a, b, None, None]
            }
            (Keeps::Outside, Some(wedge)) => {
                let [a, b] = stretches.map(|stretch| {
                    stretch.map_or([None; 2], |stretch| {
                        [stretch.before(wedge.enter), stretch.after(wedge.exit)]
                    })
                });
                [a[0], a[1], b[0], b[1]]
            }
        }
    }

    /// Returns the interval of a ray within all half-spaces, possibly infinite.
    fn stretch(&self, ray: &Ray) -> Option<Stretch> {
        let end = |distance| Boundary {
            distance,
            face: Face::Skin,
        };
        let mut stretch = Stretch {
            enter: end(f64::NEG_INFINITY),
            exit: end(f64::INFINITY),
        };
        for (index, (normal, offset)) in self.faces.iter().enumerate() {
            let outside = normal.dot(ray.origin) - offset;
            let speed = normal.dot(ray.direction);
            let boundary = Boundary {
                distance: -outside / speed,
                face: Face::Cut(index),
            };
            // The ray leaves the half-space if `speed` is positive, and enters it if negative.
            stretch = if speed > 0.0 {
                stretch.before(boundary)?
            } else if speed < 0.0 {
                stretch.after(boundary)?
            } else if outside > 0.0 {
                return None;
            } else {
                stretch
            };
        }
        Some(stretch)
    }
}
