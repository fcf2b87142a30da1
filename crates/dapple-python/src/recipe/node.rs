//! Recipe nodes as fields.

use crate::error::Result;
use crate::function::Function;
use crate::shared::Build;
use crate::watch::Stop;
use dapple::recipe::{Images, Plan, PlanLimits, Recipe, RecipeError};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The description of a field defined by a recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct NodeMade {
    /// The recipe as JSON.
    pub(super) recipe: String,
    /// The name of the node; `None` for the material's height.
    pub(super) node: Option<String>,
    pub(super) time: f64,
}

impl Build for NodeMade {
    type Built = Function;

    fn build(&self) -> Result<Function> {
        let recipe = Recipe::from_json(&self.recipe)?;
        let plan = plan(&recipe, &Images::new(), self.time, Stop::current())?;
        Ok(Function::Plane(Arc::new(match &self.node {
            Some(node) => plan.field(node)?,
            None => plan.height()?,
        })))
    }
}

/// Builds the plan of a recipe; stops if requested.
pub(super) fn plan(
    recipe: &Recipe,
    images: &Images,
    time: f64,
    stop: Stop,
) -> core::result::Result<Plan, RecipeError> {
    let limits = PlanLimits::default();
    Plan::new_with_progress(recipe, images, time, &limits, None, move |_| stop.flow())
}
