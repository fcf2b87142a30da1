//! Shows a sector of a node all around a center, as a kaleidoscope does.

use super::{NodeKind, distance, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use core::f64::consts::TAU;
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// Another node, whose sector to the right of a center is repeated around the center; each sector is symmetric.
///
/// Along axes on which the recipe repeats, the center is the nearest of its copies. Where a pattern with the symmetry of
/// the sectors does not fit the tile, there is an edge halfway between two copies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Kaleidoscope {
    /// Node that is shown. A node that depends on the whole tile is interpolated between its pixels.
    pub input: Input,
    /// Number of sectors.
    #[serde(default = "six")]
    #[cfg_attr(feature = "schema", schemars(transform = { SECTORS }))]
    pub sectors: u32,
    /// Position of the center, in units of the plane [default: the middle of the tile].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center: Option<[f64; 2]>,
}

fn six() -> u32 {
    6
}

const SECTORS: Range = range!(from 1 to 256);

impl NodeKind for Kaleidoscope {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        RecipeError::check_in(SECTORS, "number of sectors", self.sectors.into())?;
        let (center, tile) = (distance::center(plan, self.center)?, plan.domain());
        let sectors = f64::from(self.sectors);
        // The direction of the middle of each sector
        let middles =
            (0..self.sectors).map(|sector| libm::sincos(TAU * f64::from(sector) / sectors));
        let middles: Vec<_> = middles.collect();
        plan.folded(&self.input, move |position| {
            let [x, y] = distance::offset(position, center, &tile);
            let sector = (libm::atan2(y, x) / TAU * sectors + 0.5).floor() as i64;
            let (sin, cos) = middles[sector.rem_euclid(middles.len() as i64) as usize];
            // Rotate the sector to the right, and fold it at its middle.
            let [x, y] = [x * cos + y * sin, (y * cos - x * sin).abs()];
            [center[0] + x, center[1] + y]
        })
    }
}
