//! The mesh group: the evenness of sites, and the graphs that connect them.

mod evenness;
#[cfg(feature = "peers")]
mod stars;

use crate::harness::Bench;
use anyhow::Result;

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    evenness::run(bench)?;
    #[cfg(feature = "peers")]
    stars::run(bench)?;
    Ok(())
}
