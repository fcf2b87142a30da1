//! Fills the tile with copies of a texture whose interiors differ.

use super::{NodeKind, NodeSeed, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_raster::{Range, range};
use dapple_tile::Disturbance;
use serde::{Deserialize, Serialize};

/// Copies of a tile with equal borders and different interiors: see [`Disturbance`]. The result depends on the whole
/// tile.
///
/// [`Disturbance`]: dapple_tile::Disturbance
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Disturbed {
    /// Texture that repeats: a number or a color.
    ///
    /// Each copy shows a whole tile of the texture, scaled down.
    pub input: Input,
    /// Number of copies along each axis, x first. The size of a bake must be a multiple of this number.
    #[serde(default = "four")]
    #[cfg_attr(feature = "schema", schemars(transform = { COPIES }))]
    pub copies: [u32; 2],
    /// Width of the unchanged strip along each border of a copy, in pixels.
    #[serde(default = "frozen")]
    pub frozen: u32,
    /// Width of the strip next to the unchanged one in which the cut may run, in pixels.
    ///
    /// Together, `frozen` and `margin` are at most half of a copy's side.
    #[serde(default = "margin")]
    pub margin: u32,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

fn four() -> [u32; 2] {
    [4; 2]
}

fn frozen() -> u32 {
    Disturbance::default().frozen
}

fn margin() -> u32 {
    Disturbance::default().margin
}

pub(super) const COPIES: Range = range!(at least 1);

/// Returns an error if a number of copies is 0.
pub(super) fn check_copies(copies: [u32; 2]) -> Result<(), RecipeError> {
    let mut counts = copies.into_iter();
    counts.try_for_each(|count| RecipeError::check_in(COPIES, "number of copies", count.into()))
}

impl NodeKind for Disturbed {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        check_copies(self.copies)?;
        let disturbance = Disturbance {
            frozen: self.frozen,
            margin: self.margin,
            seed: plan.seed(self.seed.as_ref()),
        };
        let inputs = vec![plan.any(&self.input)?];
        Ok(plan.global(inputs, self.copies, move |tile| {
            let (maps, size) = (tile.maps()?, tile.window.size);
            let is_cancelled = tile.is_cancelled();
            Values::of_map(disturbance.render_maps_cancellable(
                &maps,
                [0, 0],
                size,
                &is_cancelled,
            )?)
        }))
    }
}
