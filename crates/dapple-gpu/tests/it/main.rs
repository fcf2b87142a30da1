//! Materials on the GPU against the CPU.

mod bakes;
mod devices;
mod sliders;
mod windows;

use dapple_gpu::{Gpu, GpuPlan};
use dapple_recipe::raster::Window;
use dapple_recipe::{Images, Plan, Recipe};

/// Opens a GPU. Without an adapter the tests pass, unless `DAPPLE_NO_SKIP=1` is set.
#[expect(
    clippy::print_stdout,
    reason = "the output of a test says that it was skipped"
)]
fn gpu() -> Option<Gpu> {
    match Gpu::headless() {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            let may_skip = std::env::var_os("DAPPLE_NO_SKIP").is_none_or(|value| value != "1");
            assert!(
                may_skip,
                "{error}; DAPPLE_NO_SKIP=1 lets nothing be skipped"
            );
            println!("skipped: {error}");
            None
        }
    }
}

fn recipe(text: &str) -> (Recipe, Plan) {
    let recipe = Recipe::from_toml(text).expect("a recipe");
    let plan = Plan::new(&recipe, &Images::new(), 0.0).expect("a plan");
    (recipe, plan)
}

fn on_gpu(gpu: &Gpu, (recipe, plan): &(Recipe, Plan)) -> GpuPlan {
    GpuPlan::new(gpu, recipe, plan).expect("a plan on the GPU")
}

/// Returns a window whose pixel centers no `f32` can represent.
fn window(size: [u32; 2]) -> Window {
    Window::new([1e5 + 0.1, -3.7], [0.7, 1.3], size).expect("a window")
}

fn bits(numbers: &[f32]) -> Vec<u32> {
    numbers.iter().map(|number| number.to_bits()).collect()
}
