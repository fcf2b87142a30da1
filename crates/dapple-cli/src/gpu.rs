//! Bakes on a GPU.

use crate::error::{Hint, usage};
use anyhow::Result;
use dapple::recipe::{Plan, Recipe};
#[cfg(feature = "gpu")]
use dapple_gpu::{Gpu, GpuError, GpuPlan};
#[cfg(feature = "gpu")]
use std::sync::OnceLock;

/// Checks that this program can use a GPU.
///
/// # Errors
///
/// If it was built without the feature `gpu`.
pub(crate) fn check() -> Result<()> {
    match cfg!(feature = "gpu") {
        true => Ok(()),
        false => Err(usage("this program was built without --gpu")
            .hint("install it with `cargo install --path crates/dapple-cli --features gpu`")),
    }
}

/// Returns a plan that computes its nodes on the GPU, with the same bits.
///
/// # Errors
///
/// If there is no GPU, or its bits differ from the CPU.
#[cfg(feature = "gpu")]
pub(crate) fn on_gpu(recipe: &Recipe, plan: &Plan) -> Result<Plan> {
    // Frames, recipes and variants share one device.
    static GPU: OnceLock<Result<Gpu, GpuError>> = OnceLock::new();
    let gpu = GPU.get_or_init(Gpu::headless).clone();
    let on_gpu = gpu
        .and_then(|gpu| GpuPlan::new(&gpu, recipe, plan))
        .map_err(|error| anyhow::Error::new(error).hint("bake it without --gpu"))?;
    Ok(on_gpu.plan().clone())
}

/// Returns the plan unchanged. It is never called, because [`check`] has refused the option.
#[cfg(not(feature = "gpu"))]
pub(crate) fn on_gpu(_: &Recipe, plan: &Plan) -> Result<Plan> {
    check().map(|()| plan.clone())
}
