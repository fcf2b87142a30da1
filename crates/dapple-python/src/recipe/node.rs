//! Nodes of recipes as fields.

use crate::error::Result;
use crate::function::Function;
use crate::shared::Build;
use dapple::recipe::{Images, Plan, Recipe};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The description of a field of a recipe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct NodeMade {
    /// The recipe as JSON.
    pub(super) recipe: String,
    /// The name of the node; `None` for the height.
    pub(super) node: Option<String>,
    pub(super) time: f64,
}

impl Build for NodeMade {
    type Built = Function;

    fn build(&self) -> Result<Function> {
        let plan = Plan::new(&Recipe::from_json(&self.recipe)?, &Images::new(), self.time)?;
        Ok(Function::Plane(Arc::new(match &self.node {
            Some(node) => plan.field(node)?,
            None => plan.height()?,
        })))
    }
}
