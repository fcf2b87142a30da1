//! Corner tiles: tiles cut from several textures, placed in random order.

use super::disturb::check_copies;
use super::{NodeKind, NodeSeed};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, RecipeErrorKind, Values};
use dapple_tile::CornerTiles;
use serde::{Deserialize, Serialize};

/// Grid of pieces of several textures, chosen by random colors at the corners of the pieces: see [`CornerTiles`]. The
/// result depends on the whole tile.
///
/// [`CornerTiles`]: dapple_tile::CornerTiles
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CornerTilesOf {
    /// Textures that repeat, two to four: numbers or colors.
    ///
    /// Each piece shows a whole tile of a texture, scaled down.
    pub inputs: Vec<Input>,
    /// Number of pieces along each axis, x first. The size of a bake must be a multiple of this number.
    #[serde(default = "four")]
    #[cfg_attr(feature = "schema", schemars(transform = { super::disturb::COPIES }))]
    pub copies: [u32; 2],
    /// Share of a piece's side in which cuts may run, above 0 and at most 1.
    #[serde(default = "half")]
    pub width: f64,
    /// Seed, or the name of the node whose random numbers are used [default: this node's name].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<NodeSeed>,
}

fn four() -> [u32; 2] {
    [4; 2]
}

fn half() -> f64 {
    0.5
}

impl NodeKind for CornerTilesOf {
    fn inputs(&self) -> Vec<&Input> {
        self.inputs.iter().collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        check_copies(self.copies)?;
        let count = self.inputs.len();
        if !(2..=4).contains(&count) {
            let (what, needed) = ("inputs", "2 to 4");
            return Err(RecipeError::new(RecipeErrorKind::Count {
                what,
                count,
                needed,
            }));
        }
        let (seed, copies, width) = (plan.seed(self.seed.as_ref()), self.copies, self.width);
        let inputs = self.inputs.iter().map(|input| plan.any(input));
        let inputs = inputs.collect::<Result<_, _>>()?;
        Ok(plan.global(inputs, copies, move |tile| {
            let maps: Vec<_> = tile.maps()?.into_iter().map(|map| vec![map]).collect();
            let is_cancelled = tile.is_cancelled();
            let tiles = CornerTiles::new_cancellable(&maps, width, &is_cancelled)?
                .with_period(copies.map(Some))?;
            let size = tile.window.size;
            Values::of_map(tiles.render_cancellable(seed, [0, 0], size, &is_cancelled)?)
        }))
    }
}
