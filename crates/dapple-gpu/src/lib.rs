//! Computes the materials of dapple on a GPU, with the same bits as on the CPU.
//!
//! [`Gpu`] is a device of the program, or a new one without a window. [`GpuPlan`] computes nodes of a recipe: into
//! textures that stay on the GPU, into rasters, or for the maps of a bake. The shaders are those of
//! [`Recipe::to_wgsl`](dapple_recipe::Recipe::to_wgsl).
//!
//! ```
//! use dapple_gpu::{Gpu, GpuPlan};
//! use dapple_recipe::raster::{Field, Window};
//! use dapple_recipe::{Images, Plan, Recipe};
//!
//! // Without an adapter there is nothing to show.
//! let Ok(gpu) = Gpu::headless() else { return Ok(()) };
//! let recipe = Recipe::builtin("mountains")?;
//! let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
//! let on_gpu = GpuPlan::new(&gpu, &recipe, &plan)?;
//!
//! let window = Window::new([0.0, 0.0], [1.0, 1.0], [64, 64])?;
//! let heights = on_gpu.texture("height", &window)?;      // for a terrain; nothing is read back
//! let raster = on_gpu.raster("height", &window)?;        // the same numbers, read back
//! assert_eq!(raster, plan.field("height")?.to_raster(&window)?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What runs where
//!
//! The GPU computes every node that has a shader. The CPU computes the other nodes, which are uploaded, and normals,
//! occlusion and curvature. The bits are the same in either case.
//!
//! # Sliders
//!
//! A program that changes values of a recipe while it is shown calls [`Gpu::upload_values`]. The values are then no part of
//! the shaders, which a [`Gpu`] and its clones keep, and a changed value compiles none, except where it changes the
//! structure. [`Gpu::compile_in_background`] avoids waiting for the first shader.
//!
//! # Exactness
//!
//! WGSL does not require exact arithmetic. [`Gpu::new`] therefore compares the device with the CPU, and
//! [`Gpu::exactness`] returns the result. A device with other bits is an error, unless [`Gpu::allow_inexact`] is called.
//!
//! # Limits
//!
//! * The limits of the shaders: positions are within 2^31 cells of every node, and denormal numbers may be 0.
//! * A row of a window must fit into a buffer of the device. Larger windows are computed in bands of rows.
//! * Calls wait for the GPU, except for [`GpuPlan::texture`]. They do not work in a browser, which forbids to wait.
//! * The crate enables the Vulkan backend of `wgpu` alone. For others, add `wgpu` with the features `metal` or `dx12` to
//!   your program.
//!
//! # Features
//!
//! | feature | default | effect |
//! |---|---|---|
//! | `rayon` | on | nodes without a shader use all cores; the bits do not change |

#![forbid(unsafe_code)]

mod device;
mod error;
mod exactness;
mod gpu;
mod pipelines;
mod plan;
mod shader;

pub use dapple_recipe as recipe;
pub use error::{GpuError, GpuErrorKind};
pub use exactness::Exactness;
pub use gpu::Gpu;
pub use plan::GpuPlan;
pub use wgpu;
