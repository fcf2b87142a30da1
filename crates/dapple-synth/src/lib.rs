//! Texture synthesis from an example image, on triangle meshes and on the plane.

#![forbid(unsafe_code)]

mod candidates;
mod columns;
mod directions;
mod error;
mod exemplar;
mod links;
mod matcher;
mod neighborhood;
mod orientation;
mod parents;
#[cfg(test)]
mod shapes;
mod solve;
mod sweep;

pub use candidates::{Candidates, CoarserCenter};
pub use dapple_mesh as mesh;
pub use error::{SynthError, SynthErrorKind};
pub use exemplar::{Edges, Exemplar, Pyramid};
pub use matcher::{Match, Matcher, MatcherMemory, distance_sq};
pub use neighborhood::{Part, Pass, Reads, Schedule, Shape};
pub use orientation::{Direction, Orientation};
pub use sweep::Sweep;
