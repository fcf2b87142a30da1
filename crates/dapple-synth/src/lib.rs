//! Texture synthesis from an example image, on triangle meshes and on the plane.

#![forbid(unsafe_code)]

mod atlas;
mod bake;
mod bake_normals;
mod candidates;
mod cells;
mod columns;
mod directions;
mod displaced;
mod display;
mod engine;
mod error;
mod exemplar;
mod grid;
mod ground;
mod groups;
mod likeness;
mod links;
mod maps;
mod matcher;
mod mesh_ground;
mod neighborhood;
mod options;
mod orientation;
mod parents;
mod plane;
#[cfg(test)]
mod shapes;
mod solve;
mod surface_texture;
mod sweep;
mod synthesizer;
mod visit;

pub use atlas::{Atlas, PADDING};
pub use bake::bake;
pub use bake_normals::bake_normals;
pub use candidates::{Candidates, CoarserCenter};
pub use dapple_mesh as mesh;
pub use displaced::{displaced_mesh, displaced_sites};
pub use display::{point_model, site_model, textured_model};
pub use engine::Progress;
pub use error::{SynthError, SynthErrorKind};
pub use exemplar::{Edges, Exemplar, Pyramid};
pub use likeness::Likeness;
pub use maps::{bake_colors, bake_values};
pub use matcher::{Match, Matcher, MatcherMemory, distance_sq};
pub use neighborhood::{Part, Pass, Reads, Schedule, Shape};
pub use options::Options;
pub use orientation::{Direction, Orientation};
pub use plane::{PlaneTexture, synthesize_plane, synthesize_plane_with};
pub use surface_texture::SurfaceTexture;
pub use sweep::Sweep;
pub use synthesizer::{Synthesizer, synthesize};
