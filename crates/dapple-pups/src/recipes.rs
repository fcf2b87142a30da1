//! The textures of the paper's section 3, each built by one function.
//!
//! Reference: Jack Caron and David Mould, "Partition of Unity Parametrics for Texture Synthesis", Graphics Interface
//! 2013, section 3.
//!
//! A recipe is a function of its options and a seed: it places control points, assigns attributes, and returns a
//! texture. By default, a recipe has the paper's parameters, is defined on the paper's torus `[-1, 1]²`, and repeats
//! with its period. The spacing of the points and the probability of a label may depend on the position, for a
//! progression. A progression from left to right needs a domain that does not wrap in x.
//!
//! To add a recipe, write a file that implements [`PupsRecipe`] for its options, and add a line to the table of
//! [`recipes!`](crate::recipes!).

/// Implements the accessors of [`PupsRecipe`] for the fields `domain` and `net`. With `points`, also estimates the
/// number of points from the field `spacing`.
macro_rules! net_of {
    (points) => {
        fn expected_points(&self) -> f64 {
            self.spacing.expected_points(self.domain)
        }

        net_of!();
    };
    ($(.$inner:tt)?) => {
        fn domain_mut(&mut self) -> &mut dapple_points::Domain {
            &mut self$(.$inner)?.domain
        }

        fn net_mut(&mut self) -> &mut crate::NetOptions {
            &mut self$(.$inner)?.net
        }
    };
}

mod label_texture;
mod layers;
mod net_options;
mod spacing;

mod cells;
mod cellular_noise;
mod color_noise;
mod control_net;
mod control_points;
mod cow;
mod iterated;
mod noise;
mod octave;
mod octaves;
mod orbits;
mod progression;
mod reference;
mod space_giraffe;

pub use cells::{CellsOptions, cells};
pub use cellular_noise::{CellularNoiseOptions, cellular_noise};
pub use color_noise::{ColorNoiseOptions, color_noise};
pub use control_net::{ControlNet, NetField, NetValues};
pub use control_points::{Cells, ControlPoint, ControlPoints, control_points};
pub use cow::{CowOptions, cow};
pub use iterated::{IteratedOptions, IterationPoints, iterated_reference};
pub use label_texture::{LabelTexture, VectorLabelTexture};
pub use layers::Layers;
pub use net_options::NetOptions;
pub use noise::{NoiseOptions, noise};
pub use octave::{Folding, Octave};
pub use octaves::{OctaveSource, OctavesOptions, TurbulenceOptions, octaves, turbulence};
pub use orbits::Orbits;
pub use progression::{
    CowProgressionOptions, GiraffeProgressionOptions, LabelRampOptions, ProgressionOptions,
    cow_progression, giraffe_progression, label_ramp,
};
pub use reference::{ReferenceOptions, reference_texture};
pub use space_giraffe::{SpaceGiraffeOptions, Spots, space_giraffe};
pub use spacing::Spacing;

use crate::{PupsError, VectorTexture};
use dapple_hash::Seed;
use dapple_points::Domain;
use std::sync::Arc;

/// The common interface of the options of all textures. `Image` is the input of the texture: nothing, or a
/// [`ReferenceImage`](crate::ReferenceImage).
pub trait PupsRecipe<Image = ()>: Clone + Default {
    /// Whether the texture's values are colors rather than scalars.
    const IS_COLOR: bool = false;

    /// Returns the domain of the control points. If the default domain does not wrap along an axis, the texture
    /// changes along that axis, and any other domain must not wrap there either.
    fn domain_mut(&mut self) -> &mut Domain;

    /// Returns the options for the weights and the motion of the control points, for changing them.
    fn net_mut(&mut self) -> &mut NetOptions;

    /// Estimates the number of control points without generating them. The estimate is more likely too large than too
    /// small, and may be infinite.
    fn expected_points(&self) -> f64;

    /// Builds the texture. Random values of its control points are in the range 0 to 1.
    ///
    /// # Errors
    ///
    /// Same as the constructor of the recipe's texture.
    fn build(&self, image: &Image, seed: Seed) -> Result<PupsField, PupsError>;
}

/// A texture of scalars or colors in the plane.
#[derive(Clone)]
pub enum PupsField {
    /// One scalar at each position.
    Numbers(Arc<dyn NetField>),
    /// One color at each position.
    Colors(Box<VectorTexture<3>>),
}

impl PupsField {
    fn numbers(field: impl NetField + 'static) -> Self {
        Self::Numbers(Arc::new(field))
    }
}

impl core::fmt::Debug for PupsField {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Numbers(_) => "Numbers",
            Self::Colors(_) => "Colors",
        })
    }
}

/// Passes the table of all recipes to another macro. Each row has the recipe's serialized name, its name in Rust, and
/// its options type. Recipes that need an image are wrapped in `Referenced`, which the caller defines.
#[doc(hidden)]
#[macro_export]
macro_rules! recipes {
    ($table:ident) => {
        $table! {
            /// Interpolated random values, from 0 to 1.
            "noise" Noise($crate::NoiseOptions),
            /// Octaves of noise, from 0 to 1.
            "octaves" Octaves($crate::OctavesOptions),
            /// Turbulence: octaves of folded noise, from 0 to 1.
            "turbulence" Turbulence($crate::TurbulenceOptions),
            /// Cells, each with a random value from 0 to 1.
            "cells" Cells($crate::CellsOptions),
            /// Layers of cells with random values, from 0 to 1.
            "cellular_noise" CellularNoise($crate::CellularNoiseOptions),
            /// Interpolated random colors from a palette.
            "color_noise" ColorNoise($crate::ColorNoiseOptions),
            /// Patches of a cow, 0 or 1.
            "cow" Cow($crate::CowOptions),
            /// Spots of a giraffe (0) on a background (1).
            "space_giraffe" SpaceGiraffe($crate::SpaceGiraffeOptions),
            /// Patches of a cow that get smaller to the right, 0 or 1.
            "cow_progression" CowProgression($crate::CowProgressionOptions),
            /// Spots of a giraffe that get smaller to the right.
            "giraffe_progression" GiraffeProgression($crate::GiraffeProgressionOptions),
            /// Black cells on the left, white cells on the right.
            "label_ramp" LabelRamp($crate::LabelRampOptions),
            /// Black and white cells that follow an image.
            "reference" Reference(Referenced<$crate::ReferenceOptions>),
            /// Black and white cells that follow an image, refined in iterations to edges like a coast.
            "iterated_reference" IteratedReference(Referenced<$crate::IteratedOptions>),
            /// Texture of control points that are given one by one.
            "points" Points($crate::ControlPoints),
        }
    };
}
