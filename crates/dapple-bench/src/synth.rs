//! The synth group: textures on surfaces and in the plane, their stages, and their quality.
//!
//! The model and the exemplars are files under `../shared/data` next to the workspace if these exist, and procedural
//! otherwise; notes say which. `texture-synthesis` generates a flat image of 512×512 pixels, once per turn for all
//! rows.
//! Confirmed: every site or pixel of ours has a color, and the colors come from many pixels of the exemplar.

#[cfg(feature = "peers")]
mod alike;
#[cfg(feature = "peers")]
mod beside_flat;
mod drawings;
#[cfg(feature = "peers")]
mod features;
mod layout;
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

/// Measures all benchmark rows of this group.
pub(crate) fn run(bench: &mut Bench) -> Result<()> {
    #[cfg(feature = "peers")]
    beside_flat::run(bench)?;
    #[cfg(feature = "peers")]
    features::run(bench)?;
    threads::run(bench)?;
    table_1::run(bench)?;
    steps::run(bench)?;
    size::run(bench)?;
    layout::run(bench)?;
    matching::run(bench)?;
    on_surface::run(bench)?;
    #[cfg(feature = "peers")]
    alike::run(bench)?;
    Ok(())
}
