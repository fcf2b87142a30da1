//! A run over several recipes.

use crate::error::{Exit, report};
use crate::job::{Context, eprintln_if_possible};
use anyhow::{Context as _, Result};

/// A run over several recipes, some of which may fail.
pub(super) struct Batch<'a> {
    n_recipes: usize,
    n_failed: usize,
    keep_going: bool,
    context: &'a Context,
}

impl<'a> Batch<'a> {
    /// A run over this number of recipes, none of which has failed yet.
    pub(super) fn new(n_recipes: usize, keep_going: bool, context: &'a Context) -> Self {
        Self {
            n_recipes,
            n_failed: 0,
            keep_going,
            context,
        }
    }

    /// The result of a recipe, or `None` after an error that was printed and does not end the run.
    ///
    /// # Errors
    ///
    /// The error of the recipe, if it ends the run.
    pub(super) fn checked<T>(&mut self, name: &str, result: Result<T>) -> Result<Option<T>> {
        if self.n_recipes == 1 {
            return result.map(Some);
        }
        match result.with_context(|| format!("{name} was not baked")) {
            Ok(value) => Ok(Some(value)),
            Err(error) if self.keep_going => {
                report(&error, &self.context.options);
                self.n_failed += 1;
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Prints how many were baked, and returns the exit code.
    pub(super) fn exit(&self) -> Exit {
        if self.n_recipes > 1 && !self.context.quiet {
            let n_baked = self.n_recipes - self.n_failed;
            eprintln_if_possible(&format!("baked {n_baked} of {} recipes", self.n_recipes));
        }
        if self.n_failed > 0 {
            Exit::Failed
        } else {
            Exit::Done
        }
    }
}
