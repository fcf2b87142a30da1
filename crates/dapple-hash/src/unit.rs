//! Converts random bits to numbers from zero (included) to one (excluded).
//!
//! Both functions are exact: every result is a multiple of 2^-24 or 2^-53, and all of these multiples are equally
//! likely. Rounding never gives 1.

/// Converts the upper 24 of 32 random bits to a number in `[0, 1)`.
#[must_use]
#[inline]
#[expect(
    clippy::cast_precision_loss,
    reason = "24 bits fit into the mantissa, so that nothing is rounded"
)]
pub const fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

/// Converts the upper 53 of 64 random bits to a number in `[0, 1)`.
#[must_use]
#[inline]
#[expect(
    clippy::cast_precision_loss,
    reason = "53 bits fit into the mantissa, so that nothing is rounded"
)]
pub const fn unit_f64(bits: u64) -> f64 {
    (bits >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

#[cfg(test)]
mod tests {
    use super::{unit_f32, unit_f64};

    #[test]
    fn unit_numbers_are_half_open_and_exact() {
        assert_eq!(unit_f32(0), 0.0);
        assert_eq!(unit_f32(u32::MAX), 1.0 - f32::EPSILON / 2.0);
        assert_eq!(unit_f32(1 << 31), 0.5);
        assert_eq!(unit_f64(0), 0.0);
        assert_eq!(unit_f64(u64::MAX), 1.0 - f64::EPSILON / 2.0);
        assert_eq!(unit_f64(1 << 63), 0.5);
    }
}
