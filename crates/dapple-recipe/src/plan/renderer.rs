//! Computes nodes of a plan outside of it, such as on a GPU.

use super::evaluate::Known;
use super::{Plan, Whole};
use crate::{RecipeError, RecipeErrorKind, Values};
use core::error::Error;
use core::fmt;
use dapple_raster::Window;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Computes nodes of a plan in windows, with the same bits as the plan.
///
/// A plan [with a renderer](Plan::with_renderer) passes nodes to it in bakes and in images of nodes, and computes the
/// other nodes itself.
pub trait Renderer: fmt::Debug + Send + Sync {
    /// Returns the names of the nodes that the plan must compute as inputs for `node`; `None` if the renderer does not
    /// compute `node`.
    fn inputs(&self, node: &str) -> Option<Vec<String>>;

    /// Computes the values of `nodes` at the pixel centers of a window, row by row. `inputs` has the values of their
    /// inputs in the same window.
    ///
    /// # Errors
    ///
    /// If the renderer fails. The plan returns the error as [`RecipeErrorKind::Renderer`].
    fn render(
        &self,
        nodes: &[&str],
        window: &Window,
        inputs: &BTreeMap<&str, &Values>,
    ) -> Result<Vec<Values>, RendererError>;
}

/// An error from a [`Renderer`].
#[derive(Clone, Debug)]
pub struct RendererError(Arc<dyn Error + Send + Sync>);

impl RendererError {
    /// Wraps the error of a renderer.
    pub fn new(error: impl Error + Send + Sync + 'static) -> Self {
        Self(Arc::new(error))
    }

    /// Returns the error of the renderer, to be downcast to its type.
    #[must_use]
    pub fn get_ref(&self) -> &(dyn Error + Send + Sync + 'static) {
        &*self.0
    }
}

impl PartialEq for RendererError {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Display for RendererError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Error for RendererError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(&*self.0)
    }
}

impl Plan {
    /// Sets the renderer that computes nodes for bakes and images of nodes.
    #[must_use]
    pub fn with_renderer(mut self, renderer: Arc<dyn Renderer>) -> Self {
        self.renderer = Some(renderer);
        self
    }

    /// Computes the values of steps. Nodes that the renderer supports are passed to it.
    pub(super) fn values_by(
        &self,
        renderer: &dyn Renderer,
        whole: &Whole,
        window: &Window,
        wanted: &[usize],
        known: &Known,
    ) -> Result<Vec<Values>, RecipeError> {
        // Divide the steps between the renderer and the plan, which also computes the inputs of the renderer.
        let (mut nodes, mut own) = (Vec::new(), Vec::new());
        for &step in wanted {
            let is_known = known.iter().any(|(known, _)| *known == step);
            match self.rendered(renderer, step).filter(|_| !is_known) {
                // A step may be wanted twice.
                Some((node, _)) if nodes.contains(&(step, node)) => {}
                Some((node, inputs)) => {
                    nodes.push((step, node));
                    own.extend(inputs);
                }
                None => own.push(step),
            }
        }
        own.sort_unstable();
        own.dedup();
        let mut values = self.own_values(whole, window, &own, known)?;
        if !nodes.is_empty() {
            whole.watch.check()?;
            let named = own.iter().zip(&values);
            let named = named.filter_map(|(&step, values)| Some((self.name_of(step)?, values)));
            let names: Vec<_> = nodes.iter().map(|(_, node)| *node).collect();
            let rendered = renderer.render(&names, window, &named.collect())?;
            own.extend(nodes.iter().map(|(step, _)| *step));
            values.extend(rendered);
        }
        let found = BTreeMap::from_iter(own.into_iter().zip(values));
        let all: Option<Vec<_>> = wanted.iter().map(|step| found.get(step).cloned()).collect();
        // Every step was computed above, unless the renderer returned too few values.
        all.ok_or_else(|| {
            let rule = "a renderer returns the values of all nodes";
            RecipeError::new(RecipeErrorKind::Conflict { rule })
        })
    }

    /// Returns the node name of a step and the steps of its inputs; `None` if the renderer does not compute this node.
    fn rendered(&self, renderer: &dyn Renderer, step: usize) -> Option<(&str, Vec<usize>)> {
        let node = self.name_of(step)?;
        let inputs = renderer.inputs(node)?;
        let steps = inputs.iter().map(|input| self.names.get(input).copied());
        Some((node, steps.collect::<Option<_>>()?))
    }

    fn name_of(&self, step: usize) -> Option<&str> {
        let named = self.names.iter().find(|&(_, &named)| named == step);
        named.map(|(name, _)| name.as_str())
    }

    /// Returns the steps that the plan computes itself to get `wanted`. A node that the renderer computes is replaced
    /// by its inputs.
    pub(super) fn own_steps(&self, wanted: &[usize]) -> Vec<usize> {
        let own = |&step: &usize| {
            let rendered = self.rendered(self.renderer.as_deref()?, step);
            rendered.map(|(_, inputs)| inputs)
        };
        let steps = wanted.iter();
        steps
            .flat_map(|step| own(step).unwrap_or_else(|| vec![*step]))
            .collect()
    }
}
