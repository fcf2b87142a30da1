//! Maps a range of numbers to another.

use super::NodeKind;
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// A range mapped to another, which turns most textures into heights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Levels {
    /// The number.
    pub input: Input,
    /// The range that is mapped; 0 to 1 by default. It may be descending, but its ends must differ.
    #[serde(default = "unit")]
    pub from: [f32; 2],
    /// The results at the ends of `from`; 0 to 1 by default.
    #[serde(default = "unit")]
    pub to: [f32; 2],
    /// The curve between the ends; a line by default.
    #[serde(default)]
    pub curve: LevelsCurve,
}

fn unit() -> [f32; 2] {
    [0.0, 1.0]
}

const END: Range = range!(finite);

/// The curve between the ends of a range. All but the first are constant outside of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum LevelsCurve {
    /// A line that continues past the ends.
    Unclamped,
    /// A line.
    #[default]
    Linear,
    /// `3t² − 2t³`, which is flat at its ends.
    Smooth,
}

impl NodeKind for Levels {
    fn inputs(&self) -> Vec<&Input> {
        vec![&self.input]
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let (from, to, curve) = (self.from, self.to, self.curve);
        for end in from.into_iter().chain(to) {
            RecipeError::check_in(END, "end of a range", end.into())?;
        }
        let length = from[1] - from[0];
        let holds = length != 0.0 && length.is_finite();
        let what = "length of the range `from`";
        RecipeError::check(holds, what, length.into(), "finite and not 0")?;
        plan.each(&self.input, move |value| {
            let t = (value - from[0]) / (from[1] - from[0]);
            to[0] + (to[1] - to[0]) * curve.at(t)
        })
    }
}

impl LevelsCurve {
    /// Maps `t`, a fraction of the range `from`, to a fraction of the range `to`.
    fn at(self, t: f32) -> f32 {
        match self {
            Self::Unclamped => t,
            Self::Linear => t.clamp(0.0, 1.0),
            Self::Smooth => {
                let t = t.clamp(0.0, 1.0);
                t * t * (3.0 - 2.0 * t)
            }
        }
    }
}
