//! Point set statistics: distances, empty circles and spectra.
//!
//! All statistics are exact for any domain and depend only on the set: sums run in a fixed order. Distances are
//! shortest distances, which go across wrapped sides where that is shorter. Running times are roughly proportional to
//! the number of points if they are evenly spread, and approach its square if most points are concentrated in one
//! spot.

mod circle;
mod distance;
mod grid;
mod spectrum;
#[cfg(test)]
mod test_sets;

pub use circle::EmptyCircle;
pub use spectrum::{Spectrum, SpectrumOptions, SpectrumRing, spectrum, spectrum_cancellable};
