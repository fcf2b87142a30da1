//! stub
use crate::harness::Bench;
pub(crate) fn run(_bench: &mut Bench) -> anyhow::Result<()> {
    Ok(())
}
