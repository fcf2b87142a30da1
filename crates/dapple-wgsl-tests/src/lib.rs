//! Runs shaders on a GPU, for the tests that compare `dapple-wgsl` with the CPU.
//!
//! ```sh
//! cargo xtask ci shaders
//! ```
//!
//! Without an adapter the tests print a note and pass, unless `DAPPLE_NO_SKIP=1` is set. On Linux without a GPU, the
//! packages `libvulkan1` and `mesa-vulkan-drivers` provide an adapter that runs on the processor.

#![forbid(unsafe_code)]

mod gpu;

pub use gpu::Gpu;
