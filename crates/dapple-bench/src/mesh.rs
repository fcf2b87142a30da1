//! The mesh group: which sites are connected.
//!
//! The sites are 65,536 even points on the procedural animal. Confirmed: both ways connect the same pairs.

#[cfg(feature = "peers")]
mod stars;

use crate::harness::Bench;
use anyhow::Result;

/// Measures the rows of the group.
#[cfg_attr(
    not(feature = "peers"),
    expect(
        unused_variables,
        clippy::unnecessary_wraps,
        reason = "all rows are beside peers"
    )
)]
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    #[cfg(feature = "peers")]
    stars::run(bench)?;
    Ok(())
}
