//! Numbers that may vary in space, as plain data.

#[cfg(feature = "serde")]
mod data;

use crate::{Raster, Wrap};
use core::fmt;
use glam::DVec2;
use std::sync::Arc;

/// A number that may depend on the position: a constant, a ramp, a raster or a function.
///
/// # Examples
///
/// ```
/// use dapple_raster::{Ramp, Varying, glam::DVec2};
///
/// let density = Varying::from(Ramp { from: DVec2::ZERO, to: DVec2::X, start: 0.25, end: 0.75 });
/// assert_eq!(density.at(DVec2::new(0.5, 9.0)), 0.5);
/// ```
/// The serialized form of a constant is a number. Ramps are `{ ramp = … }` or `{ geometric_ramp = … }` with the fields
/// of [`Ramp`].
#[derive(Clone)]
#[non_exhaustive]
pub enum Varying {
    /// A constant: the same number everywhere.
    Constant(f64),
    /// A linear ramp.
    Ramp(Ramp),
    /// A ramp with constant ratios instead of constant differences over equal distances. Both ends must be above zero.
    GeometricRamp(Ramp),
    /// The bilinearly interpolated values of a raster that covers a rectangle of the plane. Cannot be serialized.
    Raster {
        /// Raster with the values.
        raster: Arc<Raster<f32>>,
        /// Top left corner of the rectangle.
        origin: DVec2,
        /// Width and height of the rectangle.
        extent: DVec2,
        /// Wrap modes for positions beyond the raster's edges, along x and y.
        wrap: [Wrap; 2],
    },
    /// A function of the position. Cannot be serialized.
    Function(Arc<dyn Fn(DVec2) -> f64 + Send + Sync>),
}

/// A linear gradient between two positions. The value changes along the line between them, and is constant
/// perpendicular to it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
pub struct Ramp {
    /// Start position.
    pub from: DVec2,
    /// End position.
    pub to: DVec2,
    /// Value at the start and before it.
    pub start: f64,
    /// Value at the end and beyond it.
    pub end: f64,
}

impl Ramp {
    /// Returns the fraction of the ramp that is reached at `position`, from 0 to 1. For a ramp of zero length, the
    /// fraction is 1 everywhere.
    #[must_use]
    pub fn fraction(&self, position: DVec2) -> f64 {
        let along = self.to - self.from;
        let fraction = (position - self.from).dot(along) / along.length_squared();
        if fraction.is_nan() {
            1.0
        } else {
            fraction.clamp(0.0, 1.0)
        }
    }

    /// Returns the value at `position`.
    #[must_use]
    pub fn at(&self, position: DVec2) -> f64 {
        let fraction = self.fraction(position);
        self.start * (1.0 - fraction) + self.end * fraction
    }
}

impl Varying {
    /// Creates a varying number from a function of the position.
    pub fn function(value: impl Fn(DVec2) -> f64 + Send + Sync + 'static) -> Self {
        Self::Function(Arc::new(value))
    }

    /// Returns the value at `position`.
    #[must_use]
    pub fn at(&self, position: DVec2) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Ramp(ramp) => ramp.at(position),
            Self::GeometricRamp(ramp) => {
                ramp.start * libm::pow(ramp.end / ramp.start, ramp.fraction(position))
            }
            Self::Raster {
                raster,
                origin,
                extent,
                wrap,
            } => f64::from(raster.sample_bilinear((position - *origin) / *extent, *wrap)),
            Self::Function(value) => value(position),
        }
    }
}

impl From<f64> for Varying {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

impl From<Ramp> for Varying {
    fn from(ramp: Ramp) -> Self {
        Self::Ramp(ramp)
    }
}

impl fmt::Debug for Varying {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => f.debug_tuple("Constant").field(value).finish(),
            Self::Ramp(ramp) => f.debug_tuple("Ramp").field(ramp).finish(),
            Self::GeometricRamp(ramp) => f.debug_tuple("GeometricRamp").field(ramp).finish(),
            Self::Raster {
                raster,
                origin,
                extent,
                wrap,
            } => f
                .debug_struct("Raster")
                .field("size", &raster.size())
                .field("origin", origin)
                .field("extent", extent)
                .field("wrap", wrap)
                .finish(),
            Self::Function(_) => f.write_str("Function"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Ramp, Varying};
    use crate::{Raster, Wrap};
    use glam::DVec2;
    use std::sync::Arc;

    #[test]
    fn ramps_end_at_their_ends() {
        let ramp = Ramp {
            from: DVec2::new(1.0, 0.0),
            to: DVec2::new(3.0, 0.0),
            start: 1.0,
            end: 16.0,
        };
        let linear = Varying::Ramp(ramp);
        let geometric = Varying::GeometricRamp(ramp);
        let at = |varying: &Varying, x: f64| varying.at(DVec2::new(x, 5.0));
        assert_eq!(
            [0.0, 1.0, 2.0, 3.0, 9.0].map(|x| at(&linear, x)),
            [1.0, 1.0, 8.5, 16.0, 16.0]
        );
        assert_eq!(
            [0.0, 1.0, 2.0, 3.0, 9.0].map(|x| at(&geometric, x)),
            [1.0, 1.0, 4.0, 16.0, 16.0]
        );
        let point = Ramp {
            to: ramp.from,
            ..ramp
        };
        assert_eq!(point.at(ramp.from), 16.0);
    }

    #[test]
    fn rasters_and_functions_are_read_at_the_position() {
        let raster = Arc::new(Raster::from_vec([2, 1], vec![1.0, 3.0]).unwrap());
        let (origin, extent) = (DVec2::new(10.0, 0.0), DVec2::new(4.0, 1.0));
        let varying = Varying::Raster {
            raster,
            origin,
            extent,
            wrap: [Wrap::Clamp; 2],
        };
        assert_eq!(
            [11.0, 12.0, 13.0, 99.0].map(|x| varying.at(DVec2::new(x, 0.5))),
            [1.0, 2.0, 3.0, 3.0]
        );
        assert_eq!(
            Varying::function(|position| position.y).at(DVec2::new(1.0, 7.0)),
            7.0
        );
    }
}
