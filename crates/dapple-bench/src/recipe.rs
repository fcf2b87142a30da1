//! The recipe group: baking a part beside baking the whole, and nodes beside what they are made of.

mod maps;
mod nodes;

use crate::harness::Bench;
use anyhow::Result;

/// Measures the rows of the group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    maps::run(bench)?;
    nodes::run(bench)
}
