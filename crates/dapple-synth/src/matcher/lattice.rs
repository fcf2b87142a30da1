//! Coordinates in sixteen bits, whose differences are squared and added up exactly.
//!
//! A point is drawn into a ball, if it lies outside, and then rounded to whole units. Drawing two points into a ball
//! never moves them apart, so that it can only make distances smaller, as a lower bound may be. The radius
//! of the ball is [`RADIUS`] units, so that a difference of two coordinates fits sixteen bits with its sign, and the square of a
//! distance thirty-one.

use super::margin;

/// The radius of the ball in units. With what rounding adds, the diameter is less than 2^15.
const RADIUS: f64 = 16_000.0;

/// The most units to a length of 1, for which no number is out of range.
const FINEST: f64 = 1e30;

/// The radius of the ball by the root mean square of the lengths: few points lie outside, and they are few units away.
const SPREADS: f64 = 4.0;

/// By how much at most a coordinate is off, in units: half of one by rounding, and less than 0.01 by the arithmetic.
const ERROR: f64 = 0.51;

/// A ball around the origin, and a unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    radius: f64,
    per_unit: f64,
}

impl Lattice {
    /// The ball for points of which the longest and the root mean square of all are known.
    pub(crate) fn new(longest: f64, spread: f64) -> Self {
        let radius = longest.min(SPREADS * spread);
        let per_unit = (RADIUS / radius).min(FINEST);
        Self { radius, per_unit }
    }

    /// The whole coordinates of a point with finite ones.
    #[inline(always)]
    pub(crate) fn place(&self, point: &[f32], placed: &mut [i16]) {
        let length = margin::length(point);
        let shorter = if length > self.radius {
            self.radius / length
        } else {
            1.0
        };
        let factor = shorter * self.per_unit;
        for (placed, &coordinate) in placed.iter_mut().zip(point) {
            // The number cast is positive, so that it is rounded down.
            *placed = ((f64::from(coordinate) * factor + 32_768.5) as i32 - 32_768) as i16;
        }
    }

    /// By how much at most a point of `n` coordinates is off, in units.
    pub(crate) fn error(n: usize) -> f64 {
        ERROR * (n as f64).sqrt()
    }

    /// How many units a length of 1 has.
    pub(crate) fn per_unit(&self) -> f64 {
        self.per_unit
    }
}
