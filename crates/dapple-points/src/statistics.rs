//! What people measure on point sets: distances, empty circles, spectra.
//!
//! Everything here is exact, for any domain, and a function of the set alone: sums run in a fixed order. Distances
//! are the shortest ones, around the wrapped axes where that is shorter. Times are about proportional to the number of
//! points where they are spread evenly, and grow towards its square where most of them crowd into one spot.

mod circle;
mod distance;
mod grid;
mod spectrum;
#[cfg(test)]
mod test_sets;

pub use circle::EmptyCircle;
pub use spectrum::{Spectrum, SpectrumOptions, SpectrumRing, spectrum};
