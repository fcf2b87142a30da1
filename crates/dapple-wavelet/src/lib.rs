//! Band-limited wavelet noise, and spline wavelets that halve and double rasters exactly.
//!
//! A [`SplineFilter`] reads pixels as the coefficients of a B-spline. It finds the nearest spline with half as many
//! coefficients ([`down`](SplineFilter::down)), and represents a spline exactly with twice as many
//! ([`up`](SplineFilter::up)). One after the other, they form a projection ([`project`](SplineFilter::project)),
//! which retains the detail that a half-size image can show and removes all other detail.
//!
//! ```
//! use dapple_wavelet::{Border, SplineFilter, WaveletNoise2, hash::Seed, raster::Raster};
//!
//! // The nearest image of half the size, and the same function on all pixels again.
//! let image = Raster::from_fn([64, 48], |x, y| (x * y % 7) as f32)?;
//! let (filter, borders) = (SplineFilter::default(), [Border::Periodic; 2]);
//! let half = filter.down(&image, borders)?;
//! let smooth = filter.up(&half, image.size(), borders)?;
//!
//! // Three bands of detail and a coarse rest, and the image back from them.
//! let bands = filter.analyze(&image, 3, borders)?;
//! let again = filter.synthesize(&bands, borders)?;
//!
//! // Noise that repeats after 64 cells, in three bands.
//! let noise = WaveletNoise2::new(64, Seed(7))?.with_weights(&[1.0, 0.5, 0.25])?;
//! assert!(noise.sample([0.3, 1e6]).abs() <= noise.bound());
//! # let gap = |a: &Raster<f32>, b: &Raster<f32>| a.pixels().iter().zip(b.pixels()).fold(0.0, |m: f32, (a, b)| m.max((a - b).abs()));
//! # assert!(gap(&again, &image) < 1e-5 && gap(&smooth, &image) > 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ways to use it
//!
//! | to | call | cost |
//! |---|---|---|
//! | sample noise at one position | [`WaveletNoise::sample`](WaveletNoise2::sample) | 8.84 ns in 2-D for one band |
//! | sample it with its gradient | [`WaveletNoise::sample_with_gradient`](WaveletNoise2::sample_with_gradient) | |
//! | fill a window with noise | [`to_raster`](dapple_raster::Field::to_raster), [`render`](dapple_raster::Field::render) | |
//! | make a seamless tile of noise | [`wavelet_tile`] | |
//! | stop a long call | [`wavelet_tile_cancellable`], [`of_size_cancellable`](WaveletNoise2::of_size_cancellable), [`down_cancellable`](SplineFilter::down_cancellable) | |
//! | halve or double a raster | [`down`](SplineFilter::down), [`up`](SplineFilter::up) | 2.04 ns/pixel for both at 2048 × 2048 |
//! | reuse memory | [`down_into`](SplineFilter::down_into), [`up_into`](SplineFilter::up_into) with a [`FilterMemory`] | |
//! | split into bands and back | [`analyze`](SplineFilter::analyze), [`synthesize`](SplineFilter::synthesize) | |
//! | filter a line | [`down_line`](SplineFilter::down_line), [`up_line`](SplineFilter::up_line) | linear time |
//! | filter a volume | [`down_volume`](SplineFilter::down_volume), [`up_volume`](SplineFilter::up_volume), [`project_volume`](SplineFilter::project_volume) | |
//! | convert samples to coefficients and back | [`coefficients`](SplineFilter::coefficients), [`samples`](SplineFilter::samples) | |
//!
//! Times are from one thread of a server processor (AMD EPYC).
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | filters rasters on all cores; the bits do not change |
//! | `serde` | off | reads and writes the options as data |
//!
//! # Limits
//!
//! * A noise tile has an even number of cells along each axis, at least 4, and at most 2^27 cells in total. A 2-D
//!   tile of `size` cells takes `4 (size + 2)²` bytes.
//! * A noise has 1 to 16 bands. Its values are nearly normal, with variance 1 for one band of weight 1, and never
//!   exceed [`bound`](WaveletNoise::bound).
//! * Noise is in 2-D and 3-D, and always repeats.
//! * A periodic side must be even to be halved. A mirrored side may have any length of at least 3.
//! * Pixels must be finite.
//! * Lines are `f64`. Rasters and volumes are `f32`, filtered in `f64` and rounded after each axis.
//! * Results have the same bits on every platform and any number of threads.
//!
//! # Without std
//!
//! Not possible today. `floor` and `sqrt` of `f64` are methods of std, and `dapple-raster` has threads, locks and the
//! detection of SIMD levels of std.
//!
//! # The filters
//!
//! Du Jin-Lian, Wang Song and Meng Xianhai, "Wavelet and Blend maps for texture synthesis", make a tile repeat better
//! by halving it and doubling it again. The filters are those of Robert L. Cook and Tony DeRose, "Wavelet Noise", ACM
//! Transactions on Graphics 24(3) (SIGGRAPH 2005), <https://doi.org/10.1145/1073204.1073264>.
//!
//! ## The paper's equations
//!
//! | equation | what it says | here |
//! |---|---|---|
//! | 1 | a function is a weighted sum of shifted splines | [`SplineFilter::value_line`] |
//! | 2, 3 | the spaces of such functions, coarse and fine | [`Degree::value`], its shifts, and those of half the width |
//! | 4 | a spline is a sum of splines of half the width | the weights `2^-d C(d + 1, k)` of [`Degree`] d, placed by [`Phase`] |
//! | 5, 6 | a coarse function is a fine one | [`SplineFilter::up_line`] |
//! | 7 | the coarse function nearest to a fine one | [`SplineFilter::down_line`] |
//! | 8, 13 | 6 along both axes | [`SplineFilter::up`] |
//! | 9, 12 | 7 along both axes | [`SplineFilter::down`] |
//! | 10, 11 | a raster and its half-size raster as functions | 1 along both axes |
//! | 12 and 13 | the blend tile | [`SplineFilter::project`] |
//!
//! The versions for volumes are [`SplineFilter::down_volume`], [`SplineFilter::up_volume`] and
//! [`SplineFilter::project_volume`].
//!
//! ## What the paper leaves open
//!
//! * The filter in equation 7 is infinitely long. Cook and DeRose cut it off after 32 taps, with an rms error of
//!   1.2e-3 on white noise of variance 1; here it is exact, as a recursion, in linear time.
//! * Its indices wrap ([`Border::Periodic`]). This alone accounts for the effect on a tile's seam; [`Border::Mirror`]
//!   is for images that do not repeat.
//! * [`Phase`] chooses the positions of the coarse coefficients, [`Degree`] chooses the spline, and [`Fit`] defines
//!   what "nearest" means.
//! * As in the paper, pixels are coefficients and not values of the function. [`SplineFilter::coefficients`] and
//!   [`SplineFilter::samples`] convert between the two.
//!
//! # Wavelet noise
//!
//! The detail that white noise loses when it is halved is noise with a bandwidth of one octave. [`WaveletNoise2`] and
//! [`WaveletNoise3`] evaluate this noise at any position, in one band or several, with its gradient and with a
//! period. [`wavelet_tile`] sums bands of it, each generated at its own size, into a raster that repeats without a
//! seam.

#![forbid(unsafe_code)]

mod error;
mod spline;

mod line;
mod plane;
mod samples;
mod volume;

mod bands;

mod doubling;
mod ends;
mod kernel;
mod pass;
mod recursion;

#[cfg(test)]
mod equations;
#[cfg(test)]
mod oracle;

mod noise;
mod noise_tile;

pub use bands::Bands;
pub use error::{IsCancelled, WaveletError, WaveletErrorKind};
#[doc(alias("band-limited noise", "simplex"))]
pub use noise::WaveletNoise;
pub use noise::{WaveletNoise2, WaveletNoise3};
pub use noise_tile::{wavelet_tile, wavelet_tile_cancellable};
pub use plane::FilterMemory;
pub use spline::{Border, Degree, Fit, Phase, SplineFilter};

pub use dapple_hash as hash;
pub use dapple_raster as raster;
