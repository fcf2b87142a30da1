//! Secondary outputs of nodes that compute several values, such as the random number of a brick in addition to its
//! height.

use super::{KINDS, NEW_NODES, Node, NodeKind, inputs};
use crate::plan::{Builder, Step, Work};
use crate::shader::{Code, NodeShader, Refusal};
use crate::{Input, RecipeError, RecipeErrorKind};
use serde::{Deserialize, Serialize};

/// Another value of a node that has several, computed with the same options and random numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Node with several values, such as `bricks` or `worley`. A number or a color is its own value.
    pub of: Input,
    /// Value of the node, by its name among the values of its kind.
    #[serde(default = "random")]
    pub value: String,
}

fn random() -> String {
    "random".to_owned()
}

impl NodeKind for Output {
    inputs!(of);

    fn work(&self, plan: &Builder<'_>) -> Result<Work, RecipeError> {
        match plan.node_of(&self.of)? {
            Some((_, node)) => self.node(node)?.work(plan),
            None => Ok(Work::default()),
        }
    }

    fn build(&self, plan: &mut Builder<'_>) -> Result<Step, RecipeError> {
        match plan.node_of(&self.of)? {
            // Build the other value under the name of its node, from which the node's seed is derived.
            Some((name, node)) => {
                let node = self.node(node)?;
                plan.as_node(name, |plan| node.build(plan))
            }
            None => plan.constant(&self.of),
        }
    }

    fn shader(&self, shader: &mut NodeShader<'_, '_>) -> Result<Code, Refusal> {
        let (node, kind) = match shader.node_of(&self.of) {
            Some((name, node)) => (name, self.node(node)?),
            None => return shader.any(&self.of),
        };
        kind.shader(&mut shader.as_node(node))
    }
}

impl Output {
    /// Returns a copy of the node whose value is this output.
    fn node(&self, node: &Node) -> Result<Box<dyn NodeKind>, RecipeError> {
        let kind = node.kind();
        kind.with_output(&self.value).ok_or_else(|| {
            let (value, outputs) = (self.value.clone(), kind.outputs());
            if outputs.is_empty() {
                let (node, kinds) = (self.of.written(), kinds_with_outputs());
                return RecipeError::new(RecipeErrorKind::SingleOutput { node, kinds });
            }
            let error = RecipeError::new(RecipeErrorKind::UnknownOutput { value, outputs });
            error.meant(&self.value, outputs.iter().copied())
        })
    }
}

/// Returns the kinds of nodes that have several values.
fn kinds_with_outputs() -> Vec<&'static str> {
    let has_outputs = |(kind, (_, options)): &(&str, (&str, &str))| {
        let node = serde_json::from_str::<Node>(&format!("{{\"{kind}\":{options}}}"));
        node.is_ok_and(|node| !node.kind().outputs().is_empty())
    };
    let kinds = KINDS.into_iter().zip(NEW_NODES).filter(has_outputs);
    kinds.map(|(kind, _)| kind).collect()
}
