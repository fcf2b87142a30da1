//! Trait of the value types that the operations on a hierarchy can blend.

use glam::{DVec2, DVec3};

/// A value that can be mixed with weights, such as a color, a vector, or a distance.
///
/// # Examples
///
/// ```
/// use dapple_synth::Blend;
///
/// let red = [1.0_f32, 0.0, 0.0];
/// assert_eq!(red.add_scaled([0.0, 1.0, 0.0], 0.5), [1.0, 0.5, 0.0]);
/// ```
pub trait Blend: Copy + Send + Sync {
    /// The zero of the vector space.
    const ZERO: Self;

    /// Returns `self + weight * other`.
    #[must_use]
    fn add_scaled(self, other: Self, weight: f64) -> Self;
}

impl Blend for f64 {
    const ZERO: Self = 0.0;

    #[inline]
    fn add_scaled(self, other: Self, weight: f64) -> Self {
        self + other * weight
    }
}

impl Blend for f32 {
    const ZERO: Self = 0.0;

    #[inline]
    fn add_scaled(self, other: Self, weight: f64) -> Self {
        self + other * weight as Self
    }
}

impl Blend for DVec2 {
    const ZERO: Self = Self::ZERO;

    #[inline]
    fn add_scaled(self, other: Self, weight: f64) -> Self {
        self + other * weight
    }
}

impl Blend for DVec3 {
    const ZERO: Self = Self::ZERO;

    #[inline]
    fn add_scaled(self, other: Self, weight: f64) -> Self {
        self + other * weight
    }
}

impl<const N: usize> Blend for [f32; N] {
    const ZERO: Self = [0.0; N];

    #[inline]
    fn add_scaled(self, other: Self, weight: f64) -> Self {
        core::array::from_fn(|part| self[part] + other[part] * weight as f32)
    }
}

impl<const N: usize> Blend for [f64; N] {
    const ZERO: Self = [0.0; N];

    #[inline]
    fn add_scaled(self, other: Self, weight: f64) -> Self {
        core::array::from_fn(|part| self[part] + other[part] * weight)
    }
}
