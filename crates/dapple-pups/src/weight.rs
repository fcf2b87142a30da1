//! Axial weights: equation 1 and its alternatives.
//!
//! An axial weight is a function of `u = 1 − p`, where `p` is the projection of a position onto an axis, as a fraction
//! of the axis: 1 at the control point and behind it, 0 at the end of the axis and beyond. All alternatives to the
//! cubic have three properties that the rest of the crate relies on:
//!
//! * They are 1 at `u = 1` and 0 at `u = 0`, *exactly, in the arithmetic used*. So the texture interpolates its control
//!   points, supports have exact ends, and axes whose `u` is 1 can be left out without changing a bit.
//! * They are positive in between. So the weights of a position never cancel, and the denominator of equation 3 is at
//!   least the weight of the nearest control point. Every factor of that weight is at least the axial weight at
//!   `u = 1 − 1/(2s)`, for an axis scale of `s`.
//! * Their slope is zero at both ends. So clamping the projection causes no crease.
//!
//! The functions are generic over a scalar or a SIMD register.

use core::ops::{Add, Mul, Sub};

/// Falloff of a control point's weight along one of its axes.
///
#[cfg_attr(doc, doc = include_str!("../docs/axial-weight.md"))]
///
/// # Examples
///
/// ```
/// use dapple_pups::AxialWeight;
///
/// let half = [AxialWeight::Cubic, AxialWeight::Quintic].map(|weight| weight.at(0.5));
/// assert_eq!(half, [0.5, 0.5]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[non_exhaustive]
pub enum AxialWeight {
    /// Cubic falloff `(1 − p)² (1 + 2p)` (equation 1): the texture has a continuous gradient.
    #[default]
    Cubic,
    /// Quintic falloff `(1 − p)³ (1 + 3p + 6p²)`: the texture has continuous curvature as well.
    Quintic,
    /// Cubic falloff with dips, for finer features: `A(p) · (1 − d · (1 − T²)²)`.
    ///
    /// `A` is the cubic falloff. The Chebyshev polynomial `T = T_n(1 − 2p)` oscillates between −1 and 1. The paper's
    /// discussion hopes for such finer features.
    Oscillating {
        /// Number `n` of dips along an axis, from 1 to 16.
        #[cfg_attr(feature = "schema", schemars(transform = { crate::options::DIPS }))]
        dips: u32,
        /// Depth `d` of the dips, from 0 (the cubic falloff) to 0.99.
        ///
        /// At 1, the weight would vanish inside of the support, and the denominator might vanish with it.
        depth: f32,
    },
}

impl AxialWeight {
    /// Returns the weight at the projection `p`, which is clamped to `[0, 1]`.
    #[must_use]
    pub fn at(self, p: f32) -> f32 {
        self.of_complement((1.0 - p).clamp(0.0, 1.0))
    }

    /// Returns the weight at `u = 1 − p`, where `u` is in `[0, 1]`.
    #[inline(always)]
    pub(crate) fn of_complement<V: Lane>(self, u: V) -> V {
        match self {
            Self::Cubic => cubic(u),
            Self::Quintic => u * u * u * ((u * 6.0 - 15.0) * u + 10.0),
            Self::Oscillating { dips, depth } => {
                // T = T_n(2u − 1) is ±1 where the falloff is the cubic, and 0 where the dip is deepest.
                let swing = chebyshev(dips, u * 2.0 - 1.0);
                let dip = swing * swing * -1.0 + 1.0;
                cubic(u) * (dip * dip * -depth + 1.0)
            }
        }
    }

    /// Returns the weight at `u` (in `[0, 1]`), in double precision.
    pub(crate) fn value(self, u: f64) -> f64 {
        // These are the formulas of `of_complement`, in double precision.
        let cubic = u * u * (3.0 - 2.0 * u);
        match self {
            Self::Cubic => cubic,
            Self::Quintic => u * u * u * ((u * 6.0 - 15.0) * u + 10.0),
            Self::Oscillating { dips, depth } => {
                let (swing, _) = swing(dips, u);
                let dip = 1.0 - swing * swing;
                cubic * (1.0 - f64::from(depth) * dip * dip)
            }
        }
    }

    /// Returns the derivative of the weight with respect to `u`, which is in `[0, 1]`.
    pub(crate) fn slope(self, u: f64) -> f64 {
        let cubic_slope = 6.0 * u * (1.0 - u);
        match self {
            Self::Cubic => cubic_slope,
            Self::Quintic => 30.0 * u * u * (1.0 - u) * (1.0 - u),
            Self::Oscillating { dips, depth } => {
                // Product rule for cubic · (1 − d D²), with the dip D = 1 − T².
                let (depth, cubic) = (f64::from(depth), u * u * (3.0 - 2.0 * u));
                let (swing, swing_slope) = swing(dips, u);
                let dip = 1.0 - swing * swing;
                let dip_slope = -2.0 * swing * swing_slope;
                cubic_slope * (1.0 - depth * dip * dip) - cubic * depth * 2.0 * dip * dip_slope
            }
        }
    }
}

