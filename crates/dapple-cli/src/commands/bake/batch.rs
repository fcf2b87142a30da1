//! Runs over several recipes, and prints a summary at the end.

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
    /// Begins a run over `n_recipes` recipes.
    pub(super) fn new(n_recipes: usize, keep_going: bool, context: &'a Context) -> Self {
        Self {
            n_recipes,
            n_failed: 0,
            keep_going,
            context,
        }
    }

    /// Returns the value if a recipe's `result` is a success. With `--keep-going`, an error is printed and counted, and
    /// `None` is returned.
    ///
    /// # Errors
    ///
    /// If the result is an error and `--keep-going` is not given.
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

    /// Prints the number of baked recipes, and returns the exit code.
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
