//! Partition-of-unity parametrics: control-point values interpolated over the plane, and the paper's textures.

mod assignments;
mod partition;
mod textures;
mod vectors;

pub(crate) use assignments::{
    angle_orientations, biased_labels, grouped_labels, outward_orientations, random_labels,
    random_orientations, random_values, reference_labels,
};
pub(crate) use partition::{_partition_from_description, Partition, PupsMade, pups};
pub(crate) use textures::{_texture, _texture_defaults, TextureMade};
pub(crate) use vectors::{Values, Vectors};
