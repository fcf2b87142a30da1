//! Maps a range of numbers to another.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, literal, quotient};
use crate::{Input, RecipeError};
use dapple_raster::{Range, range};
use serde::{Deserialize, Serialize};

/// Number mapped from one range to another, for example to convert a texture to a height.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Levels {
    /// Number to map.
    pub input: Input,
    /// Range of the input that is mapped to `to`. The range may be descending, but its ends must differ.
    #[serde(default = "unit")]
    pub from: [f32; 2],
    /// Results at the two ends of `from`.
    #[serde(default = "unit")]
    pub to: [f32; 2],
    /// Curve between the ends of the range.
    #[serde(default)]
    pub curve: LevelsCurve,
}

fn unit() -> [f32; 2] {
    [0.0, 1.0]
}

const END: Range = range!(finite);

/// Curve between the ends of a range.
///
/// All curves except `unclamped` are constant outside of the range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum LevelsCurve {
    /// Straight line that continues past the ends.
    Unclamped,
    /// Straight line between the ends.
    #[default]
    Linear,
    /// Smoothstep curve `3t² − 2t³`, whose slope is 0 at both ends.
    Smooth,
}

impl NodeKind for Levels {
    inputs!(input);

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

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let input = shader.number(&self.input)?;
        let [from, to] = [self.from, self.to];
        let above = match from[0] == 0.0 {
            true => input,
            false => format!("number_sub({input}, {}, zero)", literal(from[0])),
        };
        let t = quotient(&above, from[1] - from[0]);
        let t = match self.curve {
            LevelsCurve::Unclamped => t,
            LevelsCurve::Linear => format!("number_clamp({t}, 0.0, 1.0, zero)"),
            LevelsCurve::Smooth => {
                format!("number_smooth(number_clamp({t}, 0.0, 1.0, zero), zero)")
            }
        };
        let (start, length) = (literal(to[0]), to[1] - to[0]);
        if !length.is_finite() {
            return Err(Refusal::new("the length of its range `to` is infinite"));
        }
        let part = match length == 1.0 {
            true => t,
            false => format!("number_mul({}, {t}, zero)", literal(length)),
        };
        Ok(Code::number(format!("number_add({start}, {part}, zero)")))
    }
}

impl LevelsCurve {
    /// Maps `t`, a fraction of the range `from`, to a fraction of the range `to`, by this curve.
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