/// A scalar or a SIMD register, on which the formulas of this crate operate.
pub(crate) trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
{
}

impl<V> Lane for V where
    V: Copy
        + Add<Output = V>
        + Sub<Output = V>
        + Mul<Output = V>
        + Add<f32, Output = V>
        + Sub<f32, Output = V>
        + Mul<f32, Output = V>
{
}

/// Computes `u² (3 − 2u)`, which is `(1 − p)² (1 + 2p)`.
#[inline(always)]
fn cubic<V: Lane>(u: V) -> V {
    u * u * (u * -2.0 + 3.0)
}

/// Computes `T_n(x)` by its recurrence. The result is exact at the ends: 1 at 1, and ±1 at −1.
#[inline(always)]
fn chebyshev<V: Lane>(n: u32, x: V) -> V {
    // Start with T_0 = 1 and T_1 = x.
    let mut former = x * 0.0 + 1.0;
    let mut latter = x;
    for _ in 1..n {
        // T_(k+1) = 2 x T_k − T_(k−1).
        (former, latter) = (latter, x * latter * 2.0 - former);
    }
    latter
}

/// Computes `T_n(2u − 1)` and its derivative with respect to `u`, which is `2n` times the Chebyshev polynomial of the
/// second kind of degree `n − 1`.
fn swing(n: u32, u: f64) -> (f64, f64) {
    let x = 2.0 * u - 1.0;
    // Both kinds share a recurrence. The first starts with T_0 = 1 and T_1 = x, the second with U_(−1) = 0 and U_0 = 1.
    let (mut former, mut latter) = ([1.0, 0.0], [x, 1.0]);
    for _ in 1..n {
        let next = [0, 1].map(|kind| 2.0 * x * latter[kind] - former[kind]);
        (former, latter) = (latter, next);
    }
    // T_n' = n U_(n−1), and x = 2u − 1 has the slope 2.
    (latter[0], 2.0 * f64::from(n) * latter[1])
}

#[cfg(test)]
mod tests {
    use super::AxialWeight;

    fn weights() -> Vec<AxialWeight> {
        let oscillating = (1..=16).flat_map(|dips| {
            [0.0, 0.5, 0.99].map(|depth| AxialWeight::Oscillating { dips, depth })
        });
        [AxialWeight::Cubic, AxialWeight::Quintic]
            .into_iter()
            .chain(oscillating)
            .collect()
    }

    #[test]
    fn weights_are_exact_at_the_ends_and_positive_in_between() {
        for weight in weights() {
            assert_eq!([weight.at(0.0), weight.at(1.0)], [1.0, 0.0], "{weight:?}");
            assert_eq!(
                [weight.at(-3.0), weight.at(7.0)],
                [1.0, 0.0],
                "{weight:?} is not clamped"
            );
            for step in 1..1000 {
                let value = weight.at(step as f32 / 1000.0);
                assert!(
                    value > 0.0 && value <= 1.0 + 1e-6,
                    "{weight:?} is {value} at step {step}"
                );
            }
        }
    }

    #[test]
    fn slopes_are_the_differences_and_vanish_at_the_ends() {
        for weight in weights() {
            assert_eq!(
                [weight.slope(0.0), weight.slope(1.0)].map(f64::abs),
                [0.0, 0.0],
                "{weight:?}"
            );
            for step in 1..200 {
                let u = f64::from(step) / 200.0;
                let difference = (weight.value(u + 1e-7) - weight.value(u - 1e-7)) / 2e-7;
                let off = (difference - weight.slope(u)).abs();
                // The third derivative, up to 1e8 for 16 dips, times 1e-14 / 6, and rounding of 1e-16 / 1e-7.
                assert!(
                    off < 5e-6,
                    "{weight:?} at {u}: slope {} against {difference}",
                    weight.slope(u)
                );
                let single = f64::from(weight.of_complement(u as f32));
                assert!(
                    (single - weight.value(u)).abs() < 1e-4,
                    "{weight:?} at {u}: {single} in single precision"
                );
            }
        }
    }

    #[test]
    fn the_cubic_is_equation_1() {
        for step in 0..=100 {
            let p = f64::from(step) / 100.0;
            let exact = (1.0 - p) * (1.0 - p) * (1.0 + 2.0 * p);
            // A few roundings of numbers up to 3.
            assert!(
                (f64::from(AxialWeight::Cubic.at(p as f32)) - exact).abs() < 4e-7,
                "p = {p}"
            );
        }
    }
}
