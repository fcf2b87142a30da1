//! Interpolates between two inputs.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::shader::{Code, NodeShader, Refusal, lerp};
use crate::{Input, RecipeError, Values};
use serde::{Deserialize, Serialize};

/// Interpolation between two inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Mix {
    /// Number or color where `by` is 0.
    pub from: Input,
    /// Number or color where `by` is 1.
    pub to: Input,
    /// Interpolation weight: a number, clamped to 0 to 1.
    pub by: Input,
}

impl NodeKind for Mix {
    inputs!(from, to, by);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let inputs = vec![
            plan.any(&self.from)?,
            plan.any(&self.to)?,
            plan.number(&self.by)?,
        ];
        Ok(plan.local(inputs, |inputs| Ok(mix(inputs))))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let [from, to] = [shader.any(&self.from)?, shader.any(&self.to)?];
        let by = shader.number(&self.by)?;
        if !from.is_color && !to.is_color {
            let [from, to] = [from.text, to.text];
            return Ok(Code::number(format!(
                "number_mix({from}, {to}, {by}, zero)"
            )));
        }
        let by = shader.name("part", format!("number_clamp({by}, 0.0, 1.0, zero)"));
        Ok(Code::color(lerp(&from.to_color(), &to.to_color(), &by)))
    }
}

fn mix(inputs: &[&Values]) -> Values {
    let by = inputs[2].numbers();
    if let [Values::Numbers(from), Values::Numbers(to), _] = inputs {
        let ends = from.iter().zip(to).zip(by);
        return Values::Numbers(
            ends.map(|((&from, &to), &by)| from + (to - from) * by.clamp(0.0, 1.0))
                .collect(),
        );
    }
    let [from, to] = [0, 1].map(|index: usize| inputs[index].colors());
    let ends = from.iter().zip(&*to).zip(by);
    Values::Colors(
        ends.map(|((from, &to), &by)| from.lerp(to, by.clamp(0.0, 1.0)))
            .collect(),
    )
}
