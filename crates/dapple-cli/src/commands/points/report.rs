//! Measures a point set, and reports the result as text or JSON.

use super::scatter::Scattered;
use anyhow::Result;
use dapple::points::{EmptyCircle, PointSet, Spectrum, SpectrumOptions, spectrum};
use serde_json::{Value, json};
use std::fmt;

/// Upper limit of the frequencies that count as low, in units of sqrt(N / area). A blue-noise set has hardly any power
/// below it.
const LOW: f64 = 0.5;

/// The measurements of a point set.
pub(super) struct Report {
    n_points: usize,
    lengths: Vec<usize>,
    radius: Option<f64>,
    least_distance: Option<f64>,
    empty_circle: Option<EmptyCircle>,
    /// Number of points per area of one squared radius; `None` if the points have no radius.
    density: Option<f64>,
    spectrum: Option<Spectrum>,
}

impl Report {
    /// Measures points.
    ///
    /// # Errors
    ///
    /// Never for points that this command scatters.
    pub(super) fn of(scattered: &Scattered) -> Result<Self> {
        let points: &PointSet = &scattered.points;
        let options = SpectrumOptions::default();
        Ok(Self {
            n_points: points.len(),
            lengths: scattered.lengths.clone(),
            radius: scattered.radius,
            least_distance: points.minimum_distance(),
            empty_circle: points.largest_empty_circle(),
            density: scattered
                .radius
                .map(|radius| points.normalized_density(radius)),
            // Leave out the spectrum if the set is too large for it.
            spectrum: spectrum(core::slice::from_ref(points), &options).ok(),
        })
    }

    /// Returns the measurements as JSON.
    pub(super) fn to_json(&self) -> Value {
        let circle = self
            .empty_circle
            .map(|circle| json!({ "center": circle.center.to_array(), "radius": circle.radius }));
        let spectrum = self.spectrum.as_ref().map(|spectrum| {
            let rings = spectrum.rings.iter();
            let rings: Vec<_> = rings.map(|ring| [ring.frequency, ring.power]).collect();
            json!({
                "low_power": spectrum.mean_power(0.0, LOW), "peak_power": spectrum.peak_power(),
                "anisotropy": spectrum.anisotropy(), "rings": rings,
            })
        });
        json!({
            "points": self.n_points, "lengths": self.lengths, "radius": self.radius,
            "least_distance": self.least_distance, "largest_empty_circle": circle,
            "normalized_density": self.density, "spectrum": spectrum,
        })
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<26}{}", "points", self.n_points)?;
        if self.lengths.len() > 1 {
            let lengths: Vec<_> = self.lengths.iter().map(ToString::to_string).collect();
            write!(
                f,
                "\n{:<26}{}",
                "points up to each level",
                lengths.join(", ")
            )?;
        }
        if let Some(radius) = self.radius {
            write!(f, "\n{:<26}{radius:.6}", "radius")?;
        }
        if let Some(distance) = self.least_distance {
            write!(f, "\n{:<26}{distance:.6}", "least distance")?;
        }
        if let Some(EmptyCircle { center, radius }) = self.empty_circle {
            let [x, y] = center.to_array();
            write!(
                f,
                "\n{:<26}radius {radius:.6} around {x:.4}, {y:.4}",
                "largest empty circle"
            )?;
        }
        if let Some(density) = self.density {
            write!(
                f,
                "\n{:<26}{density:.3} (0.697 for random placing)",
                "points per radius squared"
            )?;
        }
        if let Some(spectrum) = &self.spectrum {
            let (low, peak) = (spectrum.mean_power(0.0, LOW), spectrum.peak_power());
            let anisotropy = spectrum.anisotropy();
            write!(
                f,
                "\n{:<26}{low:.3} at low frequencies, {peak:.2} at the peak; 1 is white",
                "spectrum"
            )?;
            write!(f, "\n{:<26}{anisotropy:.2} (1 is isotropic)", "anisotropy")?;
        }
        Ok(())
    }
}
