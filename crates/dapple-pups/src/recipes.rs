//! The textures of section 3, each in one call.
//!
//! Reference: Jack Caron and David Mould, "Partition of Unity Parametrics for Texture Synthesis", Graphics Interface
//! 2013, section 3.
//!
//! A recipe is a function of its options and a seed: it places control points, gives them attributes and returns a
//! texture. By default each has the paper's parameters, on the paper's torus `[-1, 1]²`, and repeats with its period.
//! Each can progress: the spacing of the points and the probability of a label may depend on the position. A
//! progression from left to right belongs on a domain that does not wrap in x.

mod label_texture;
mod layers;
mod net_options;
mod spacing;

mod cells;
mod cellular_noise;
mod color_noise;
mod cow;
mod iterated;
mod noise;
mod octave;
mod octaves;
mod progression;
mod reference;
mod space_giraffe;

pub use cells::{CellsOptions, cells};
pub use cellular_noise::{CellularNoiseOptions, cellular_noise};
pub use color_noise::{ColorNoiseOptions, color_noise};
pub use cow::{CowOptions, cow};
pub use iterated::{IteratedOptions, IterationPoints, iterated_reference};
pub use label_texture::{LabelTexture, VectorLabelTexture};
pub use layers::Layers;
pub use net_options::NetOptions;
pub use noise::{NoiseOptions, noise};
pub use octave::{Folding, Octave};
pub use octaves::{OctaveSource, OctavesOptions, octaves, turbulence};
pub use progression::{
    LabelRampOptions, ProgressionOptions, cow_progression, giraffe_progression, label_ramp,
};
pub use reference::{ReferenceOptions, reference_texture};
pub use space_giraffe::{SpaceGiraffeOptions, Spots, space_giraffe};
pub use spacing::Spacing;

#[cfg(test)]
mod tests;
