//! The parameters of a basis as a structure for shaders.

use crate::{Dimensions, Scatter, Space, Worley, WorleyError, WorleyErrorKind};

impl<const N: usize> Worley<N>
where
    Dimensions: Space<N>,
{
    /// Returns the basis as a structure for shaders: the 24 words of `Worley` in the WGSL of `dapple-wgsl`.
    ///
    /// # Errors
    ///
    /// [`NotInShader`](WorleyErrorKind::NotInShader) if the metric is Minkowski's, the number of points per cell is
    /// unclamped or varies in space, or a period is above 2^31 cells.
    ///
    /// # Examples
    ///
    /// ```
    /// use dapple_worley::{Scatter, Worley2, hash::Seed};
    ///
    /// let worley = Worley2::new(Seed(7)).with_period([Some(8), Some(8)])?;
    /// assert_eq!(worley.shader_words()?.len(), 24);
    /// let unclamped = worley.with_scatter(Scatter::Unclamped { density: 1.0 })?;
    /// assert!(unclamped.shader_words().is_err());
    /// # Ok::<(), dapple_worley::WorleyError>(())
    /// ```
    pub fn shader_words(&self) -> Result<[u32; 24], WorleyError> {
        let lattice = &self.lattice;
        let obstacles = [
            (self.metric.shader_word().is_none(), "Minkowski's metric"),
            (lattice.density.is_some(), "a density that varies in space"),
            (
                matches!(self.scatter, Scatter::Unclamped { .. }),
                "unclamped numbers of points",
            ),
            (
                lattice.period.iter().any(|&cells| cells > 1 << 31),
                "periods above 2^31 cells",
            ),
        ];
        if let Some((_, what)) = obstacles.into_iter().find(|(holds, _)| *holds) {
            return Err(WorleyError::new(WorleyErrorKind::NotInShader { what }));
        }
        let mut words = [0; 24];
        for axis in 0..N {
            words[axis] = lattice.hashes[0].key(axis);
            words[4 + axis] = lattice.hashes[1].key(axis);
            words[8 + axis] = lattice.period[axis];
        }
        // A number of points is the least plus the number of thresholds at or below the random bits. Store one less, so
        // that unused thresholds are never exceeded.
        words[12..20].fill(u32::MAX);
        let mut least = lattice.counts.least();
        words[21] = lattice.jitter;
        for (word, &threshold) in words[12..20].iter_mut().zip(lattice.counts.thresholds()) {
            match threshold.checked_sub(1) {
                Some(below) => *word = below,
                None => least += 1,
            }
        }
        words[20] = least;
        words[22] = self.metric.shader_word().unwrap_or(0);
        Ok(words)
    }
}
