//! Worley's cellular basis: exact F1 to F4 with ids and vectors, in the plane, in space and in four dimensions.
//!
//! Reference: Steven Worley, "A Cellular Texture Basis Function", SIGGRAPH 1996,
//! <https://doi.org/10.1145/237170.237267>.
//!
//! Feature points are scattered over all of space: every unit cell has a Poisson-distributed number of them, made from
//! a hash of the cell, and nothing is stored. F1 of a position is its distance to the nearest feature point, F2 to the
//! second nearest, and so on. [`Worley`] holds such a basis, with its [`Scatter`], its [`Metric`] and its period.
//!
//! ```
//! use dapple_worley::{Combination, Worley2, hash::Seed, raster::{Field, Window}};
//!
//! let worley = Worley2::new(Seed(7));
//! let [nearest, second] = worley.sample([0.25, 0.75]);
//! assert!(nearest.distance <= second.distance);
//!
//! let cracks = worley.combine(Combination::F2_MINUS_F1).normalized()?;
//! let window = Window::new([0.0; 2], [8.0; 2], [256, 256])?;
//! let picture = cracks.to_raster(&window)?;
//! assert_eq!(picture.row(3)[5], cracks.value(window.position(5, 3)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! There are three ways to sample, and they give the same bits: one position ([`Worley::sample`], [`Cellular::value`]),
//! many scattered positions ([`Worley::sample_many`]), and a window of a [`Plane`] ([`Cellular::render_plane`],
//! [`Worley::render_features`], [`Cellular::render_gradient`]), which is by far the fastest. A volume is filled slice
//! by slice ([`Cellular::render_slices`]).
//!
//! On top of F1 to F4 are [`Combination`]s, [`CellularFractal`] sums, [`Profile`]s for bumps, [`Radial`] cells for spheres, and
//! the geometry of the Voronoi cells: [`Worley::edge_distance`] and, as a texture, [`EdgeDistances`],
//! [`Worley::smooth_f1`], [`Worley::sphere_radius`], [`Feature::cell_value`]. A [`FeatureSet`] is the same basis over
//! points that you have placed.
//!
//! Positions are `f64` and in cells, distances are `f32` and in cells. A position is rounded down to [`POSITION_STEP`].

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
