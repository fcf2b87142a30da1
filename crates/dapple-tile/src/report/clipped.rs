//! Measures the share of samples that a method clipped.
//!
//! A sample is clipped if the method moved it beyond 0 or 1, where an image file stores the end of its range. A source
//! has samples at the ends, too: a black disk remains black in the tile, and crops and mixtures of black are black. So
//! at each end, the clipped share is limited to the surplus of the tile's samples over the source's.
//!
//! Reference: our own.

/// Maximum distance from 0 or 1 that is attributed to rounding, half an 8-bit code.
const ROUNDING: f32 = 0.5 / 255.0;

/// Slope of the sRGB curve at 0 and at 1, as the change of the code (from 0 to 1) per change of the linear value.
pub(super) const SRGB_SLOPES: [f32; 2] = [12.92, 1.055 / 2.4];

/// Slope at 0 and at 1 for values that are displayed without conversion.
pub(super) const PLAIN_SLOPES: [f32; 2] = [1.0; 2];

/// Shares of an image's samples at 0 and at 1.
pub(super) struct Ends {
    /// Share of samples at or beyond each end.
    reached: [f64; 2],
    /// Share of samples beyond each end by more than rounding.
    past: [f64; 2],
}

impl Ends {
    /// Counts samples before they are clamped to 0 and 1. `slopes` are the slopes of the displayed value at 0 and at 1.
    pub(super) fn of(samples: impl ExactSizeIterator<Item = f32>, slopes: [f32; 2]) -> Self {
        let n = samples.len() as f64;
        // A displayed value within half an 8-bit code of the range may be a rounding error.
        let [below, above] = slopes.map(|slope| ROUNDING / slope);
        let (mut reached, mut past) = ([0_u64; 2], [0_u64; 2]);
        // Count the samples at the ends of the range, and those beyond.
        for value in samples {
            reached[0] += u64::from(value <= 0.0);
            reached[1] += u64::from(value >= 1.0);
            past[0] += u64::from(value < -below);
            past[1] += u64::from(value - 1.0 > above);
        }
        Self {
            reached: reached.map(|count| count as f64 / n),
            past: past.map(|count| count as f64 / n),
        }
    }

    /// Returns the share of a tile's samples that were clipped; 0 for a source that is outside of 0 to 1 itself.
    pub(super) fn clipped(source: &Self, tile: &Self) -> f64 {
        if source.past != [0.0; 2] {
            return 0.0;
        }
        // At each end, limit the share to the tile's surplus over the source.
        let at = |end: usize| {
            let more = tile.reached[end] - source.reached[end];
            tile.past[end].min(more.max(0.0))
        };
        at(0) + at(1)
    }
}

#[cfg(test)]
mod tests {
    use super::{Ends, PLAIN_SLOPES, SRGB_SLOPES};

    fn clipped(source: &[f32], tile: &[f32], slopes: [f32; 2]) -> f64 {
        let [source, tile] = [source, tile].map(|of| Ends::of(of.iter().copied(), slopes));
        Ends::clipped(&source, &tile)
    }

    #[test]
    fn only_samples_that_a_method_moved_past_an_end_are_clipped() {
        let source = [0.0, 0.2, 0.5, 1.0];
        // A crop has a larger share of black, but nothing was moved.
        assert_eq!(clipped(&source, &[0.0, 0.0, 0.5], PLAIN_SLOPES), 0.0);
        // One of four samples was moved past an end, in addition to the one that the source has there.
        assert_eq!(clipped(&source, &[0.0, -0.1, 0.5, 1.0], PLAIN_SLOPES), 0.25);
        assert_eq!(clipped(&source, &[0.0, 0.5, 1.2, 1.0], PLAIN_SLOPES), 0.25);
        // Black that is moved below 0 remains black.
        assert_eq!(clipped(&source, &[-0.4, 0.2, 0.5, 1.0], PLAIN_SLOPES), 0.0);
        // A decrease at one end does not compensate for the other end.
        assert_eq!(clipped(&source, &[0.2, 0.2, 1.5, 1.0], PLAIN_SLOPES), 0.25);
        // Half a code counts as rounding.
        assert_eq!(
            clipped(&source, &[0.0, -0.0019, 0.5, 1.0], PLAIN_SLOPES),
            0.0
        );
        // A source outside of the range is not clipped by a method.
        assert_eq!(clipped(&[-0.1, 0.5], &[-0.1, -0.5], PLAIN_SLOPES), 0.0);
    }

    #[test]
    fn roundings_of_colors_are_those_of_their_codes() {
        // Half a code is 0.00196, which is 0.00015 of linear light at black and 0.0045 at white.
        let source = [0.1, 0.5];
        assert_eq!(clipped(&source, &[-0.00014, 1.0044], SRGB_SLOPES), 0.0);
        assert_eq!(clipped(&source, &[-0.00016, 0.5], SRGB_SLOPES), 0.5);
        assert_eq!(clipped(&source, &[0.5, 1.0046], SRGB_SLOPES), 0.5);
    }
}
