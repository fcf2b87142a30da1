//! A device whose arithmetic was compared with the CPU.

use crate::device::Device;
use crate::exactness::{self, Exactness};
use crate::{GpuError, GpuErrorKind};

/// A GPU, or an adapter that emulates one.
///
/// # Examples
///
/// ```
/// use dapple_gpu::{Exactness, Gpu};
///
/// // Without an adapter there is nothing to show.
/// let Ok(gpu) = Gpu::headless() else { return };
/// match gpu.exactness() {
///     Exactness::Differs { operation } => println!("{operation} differ from the CPU"),
///     _ => println!("values have the bits of the CPU"),
/// }
/// ```
#[derive(Clone, Debug)]
pub struct Gpu {
    pub(crate) device: Device,
    exactness: Exactness,
    allows_inexact: bool,
}

impl Gpu {
    /// Uses a device of the caller, such as Bevy's, and compares its arithmetic with the CPU. This compiles a small
    /// shader and runs 256 invocations.
    ///
    /// # Errors
    ///
    /// [`Lost`](GpuErrorKind::Lost) or [`Refused`](GpuErrorKind::Refused) if the device fails.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, GpuError> {
        Self::tested(Device::new(device.clone(), queue.clone()))
    }

    /// Opens the fastest adapter, without a window. On Linux without a GPU, Mesa's software implementation of Vulkan
    /// serves (Debian's package `mesa-vulkan-drivers`).
    ///
    /// # Errors
    ///
    /// [`NoAdapter`](GpuErrorKind::NoAdapter) without a graphics adapter, or the same errors as [`new`](Self::new).
    pub fn headless() -> Result<Self, GpuError> {
        Self::tested(Device::headless()?)
    }

    fn tested(device: Device) -> Result<Self, GpuError> {
        Ok(Self {
            exactness: exactness::test(&device, |text| text)?,
            device,
            allows_inexact: false,
        })
    }

    /// Returns how the arithmetic of the device compares with the CPU.
    #[must_use]
    pub fn exactness(&self) -> Exactness {
        self.exactness
    }

    /// Allows a device whose bits differ from the CPU, which is an error otherwise.
    #[must_use]
    pub fn allow_inexact(mut self) -> Self {
        self.allows_inexact = true;
        self
    }

    /// Uploads the values of nodes. Recipes that differ in values then share shaders, and a step of a slider compiles none. The
    /// first compilation takes longer, and the shaders are slower, because compilers do not know the values.
    #[must_use]
    pub fn upload_values(mut self) -> Self {
        self.device.uploads_values = true;
        self
    }

    /// Compiles shaders in the background. A bake that needs a shader which is not compiled yet fails with
    /// [`Compiling`](GpuErrorKind::Compiling), so that a program can use the CPU until it is.
    #[must_use]
    pub fn compile_in_background(mut self) -> Self {
        self.device.is_background = true;
        self
    }

    /// Returns the number of shaders that were compiled for the device. Clones share shaders. The 64 that were used last are
    /// kept.
    #[must_use]
    pub fn compiled_shaders(&self) -> u64 {
        self.device.pipelines.n_compiled()
    }

    /// Returns the device.
    #[must_use]
    pub fn device(&self) -> &wgpu::Device {
        &self.device.device
    }

    /// Returns the queue of the device.
    #[must_use]
    pub fn queue(&self) -> &wgpu::Queue {
        &self.device.queue
    }

    /// Returns an error if the bits of the device differ, unless this is allowed.
    pub(crate) fn check_exact(&self) -> Result<(), GpuError> {
        match self.exactness {
            Exactness::Differs { operation } if !self.allows_inexact => {
                Err(GpuError::new(GpuErrorKind::NotExact { operation }))
            }
            _ => Ok(()),
        }
    }
}
