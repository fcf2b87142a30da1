//! Wrap modes, which map indices beyond the edge to pixels.

crate::named! {
    /// Mapping of indices past the end of an axis, applied to each axis separately.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub enum Wrap {
        /// Periodic: the image repeats.
        #[default]
        Repeat = "repeat",
        /// Clamped: the edge pixel continues.
        Clamp = "clamp",
        /// Mirrored: the image repeats, mirrored every second time, with the edge pixel doubled.
        Mirror = "mirror",
    }
}

impl Wrap {
    /// Maps an index to a pixel index in `0..length`. `length` must be at least 1.
    #[must_use]
    #[inline]
    pub fn index(self, index: i64, length: u32) -> u32 {
        let length = i64::from(length.max(1));
        let wrapped = match self {
            Self::Repeat => index.rem_euclid(length),
            Self::Clamp => index.clamp(0, length - 1),
            Self::Mirror => {
                let folded = index.rem_euclid(2 * length);
                folded.min(2 * length - 1 - folded)
            }
        };
        // The result is between zero and `length - 1`, so the cast is lossless.
        wrapped as u32
    }
}

#[cfg(test)]
mod tests {
    use super::Wrap;

    #[test]
    fn indices_come_back_into_the_raster() {
        let wrapped = |wrap: Wrap| [-4, -3, -1, 0, 2, 3, 5, 6].map(|index| wrap.index(index, 3));
        assert_eq!(wrapped(Wrap::Repeat), [2, 0, 2, 0, 2, 0, 2, 0]);
        assert_eq!(wrapped(Wrap::Clamp), [0, 0, 0, 0, 2, 2, 2, 2]);
        assert_eq!(wrapped(Wrap::Mirror), [2, 2, 0, 0, 2, 2, 0, 0]);
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            assert_eq!(wrap.index(i64::MIN, 1), 0);
            assert!(wrap.index(i64::MAX, 7) < 7);
        }
    }
}
