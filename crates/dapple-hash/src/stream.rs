//! Sequential random streams.

use crate::{CellHash, Pcg32, Seed};

impl Seed {
    /// Creates a random stream. It is a `Pcg32`, Melissa O'Neill's XSH RR 64/32 generator, seeded by two hashes.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_hash::{Seed, rand_core::Rng};
    ///
    /// let mut stream = Seed(7).child("shuffle", 0).stream();
    /// assert_ne!(stream.next_u32(), stream.next_u32());
    /// ```
    #[must_use]
    pub fn stream(self) -> Pcg32 {
        CellHash::new(self, []).stream()
    }
}

impl CellHash {
    /// Creates the random stream of this cell, which is independent of the streams of other cells.
    ///
    /// It uses the two highest counters; the lower counters remain available for [`CellHash::at`].
    #[must_use]
    pub fn stream(self) -> Pcg32 {
        Pcg32::new(self.at(u32::MAX), self.at(u32::MAX - 1))
    }
}

#[cfg(test)]
mod tests {
    use crate::{CellHash, Seed};
    use rand_core::Rng;

    #[test]
    fn value_stability_stream() {
        let mut stream = Seed(7).child("stream", 0).stream();
        assert_eq!(
            [stream.next_u32(), stream.next_u32(), stream.next_u32()],
            [2620001655, 2239738747, 1140802808]
        );
    }

    #[test]
    fn streams_of_neighboring_cells_are_not_correlated() {
        // 64 cells with 1024 numbers each: the standard deviation of the correlation is 1 / 256.
        let cells = 64;
        let numbers = 1024;
        let mut sum = 0.0;
        for x in 0..cells {
            let [mut here, mut there] = [x, x + 1].map(|x| CellHash::new(Seed(1), [x, 0]).stream());
            for _ in 0..numbers {
                let [a, b] = [&mut here, &mut there]
                    .map(|stream| f64::from(stream.next_u32()) / f64::from(u32::MAX) - 0.5);
                sum += a * b;
            }
        }
        let correlation = sum * 12.0 / f64::from(i32::try_from(cells).unwrap() * numbers);
        assert!(
            correlation.abs() < 0.02,
            "neighboring streams have correlation {correlation}"
        );
    }
}
