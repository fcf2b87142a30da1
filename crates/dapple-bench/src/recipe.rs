//! The recipe group: baking a part compared with baking the whole, and nodes compared with the functions they use.

mod maps;
mod nodes;

use crate::harness::Bench;
use anyhow::Result;

/// Measures the rows of the group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    maps::run(bench)?;
    nodes::run(bench)
}
