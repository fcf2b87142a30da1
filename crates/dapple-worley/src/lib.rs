//! Worley's cellular basis function.

#![forbid(unsafe_code)]
#![expect(
    clippy::needless_range_loop,
    reason = "an index goes through several arrays at once, and closures of iterators are not inlined into SIMD code"
)]

mod cellular;
mod combination;
mod error;
mod features;
mod fixed;
mod fractal;
mod lattice;
mod many;
mod metric;
mod one;
mod plane;
mod profile;
mod radial;
mod ranges;
mod render;
mod scatter;
mod scattered;
mod search;
mod set;
mod simd;
mod sink;
mod space;
mod voronoi;
mod worley;

pub use cellular::Cellular;
pub use combination::Combination;
pub use dapple_hash as hash;
pub use dapple_raster as raster;
pub use error::{WorleyError, WorleyErrorKind};
pub use features::FeatureView;
pub use fractal::{Fractal, OctaveSeeds, Octaves};
pub use metric::Metric;
pub use plane::Plane;
pub use profile::Profile;
pub use radial::{Radial, RadialCells};
pub use scatter::Scatter;
pub use set::FeatureSet;
pub use space::{Axes, Space, Vector};
pub use worley::{CellPoint, Feature, LIMIT, RESOLUTION, Worley, Worley2, Worley3, Worley4};

#[cfg(test)]
mod tests;
