//! Edges: where a node changes.

use super::{NodeKind, inputs};
use crate::plan::{Builder, Step};
use crate::{Input, RecipeError, Values};
use dapple_filter::{difference_spans, gradients};
use serde::{Deserialize, Serialize};

/// Edges of a number or a color: how much it changes over the radius, which is the length of its gradient times the
/// radius.
///
/// It is ½ within the radius of a straight border between 0 and 1. For colors it is the root mean square of the channels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Edges {
    /// Number or color.
    pub input: Input,
    /// Radius of the differences, in units of the plane. They are taken over a whole number of pixels, and at least one.
    #[cfg_attr(feature = "schema", schemars(transform = { crate::plan::RADIUS }))]
    pub radius: f64,
}

impl NodeKind for Edges {
    inputs!(input);

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        let radius = plan.radius(Some(self.radius), 0.0)?;
        let input = plan.any(&self.input)?;
        let halo = move |pixel| difference_spans(radius, pixel);
        let step = plan.neighborhood(vec![input], halo, move |around| {
            let edges =
                |values: &[f32]| gradients(values, &around.part, radius, &|change| change as f32);
            Ok(Values::Numbers(match around.each_channel(0, edges) {
                Values::Numbers(edges) => edges,
                Values::Colors(edges) => edges
                    .iter()
                    .map(|edges| {
                        let squares = edges.to_array().map(|edge| edge * edge);
                        ((squares[0] + squares[1] + squares[2]) / 3.0).sqrt()
                    })
                    .collect(),
            }))
        });
        Ok(step.with_numbers())
    }
}
