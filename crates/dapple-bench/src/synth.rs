//! The synth group: textures on surfaces and in the plane, their parts, and how they look.
//!
//! The model and the exemplars are files under `../shared/data` beside the workspace where that is, and procedural ones
//! elsewhere; notes say which. Beside `texture-synthesis`, whose image is flat, has 512×512 pixels and is made once per turn
//! for all rows, every site or pixel of ours must have a color, and of many pixels of the exemplar.

#[cfg(feature = "peers")]
mod alike;
#[cfg(feature = "peers")]
mod beside_flat;
mod drawings;
mod matching;
mod on_surface;
mod scene;
pub(crate) mod size;
mod steps;
mod table_1;
mod threads;
mod whole;

use crate::harness::Bench;
use anyhow::Result;

/// Measures the rows of the group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    #[cfg(feature = "peers")]
    beside_flat::run(bench)?;
    threads::run(bench)?;
    table_1::run(bench)?;
    steps::run(bench)?;
    size::run(bench)?;
    matching::run(bench)?;
    on_surface::run(bench)?;
    #[cfg(feature = "peers")]
    alike::run(bench)?;
    Ok(())
}
