//! Statistics of point sets: distances, empty circles, spectra.
//!
//! All statistics are exact, for any domain, and depend on the set alone: sums run in a fixed order. Distances are the
//! shortest ones, around the wrapped axes where that is shorter. Computing times are about proportional to the number
//! of points where they are spread evenly, and grow towards its square where most of them crowd into one spot.

mod circle;
mod distance;
mod grid;
mod spectrum;
#[cfg(test)]
mod test_sets;

pub use circle::EmptyCircle;
pub use spectrum::{Spectrum, SpectrumOptions, SpectrumRing, spectrum, spectrum_cancellable};
