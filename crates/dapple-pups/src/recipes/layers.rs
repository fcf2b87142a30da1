//! Weighted sums of layers, such as octaves of noise (equation 5) or cells of several sizes (figure 10).

use dapple_raster::{Field, Raster, RasterError, RasterViewMut, Window, common_period};

/// A weighted sum of fields whose values are between 0 and 1.
///
/// Values are from 0 to the sum of the amplitudes, 1.875 for the four octaves of equation 5. To show the sum as an
/// image, divide by this maximum: [`normalized`](Self::normalized).
#[derive(Clone, Debug)]
pub struct Layers<F> {
    layers: Vec<F>,
    amplitudes: Vec<f32>,
    maximum: f32,
}

impl<F> Layers<F> {
    /// Creates a sum in which layer i has the amplitude `gain^i`.
    pub(crate) fn geometric(layers: Vec<F>, gain: f64) -> Self {
        let amplitudes = core::iter::successors(Some(1.0), |amplitude| Some(amplitude * gain));
        let amplitudes = amplitudes.take(layers.len());
        Self::new(
            layers,
            amplitudes.map(|amplitude| amplitude as f32).collect(),
        )
    }

    fn new(layers: Vec<F>, amplitudes: Vec<f32>) -> Self {
        let maximum = amplitudes.iter().sum();
        Self {
            layers,
            amplitudes,
            maximum,
        }
    }

    /// Returns the layers, from the coarsest to the finest.
    #[must_use]
    pub fn layers(&self) -> &[F] {
        &self.layers
    }

    /// Returns the amplitude of each layer.
    #[must_use]
    pub fn amplitudes(&self) -> &[f32] {
        &self.amplitudes
    }

    /// Returns the sum of the amplitudes, which no value exceeds.
    #[must_use]
    pub fn maximum(&self) -> f32 {
        self.maximum
    }

    /// Divides the sum by its maximum, which maps values to `[0, 1]` for display.
    #[must_use]
    pub fn normalized(self) -> Self {
        let maximum = self.maximum;
        let amplitudes = self.amplitudes.iter().map(|amplitude| amplitude / maximum);
        let amplitudes = amplitudes.collect();
        Self {
            maximum: 1.0,
            ..Self::new(self.layers, amplitudes)
        }
    }

    /// Applies a function to the layers; their amplitudes do not change.
    pub(crate) fn map<G>(self, change: impl FnMut(F) -> G) -> Layers<G> {
        Layers {
            layers: self.layers.into_iter().map(change).collect(),
            amplitudes: self.amplitudes,
            maximum: self.maximum,
        }
    }

    /// Clamps a sum that rounding made larger than the maximum. NaN is unchanged.
    fn finish(&self, sum: f32) -> f32 {
        if sum > self.maximum {
            self.maximum
        } else {
            sum
        }
    }
}

/// Returns the contribution of a layer: its value, clamped to `[0, 1]` because of rounding, times its amplitude.
fn part(value: f32, amplitude: f32) -> f32 {
    value.clamp(0.0, 1.0) * amplitude
}

impl<F: Field> Field for Layers<F> {
    fn value(&self, position: [f64; 2]) -> f32 {
        let mut sum = 0.0;
        for (layer, &amplitude) in self.layers.iter().zip(&self.amplitudes) {
            sum += part(layer.value(position), amplitude);
        }
        self.finish(sum)
    }

    fn render(&self, window: &Window, mut out: RasterViewMut<'_, f32>) -> Result<(), RasterError> {
        window.check_size(out.size())?;
        let mut values = Raster::filled(window.size, 0.0)?;
        out.fill(0.0);
        // Add the layers one by one, in the same order as for a single position.
        for (layer, &amplitude) in self.layers.iter().zip(&self.amplitudes) {
            layer.render(window, values.view_mut())?;
            for (row, sums) in (0..).zip(out.rows_mut()) {
                for (sum, &value) in sums.iter_mut().zip(values.row(row)) {
                    *sum += part(value, amplitude);
                }
            }
        }
        // Clamp sums that exceed the maximum because of rounding.
        for sum in out.rows_mut().flatten() {
            *sum = self.finish(*sum);
        }
        Ok(())
    }

    fn period(&self) -> [Option<f64>; 2] {
        let periods = self.layers.iter().map(Field::period);
        periods.fold([Some(0.0); 2], common_period)
    }
}
