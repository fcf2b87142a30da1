//! One octave of a sum of noises, rescaled and optionally folded.

use crate::Texture;
use dapple_raster::{Field, RasterError, RasterViewMut, Window};

/// One octave: a texture with values in `[0, 1]`, rescaled and optionally folded.
#[derive(Clone, Debug)]
pub struct Octave {
    texture: Texture,
    scale: f64,
    folding: Folding,
}

/// Whether an octave is folded.
///
#[cfg_attr(doc, doc = include_str!("../../docs/folding.md"))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Folding {
    /// The interpolated values, unchanged.
    #[default]
    Plain,
    /// Folded values: T' = 2 · |T − ½|.
    Folded,
}

impl Octave {
    pub(super) fn new(texture: Texture, scale: f64) -> Self {
        Self {
            texture,
            scale,
            folding: Folding::Plain,
        }
    }

    /// Sets whether the octave is folded.
    #[must_use]
    pub fn with_folding(self, folding: Folding) -> Self {
        Self { folding, ..self }
    }

    /// Returns the octave's texture, before rescaling and folding.
    #[must_use]
    pub fn texture(&self) -> &Texture {
        &self.texture
    }

    /// Returns the scale factor of positions: 1, or a power of two if octaves are rescaled.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns whether the octave is folded.
    pub(crate) fn folding(&self) -> Folding {
        self.folding
    }
}

/// Computes T' = 2 · |T − ½|, which is between 0 and 1 for values between 0 and 1.
fn fold(value: f32) -> f32 {
    2.0 * (value - 0.5).abs()
}

impl Field for Octave {
    fn value(&self, position: [f64; 2]) -> f32 {
        let value = self.texture.value(position.map(|at| at * self.scale));
        match self.folding {
            Folding::Plain => value,
            Folding::Folded => fold(value),
        }
    }

    fn render(&self, window: &Window, mut out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        // Since the factor is a power of two, scaling the window gives the same bits as scaling each position.
        let window = Window {
            origin: window.origin.map(|at| at * self.scale),
            pixel: window.pixel.map(|side| side * self.scale),
            ..*window
        };
        self.texture.render(&window, out.reborrow())?;
        if self.folding == Folding::Folded {
            out.rows_mut()
                .flatten()
                .for_each(|value| *value = fold(*value));
        }
        Ok(())
    }

    fn period(&self) -> [Option<f64>; 2] {
        let scaled = |period: Option<f64>| Some(period? / self.scale);
        self.texture.period().map(scaled)
    }
}
