//! Cellular noise (Worley, Voronoi) with exact F1 to F4, ids and vectors, in two, three and four dimensions.
//!
//! Feature points are scattered over all of space. Every unit cell has a random number of them, generated from a hash
//! of the cell, so nothing is stored. F1 at a position is the distance to the nearest feature point, F2 to the second
//! nearest, and so on. [`Worley`] holds such a basis, with its [`Scatter`], its [`Metric`] and its period.
//!
//! ```
//! use dapple_worley::hash::Seed;
//! use dapple_worley::raster::{Field, Window};
//! use dapple_worley::{Combination, Metric, Worley2};
//!
//! // One position: distances, vectors, ids.
//! let worley = Worley2::new(Seed(7)).with_period([Some(8), Some(8)])?;
//! let [nearest, second] = worley.sample([0.25, 0.75]);
//! assert!(nearest.distance <= second.distance);
//!
//! // An image that tiles: cracks between cells, from 0 to 1.
//! let cracks = worley.combine(Combination::F2_MINUS_F1).normalized()?;
//! let window = Window::new([0.0; 2], [8.0; 2], [512, 512])?;
//! let image = cracks.to_raster(&window)?;
//! assert_eq!(image.row(3)[5], cracks.value(window.position(5, 3)));
//!
//! // Right angles instead of round cells.
//! let hull = worley.with_metric(Metric::Manhattan)?.combine(Combination::F1);
//! # assert!(hull.value([0.25, 0.75]) >= 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Ways to sample
//!
//! All methods give the same bits at the same position.
//!
//! | positions | call | cost |
//! |---|---|---|
//! | one | [`Worley::sample`], [`Worley::nearest`], [`Cellular::value`] | one search |
//! | many scattered | [`Worley::sample_many`] | F1 and F2 with vectors and ids: 20.6 ns per position in 2-D, 43.1 ns in 3-D |
//! | many, one point in each cell ([`Scatter::Jittered`]), F1 | [`Worley::sample_many`] | 11.2 ns per position in 2-D, 26.1 ns in 3-D |
//! | a window of the plane | [`to_raster`](dapple_raster::Field::to_raster) of a [`Cellular`] | F2 − F1: 0.40 ns/pixel with 64 pixels per cell, 2.73 with 4 |
//! | a window of a plane through space | [`Cellular::render_plane`] with a [`Plane`] | F2 − F1: 0.37 ns/pixel with 64 pixels per cell, 6.43 with 4 |
//! | slices of a volume | [`Cellular::render_slices`] | faster than slice by slice |
//! | several outputs of one search | [`Worley::render_features`] | distance, vector, position, id, random number |
//! | gradients | [`Cellular::gradient`], [`Cellular::render_gradient`] | |
//! | distance to the edge of the cell | [`Worley::edge_distances`], [`Worley::edge_distance`] | 2.14 ns/pixel with 64 pixels per cell |
//!
//! Times are from one thread of a server processor (AMD EPYC with AVX-512), with three points per cell unless the table
//! says one.
//!
//! Built on F1 to F4: [`Combination`]s, [`CellularFractal`] sums, [`Profile`]s for bumps, [`Radial`] cells for spheres,
//! colors for cells ([`CellValues`], [`Feature::cell_value`]), and [`Worley::smooth_f1`]. A [`FeatureSet`] is the same
//! basis over points placed by the caller.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | fills rasters on all cores; the bits do not change |
//! | `serde` | off | reads and writes the options as data |
//!
//! # Limits
//!
//! * Positions are `f64`, distances `f32`, both in cells. A position is rounded down to a multiple of
//!   [`POSITION_STEP`]; it is as precise at 1e9 as at 0. Beyond 2^62, and for positions that are not finite, distances
//!   are NaN.
//! * Nearest points are exact for every metric: no neighbor is missed, so F1 to F4 are continuous.
//! * One search finds at most 4 points ([`MAX_NEAREST`]).
//! * The density is from 1/64 to 64 points per cell, clamped to 1 to 9 points in a cell by default. Minkowski's
//!   exponent is from 1 to 10.
//! * Periods are exact, and whole numbers of cells. Each axis has its own.
//! * [`Cellular::normalized`] has the ranges of [named combinations](Combination::NAMED) with the default scatter or
//!   full jitter. [`Cellular::measure_range`] measures others.
//! * The bits are the same on every platform, at every SIMD level and with any number of threads.
//!
//! # Without std
//!
//! Not supported. `floor` and `sqrt` of `f64` are std methods, and `dapple-raster` uses std's threads, locks and SIMD
//! detection.
//!
//! # Reference
//!
//! Steven Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996, <https://doi.org/10.1145/237170.237267>.

#![forbid(unsafe_code)]
#![expect(
    clippy::needless_range_loop,
    reason = "an index goes through several arrays at once, and closures of iterators are not inlined into SIMD code"
)]

mod space;

mod worley;

mod metric;
mod scatter;

mod combination;

mod cell_values;
mod cellular;
mod edges;
mod features;
mod fractal;
mod plane;
mod profile;
mod radial;
mod ranges;
mod scattered;
mod set;
mod shader;
mod voronoi;

mod dispatch;
mod fixed;
mod lattice;
mod levels;
mod search;

mod many;
mod one;
mod places;
mod render;
mod sink;

mod error;

pub use cell_values::CellValues;
pub use cellular::Cellular;
pub use combination::Combination;
pub use dapple_hash as hash;
pub use dapple_raster as raster;
#[doc(alias("voronoi edges", "cell borders"))]
pub use edges::EdgeDistances;
pub use error::{WorleyError, WorleyErrorKind};
pub use features::FeatureView;
#[doc(alias("fbm", "turbulence", "ridged"))]
pub use fractal::CellularFractal;
pub use fractal::{OctaveSeeds, Octaves};
pub use metric::Metric;
pub use plane::Plane;
pub use profile::Profile;
pub use radial::{Radial, RadialCells};
pub use scatter::Scatter;
pub use set::FeatureSet;
pub use space::{Dimensions, Space, Vector};
#[doc(alias("voronoi", "cellular noise", "cellular", "cell noise"))]
pub use worley::Worley;
pub use worley::{CellPoint, Feature, MAX_NEAREST, POSITION_STEP, Worley2, Worley3, Worley4};
