//! Tests of the basis against an oracle, through its public interface, so that the kernels are compiled only once, in
//! the library.

mod bits;
mod cell_values;
mod edges;
mod far_away;
mod fixed;
mod forced;
mod fractal;
mod lipschitz;
mod many;
mod oracle;
mod planes;
mod profile;
mod properties;
mod radial;
mod ranges;
#[cfg(feature = "serde")]
mod serialized;
mod set;
mod shader;
mod sheet;
mod slice;
mod stability;
mod statistics;
mod threads;
mod varying;
mod voronoi;
mod ways;
