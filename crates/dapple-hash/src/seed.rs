//! Seeds, and child seeds derived by name.

use crate::mix::{GOLDEN, mix64};

/// The source of all randomness: 64 bits that the caller chooses.
///
/// All values are equally good; `Seed(0)` and `Seed(1)` give uncorrelated results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(transparent)
)]
pub struct Seed(pub u64);

impl From<u64> for Seed {
    fn from(seed: u64) -> Self {
        Self(seed)
    }
}

impl Seed {
    /// Derives a child seed. Its bits depend on this seed, on `name` and on `index`.
    ///
    /// Use a separate child for every random choice, so that no two choices share bits. The name identifies the
    /// choice; the index distinguishes the members of a series.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_hash::Seed;
    ///
    /// let seed = Seed(7);
    /// assert_ne!(seed.child("octave", 0), seed.child("octave", 1));
    /// assert_ne!(seed.child("octave", 0), seed.child("label", 0));
    /// ```
    #[must_use]
    pub const fn child(self, name: &str, index: u64) -> Self {
        let bytes = name.as_bytes();
        let mut state = mix64(self.0.wrapping_add(GOLDEN));
        let mut at = 0;
        while at < bytes.len() {
            state = mix64((state ^ bytes[at] as u64).wrapping_add(GOLDEN));
            at += 1;
        }
        // Absorb the length, which distinguishes a name from a longer name that ends in zero bytes.
        state = mix64((state ^ bytes.len() as u64).wrapping_add(GOLDEN));
        Self(mix64((state ^ index).wrapping_add(GOLDEN)))
    }
}

#[cfg(test)]
mod tests {
    use super::Seed;
    use std::collections::BTreeSet;

    #[test]
    fn children_differ_by_seed_name_and_index() {
        let names = ["", "a", "b", "ab", "ba", "a\0", "octave", "label"];
        let mut seen = BTreeSet::new();
        for seed in [0, 1, u64::MAX] {
            for name in names {
                for index in [0, 1, 2, u64::MAX] {
                    assert!(
                        seen.insert(Seed(seed).child(name, index)),
                        "{seed} {name:?} {index} came twice"
                    );
                }
            }
        }
    }

    #[test]
    fn value_stability_child() {
        assert_eq!(Seed(7).child("octave", 3), Seed(1216253520221440515));
        assert_eq!(Seed(0).child("", 0), Seed(2558736989570252433));
    }
}
