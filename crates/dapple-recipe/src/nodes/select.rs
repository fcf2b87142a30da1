//! Chooses one of several inputs by a number.

use super::NodeKind;
use crate::plan::{Builder, Step, at_least_one};
use crate::shader::{Code, NodeShader, Refusal, literal};
use crate::{Input, RecipeError, Values};
use serde::{Deserialize, Serialize};

/// One of several inputs, chosen by a number from 0 to 1, such as the random number of a brick.
///
/// The range from 0 to 1 is divided evenly; numbers outside of it choose the first or the last input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Select {
    /// Numbers or colors, at least one.
    pub inputs: Vec<Input>,
    /// Number that chooses an input.
    pub by: Input,
}

impl NodeKind for Select {
    fn inputs(&self) -> Vec<&Input> {
        self.inputs.iter().chain([&self.by]).collect()
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let choices = at_least_one(self.inputs.iter().collect())?;
        let mut inputs = vec![plan.number(&self.by)?];
        for input in choices {
            inputs.push(plan.any(input)?);
        }
        Ok(plan.local(inputs, |inputs| {
            Ok(selected(inputs[0].numbers(), &inputs[1..]))
        }))
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let by = shader.number(&self.by)?;
        let (inputs, is_color) = shader.alike(&self.inputs)?;
        let count = literal(inputs.len() as f32);
        let place = shader.name("choice", format!("number_mul({by}, {count}, zero)"));
        let mut choices = (0_u16..).zip(inputs);
        let Some((_, mut text)) = choices.next() else {
            return Err(Refusal::new("it has no inputs"));
        };
        for (index, input) in choices {
            let bound = literal(index.into());
            text = format!("select({text}, {input}, {place} >= {bound})");
        }
        Ok(Code { text, is_color })
    }
}

/// Returns, for each number of `by`, the value of the input that it selects.
fn selected(by: &[f32], inputs: &[&Values]) -> Values {
    let last = inputs.len() - 1;
    // Numbers below 0 and not-a-numbers become 0.
    let choices = by
        .iter()
        .map(|by| ((by * inputs.len() as f32) as usize).min(last));
    let choices = choices.enumerate();
    if inputs
        .iter()
        .all(|input| matches!(input, Values::Numbers(_)))
    {
        return Values::Numbers(
            choices
                .map(|(at, input)| inputs[input].numbers()[at])
                .collect(),
        );
    }
    let colors: Vec<_> = inputs.iter().map(|input| input.colors()).collect();
    Values::Colors(choices.map(|(at, input)| colors[input][at]).collect())
}
