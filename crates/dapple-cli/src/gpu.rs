//! Bakes on a GPU, and the maps of the studio.

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

/// The GPU that renders the maps of pages.
#[cfg(all(feature = "gpu", feature = "studio"))]
pub(crate) mod pages {
    use crate::job::eprintln_if_possible;
    use dapple::recipe::{Plan, Recipe, RendererError, ShaderOptions};
    use dapple_gpu::wgpu::DeviceType;
    use dapple_gpu::{Exactness, Gpu, GpuError, GpuErrorKind, GpuPlan};
    use std::fmt::Display;
    use std::sync::{Mutex, MutexGuard, PoisonError};
    use std::thread;

    /// The GPU, once it is open and until it fails.
    static GPU: Mutex<Option<Gpu>> = Mutex::new(None);

    fn gpu() -> MutexGuard<'static, Option<Gpu>> {
        GPU.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Opens the GPU in the background. Without one, the CPU renders the maps.
    pub(crate) fn open() {
        let thread = thread::Builder::new().name("gpu".to_owned());
        // Without a thread there is no GPU either.
        let _ = thread.spawn(|| match Gpu::headless() {
            Err(error) => say(error),
            Ok(opened) => match (opened.exactness(), opened.device().adapter_info()) {
                (Exactness::Differs { operation }, _) => {
                    say(format!("the GPU computes {operation} with other bits"));
                }
                (_, info) if info.device_type == DeviceType::Cpu => {
                    say(format!("{} emulates one on the CPU", info.name));
                }
                _ => *gpu() = Some(opened.upload_values().compile_in_background()),
            },
        });
    }

    fn say(reason: impl Display) {
        eprintln_if_possible(&format!(
            "note: the maps are rendered without a GPU: {reason}"
        ));
    }

    /// Returns the plan with all nodes on the GPU; `None` without a GPU, or if a node has no shader.
    pub(crate) fn on_gpu(recipe: &Recipe, plan: &Plan) -> Option<Plan> {
        let gpu = gpu().clone()?;
        recipe.to_wgsl_with(plan, &ShaderOptions::default()).ok()?;
        let on_gpu = GpuPlan::new(&gpu, recipe, plan).ok()?;
        Some(on_gpu.plan().clone())
    }

    /// Gives up the GPU, unless it only compiles a shader.
    pub(crate) fn failed(error: &RendererError) {
        let error = error.get_ref();
        let kind = error.downcast_ref().map(GpuError::kind);
        if kind != Some(&GpuErrorKind::Compiling) && gpu().take().is_some() {
            say(error);
        }
    }
}
