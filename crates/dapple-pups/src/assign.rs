//! Functions that compute attributes of control points. They can be combined.
//!
//! Reference: Jack Caron and David Mould, "Partition of Unity Parametrics for Texture Synthesis", Graphics Interface
//! 2013, section 3: control points get their attributes "randomly, according to spatial location or graph connectivity,
//! or according to a reference image".
//!
//! Every function returns one value, label or vector for each control point, in the order of the points. Random
//! attributes depend only on the seed and the point's index, so a point that retains its index retains its attribute.
//! Use a separate seed for each attribute: [`Seed::child`](dapple_hash::Seed::child).

mod groups;
mod labels;
mod orientations;
mod reference;
mod values;

#[cfg(feature = "schema")]
pub(crate) use groups::POINTS_PER_CELL;
pub use groups::grouped_labels;
pub use labels::{biased_labels, own_labels, random_labels};
pub use orientations::{
    Orientations, angle_orientations, field_orientations, outward_orientations, random_orientations,
};
pub use reference::{ReferenceImage, reference_labels};
pub use values::{field_values, palette_values, random_values, varying_values};
