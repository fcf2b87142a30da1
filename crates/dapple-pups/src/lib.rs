//! Partition-of-unity parametrics for texture synthesis: values, orientations, labels and the texture recipes.
//!
//! Reference: Jack Caron and David Mould, "Partition of Unity Parametrics for Texture Synthesis", Graphics Interface
//! 2013.
//!
//! Control points lie in the plane and are connected by a graph. The edges at a control point are its axes; a position
//! is projected onto each of them, every projection gives an axial weight, and their product is the weight of the
//! control point. [`Pups`] holds such a net. [`Texture`] gives the control points values and interpolates them;
//! [`Pups::strongest`] gives every position the label of its strongest control point.
//!
//! The textures of the paper are recipes on top of that, such as [`noise`], [`octaves`], [`cells`] and [`cow`]: each is
//! one call with options and a seed. For textures of your own, place points, give them attributes ([`random_values`],
//! [`biased_labels`], [`grouped_labels`], [`random_orientations`] and others), and make a texture of them. To change control
//! points one by one, as an editor does, use [`EditablePups`].

#![forbid(unsafe_code)]

mod error;
mod options;
mod range;
mod weight;

mod net;
mod pups;
mod support;
mod texture;

mod profile;

mod power;
mod shift;

mod bins;
mod sample;

mod gradient;

mod render;

mod line;
mod splat;
mod tile;

mod sink;

mod assign;
mod recipes;

mod editable;

#[cfg(feature = "schema")]
mod schema;

pub use assign::{
    Orientations, ReferenceImage, angle_orientations, biased_labels, field_orientations,
    field_values, grouped_labels, outward_orientations, own_labels, palette_values, random_labels,
    random_orientations, random_values, reference_labels, varying_values,
};
pub use dapple_graph as graph;
pub use dapple_hash as hash;
pub use dapple_points as points;
pub use dapple_points::{Cancel, IsCancelled};
pub use dapple_raster as raster;
pub use editable::{Changed, EditablePups};
pub use error::{PupsError, PupsErrorKind};
pub use glam;
pub use options::{Orientation, PupsOptions};
pub use pups::Pups;
pub use range::Range;
pub use recipes::{
    Cells, CellsOptions, CellularNoiseOptions, ColorNoiseOptions, ControlNet, ControlPoint,
    ControlPoints, CowOptions, CowProgressionOptions, Folding, GiraffeProgressionOptions,
    IteratedOptions, IterationPoints, LabelRampOptions, LabelTexture, Layers, NetField, NetOptions,
    NetValues, NoiseOptions, Octave, OctaveSource, OctavesOptions, Orbits, ProgressionOptions,
    PupsField, PupsRecipe, ReferenceOptions, SpaceGiraffeOptions, Spacing, Spots,
    TurbulenceOptions, VectorLabelTexture, cells, cellular_noise, color_noise, control_points, cow,
    cow_progression, giraffe_progression, iterated_reference, label_ramp, noise, octaves,
    reference_texture, space_giraffe, turbulence,
};
pub use texture::{Texture, VectorTexture};
pub use weight::AxialWeight;
