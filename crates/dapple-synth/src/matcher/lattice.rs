//! Quantization of components to 16-bit integers. Sums of their squared differences are exact.
//!
//! A point outside of a ball is moved onto the ball's surface, along the ray from the center; then its coordinates are
//! rounded to whole units. The move never increases the distance between two points, so distances remain lower bounds.
//! The radius of the ball is [`RADIUS`] units, so that a signed difference of two coordinates fits in 16 bits, and a
//! squared distance in 31 bits.

use super::margin;

/// Radius of the ball, in units. Including rounding, the diameter is less than 2^15.
const RADIUS: f64 = 16_000.0;

/// Maximum number of units per input unit; prevents overflow.
const FINEST: f64 = 1e30;

/// Radius of the ball, in multiples of the root mean square length of the points. Few points are outside, and the
/// others span many units.
const SPREADS: f64 = 4.0;

/// Maximum error of a coordinate, in lattice units: 0.5 from rounding, and less than 0.01 from the arithmetic.
const ERROR: f64 = 0.51;

/// Parameters of the quantization: the radius of the ball around the origin, and the number of units per input unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    radius: f64,
    per_unit: f64,
}

impl Lattice {
    /// Chooses the radius and the scale for a set of vectors, from their maximum length `longest` and the root mean square
    /// `spread` of their lengths.
    pub(crate) fn new(longest: f64, spread: f64) -> Self {
        let radius = longest.min(SPREADS * spread);
        let per_unit = (RADIUS / radius).min(FINEST);
        Self { radius, per_unit }
    }

    /// Quantizes a point with finite coordinates.
    #[inline(always)]
    pub(crate) fn place(&self, point: &[f32], placed: &mut [i16]) {
        // Move the point into the ball.
        let length = margin::length(point);
        let shorter = if length > self.radius {
            self.radius / length
        } else {
            1.0
        };
        let factor = shorter * self.per_unit;
        for (placed, &coordinate) in placed.iter_mut().zip(point) {
            // The shift makes the value positive, so that the cast rounds down.
            *placed = ((f64::from(coordinate) * factor + 32_768.5) as i32 - 32_768) as i16;
        }
    }

    /// Returns the maximum error of a point with `n` coordinates, in units.
    pub(crate) fn error(n: usize) -> f64 {
        ERROR * (n as f64).sqrt()
    }

    /// Returns the scale: how many quantization units one unit of the input spans.
    pub(crate) fn per_unit(&self) -> f64 {
        self.per_unit
    }
}
