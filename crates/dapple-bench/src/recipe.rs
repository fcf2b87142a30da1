//! The recipe group: baking some maps compared with baking all of them, and nodes compared with the functions they
//! use.

mod maps;
mod nodes;

use crate::harness::Bench;
use anyhow::Result;

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    maps::run(bench)?;
    nodes::run(bench)
}
