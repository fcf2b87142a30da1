//! The noise as words of a texture for shaders.

use super::WaveletNoise2;

impl WaveletNoise2 {
    /// Returns the bands and the tile as words of the texture `data` of the shaders of `dapple-wgsl`.
    ///
    /// The first four words are the numbers of columns and rows of the tile, the number of bands, and 0. Each band has
    /// four: its weight, the binary logarithm of its frequency, and its offset along both axes. The coefficients of the
    /// tile follow, in rows, with a margin of one cell on each side.
    #[must_use]
    pub fn shader_words(&self) -> Vec<u32> {
        let [columns, rows] = self.size;
        let mut words = vec![columns, rows, self.bands.len() as u32, 0];
        for band in &self.bands {
            // The frequency is a power of two, and an offset is below the size of the tile.
            let exponent = (band.frequency as u64).trailing_zeros();
            let [x, y] = band.offset.map(|cells| cells as u32);
            words.extend([band.weight.to_bits(), exponent, x, y]);
        }
        words.extend(self.tile.coefficients().iter().map(|value| value.to_bits()));
        words
    }
}
