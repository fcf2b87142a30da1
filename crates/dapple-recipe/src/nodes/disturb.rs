//! Copies of a texture that differ inside.

use super::{NodeKind, NodeSeed};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_pups::{Range, range};
use dapple_tile::Disturbance;
use serde::{Deserialize, Serialize};

/// The tile as copies of a texture, each with another piece of it inside of its border: see [`Disturbance`]. It sees the whole
/// tile.
///
/// [`Disturbance`]: dapple_tile::Disturbance
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Disturbed {
    /// A number or a color, which repeats: each copy is all of it, made smaller.
    pub input: Input,
    /// How many copies there are along each axis, x first; `[4, 4]` by default. They have a whole number of pixels.
    #[serde(default = "four")]
    #[cfg_attr(feature = "schema", schemars(transform = { COPIES }))]
    pub copies: [u32; 2],
    /// How many pixels along each border of a copy stay as they are; 4 by default.
    #[serde(default = "frozen")]
    pub frozen: u32,
    /// How many more pixels the cut may take; 24 by default. Together at most half of a copy.
    #[serde(default = "margin")]
    pub margin: u32,
    /// The name by which it draws, instead of its own, or a seed.
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

/// Refuses no copy at all.
pub(super) fn check_copies(copies: [u32; 2]) -> Result<(), RecipeError> {
    let mut counts = copies.into_iter();
    counts.try_for_each(|count| RecipeError::check_in(COPIES, "number of copies", count.into()))
}

impl NodeKind for Disturbed {
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.input]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        check_copies(self.copies)?;
        let disturbance = Disturbance {
            frozen: self.frozen,
            margin: self.margin,
            seed: plan.seed(self.seed.as_ref()),
        };
        let inputs = vec![plan.any(&self.input)?];
        Ok(plan.global(inputs, self.copies, move |tile| {
            Values::of_map(disturbance.render_maps(&tile.maps()?, [0, 0], tile.window.size)?)
        }))
    }
}
