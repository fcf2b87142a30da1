//! The mesh group: how even sites are, and which of them are connected.

mod evenness;
#[cfg(feature = "peers")]
mod stars;

use crate::harness::Bench;
use anyhow::Result;

/// Measures the rows of the group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    evenness::run(bench)?;
    #[cfg(feature = "peers")]
    stars::run(bench)?;
    Ok(())
}
