//! Computes the periods of composed fields.

/// Maximum length of a common period, in multiples of the longer period. If two periods need more, they count as
/// having no common period.
const MOST_REPEATS: u32 = 64;

/// Returns the common period of two fields along each axis. It is the least common multiple of their
/// [periods](crate::Field::period), or `None` if that exceeds 64 times the longer period. Intended for implementing
/// composed fields.
#[must_use]
pub fn common_period<const N: usize>(a: [Option<f64>; N], b: [Option<f64>; N]) -> [Option<f64>; N] {
    core::array::from_fn(|axis| common_multiple(a[axis]?, b[axis]?))
}

fn common_multiple(a: f64, b: f64) -> Option<f64> {
    let (longer, shorter) = if a < b { (b, a) } else { (a, b) };
    if shorter == 0.0 {
        return Some(longer);
    }
    (1..=MOST_REPEATS)
        .map(|repeats| longer * f64::from(repeats))
        .find(|multiple| multiple % shorter == 0.0)
}

#[cfg(test)]
mod tests {
    use super::common_multiple;

    #[test]
    fn periods_have_their_least_common_multiple() {
        for (a, b, expected) in [
            (1.0, 1.0, Some(1.0)),
            (4.0, 1.0, Some(4.0)),
            (4.0, 6.0, Some(12.0)),
            (0.75, 0.5, Some(1.5)),
            (0.0, 5.0, Some(5.0)),
            (0.0, 0.0, Some(0.0)),
            (1.0, core::f64::consts::SQRT_2, None),
            (127.0, 128.0, None),
        ] {
            assert_eq!(common_multiple(a, b), expected, "{a} and {b}");
            assert_eq!(common_multiple(b, a), expected, "{b} and {a}");
        }
    }
}
