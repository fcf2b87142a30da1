//! Runs shaders on a device, and turns its failures into errors.

use crate::pipelines::Pipelines;
use crate::{GpuError, GpuErrorKind};
use dapple_recipe::MaterialShader;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, mpsc};

/// Columns of a workgroup.
pub(crate) const WORKGROUP: u32 = 64;

/// A device and its queue, and the shaders that are compiled for it.
#[derive(Clone, Debug)]
pub(crate) struct Device {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) pipelines: Arc<Pipelines>,
    /// Whether shaders are compiled in the background, and needed ones that are not ready are an error.
    pub(crate) is_background: bool,
    /// Whether the values of nodes are uploaded and no part of the shaders.
    pub(crate) uploads_values: bool,
}

/// A compiled compute shader with the entry point `main`. It has four storage buffers: words that describe the job,
/// positions, inputs, and the results. A fifth binding is the texture of the words that nodes look up, and a sixth one is
/// the uniform buffer of the numbers of nodes.
#[derive(Clone, Debug)]
pub(crate) struct Pipeline {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

/// A compiled shader with the words of a recipe.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    pipeline: Pipeline,
    data: wgpu::TextureView,
    numbers: wgpu::Buffer,
}

impl Device {
    pub(crate) fn new(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        Self {
            device,
            queue,
            pipelines: Arc::default(),
            is_background: false,
            uploads_values: false,
        }
    }

    /// Opens the default adapter.
    pub(crate) fn headless() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let none = |reason: String| GpuError::new(GpuErrorKind::NoAdapter { reason });
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options));
        let adapter = adapter.map_err(|error| none(error.to_string()))?;
        // Larger buffers and textures than the default, where the adapter has them
        let limits = adapter.limits();
        let device = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_limits: wgpu::Limits {
                max_buffer_size: limits.max_buffer_size,
                max_storage_buffer_binding_size: limits.max_storage_buffer_binding_size,
                max_texture_dimension_2d: limits.max_texture_dimension_2d,
                ..Default::default()
            },
            ..Default::default()
        }));
        let (device, queue) = device.map_err(|error| none(error.to_string()))?;
        Ok(Self::new(device, queue))
    }

    /// Runs commands, and returns the first error of the device. Without scopes, errors go to the handler of the caller,
    /// which may panic.
    fn scoped<T>(&self, commands: impl FnOnce() -> T) -> (T, Option<wgpu::Error>) {
        let filters = [
            wgpu::ErrorFilter::OutOfMemory,
            wgpu::ErrorFilter::Internal,
            wgpu::ErrorFilter::Validation,
        ];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let made = commands();
        let mut first = None;
        for scope in scopes.into_iter().rev() {
            let error = pollster::block_on(scope.pop());
            first = first.or(error);
        }
        (made, first)
    }

    /// Runs commands, and turns errors of the device into those of this crate.
    pub(crate) fn checked<T>(
        &self,
        during: &'static str,
        commands: impl FnOnce() -> T,
    ) -> Result<T, GpuError> {
        let (made, error) = self.scoped(commands);
        let Some(error) = error else { return Ok(made) };
        // Commands of a lost device are invalid.
        if self.is_lost() {
            return Err(GpuError::lost(during));
        }
        Err(GpuError::new(match error {
            wgpu::Error::OutOfMemory { .. } => GpuErrorKind::OutOfMemory,
            error => {
                let reason = error.to_string();
                GpuErrorKind::Refused { reason }
            }
        }))
    }

    /// Creates a buffer of `bytes`.
    pub(crate) fn buffer(&self, bytes: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes,
            usage,
            mapped_at_creation: false,
        })
    }

    /// Creates a storage or uniform buffer with these words; a single 0 in the place of none.
    pub(crate) fn filled(&self, words: &[u32]) -> wgpu::Buffer {
        let words = if words.is_empty() { &[0] } else { words };
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::UNIFORM;
        let usage = usage | wgpu::BufferUsages::COPY_DST;
        let buffer = self.buffer(4 * words.len() as u64, usage);
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.queue.write_buffer(&buffer, 0, &bytes);
        buffer
    }

    /// Creates a texture of these words, as [`MaterialShader::data`] has them; one texel of 0 in the place of none.
    fn data(&self, words: &[u32]) -> wgpu::TextureView {
        let words = if words.is_empty() { &[0; 4] } else { words };
        let width = words.len().min(MaterialShader::DATA_ROW) / 4;
        let rows = words.len().div_ceil(MaterialShader::DATA_ROW);
        let size = |width: usize, height: usize| wgpu::Extent3d {
            width: width as u32,
            height: height as u32,
            depth_or_array_layers: 1,
        };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: size(width, rows),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(16 * width as u32),
            rows_per_image: None,
        };
        let to = texture.as_image_copy();
        self.queue
            .write_texture(to, &bytes, layout, size(width, rows));
        texture.create_view(&Default::default())
    }

    /// Waits for a buffer, and reads all its words.
    pub(crate) fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u32>, GpuError> {
        let lost = || GpuError::lost("a read-back");
        let (sender, receiver) = mpsc::channel();
        self.checked("a read-back", || {
            buffer.map_async(wgpu::MapMode::Read, .., move |mapped| {
                // Without a receiver, this function has failed already.
                let _ = sender.send(mapped.is_ok());
            });
        })?;
        self.wait()?;
        if !receiver.try_recv().unwrap_or(false) {
            return Err(lost());
        }
        let bytes = buffer.get_mapped_range(..).map_err(|_| lost())?;
        let (words, _) = bytes.as_chunks::<4>();
        Ok(words.iter().map(|word| u32::from_le_bytes(*word)).collect())
    }

    /// Waits for all commands.
    fn wait(&self) -> Result<(), GpuError> {
        // `poll` of wgpu 30 panics if the device is lost while it waits.
        let poll = || self.device.poll(wgpu::PollType::wait_indefinitely());
        let polled = catch_unwind(AssertUnwindSafe(poll));
        match polled {
            Ok(Ok(_)) => Ok(()),
            _ => Err(GpuError::lost("a wait for results")),
        }
    }

    /// Returns whether the device cannot read a new buffer.
    fn is_lost(&self) -> bool {
        let (sender, receiver) = mpsc::channel();
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        // Without the buffer, its callback would report a failure.
        let (_buffer, error) = self.scoped(|| {
            let buffer = self.buffer(4, usage);
            buffer.map_async(wgpu::MapMode::Read, .., move |mapped| {
                // Without a receiver, this function has returned already.
                let _ = sender.send(mapped.is_ok());
            });
            buffer
        });
        error.is_some() || self.wait().is_err() || !receiver.try_recv().unwrap_or(false)
    }
}

impl Pipeline {
    /// Compiles a shader.
    pub(crate) fn new(device: &Device, wgsl: &str) -> Result<Self, GpuError> {
        let buffer = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: match binding {
                    5 => wgpu::BufferBindingType::Uniform,
                    _ => wgpu::BufferBindingType::Storage {
                        read_only: binding < 3,
                    },
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let texture = wgpu::BindGroupLayoutEntry {
            binding: 4,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Uint,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        device.checked("the compilation of a shader", || {
            let on = &device.device;
            let module = on.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(wgsl.into()),
            });
            let [job, positions, inputs, out] = [0, 1, 2, 3].map(buffer);
            let layout = on.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: None,
                entries: &[job, positions, inputs, out, texture, buffer(5)],
            });
            let of_pipeline = on.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
            let pipeline = on.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: Some(&of_pipeline),
                module: &module,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                cache: None,
            });
            Self { pipeline, layout }
        })
    }
}

impl Program {
    /// Compiles a shader unless it is compiled already, and uploads the words that it looks up, and the numbers of nodes.
    pub(crate) fn new(
        device: &Device,
        wgsl: &str,
        [data, numbers]: [&[u32]; 2],
    ) -> Result<Self, GpuError> {
        let pipeline = Pipelines::get(device, wgsl)?;
        device.checked("an upload", || Self {
            pipeline,
            data: device.data(data),
            numbers: match numbers.is_empty() {
                true => device.filled(&[0; 4]),
                false => device.filled(numbers),
            },
        })
    }

    /// Records the program for `size` invocations. The four buffers are those of [`Program`].
    pub(crate) fn record(
        &self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        buffers: [&wgpu::Buffer; 4],
        size: [u32; 2],
    ) {
        let buffers = buffers.map(wgpu::Buffer::as_entire_binding);
        let data = wgpu::BindingResource::TextureView(&self.data);
        let numbers = self.numbers.as_entire_binding();
        let resources = buffers.into_iter().chain([data, numbers]);
        let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
        let entries: Vec<_> = (0..).zip(resources).map(entry).collect();
        let group = device.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.pipeline.layout,
            entries: &entries,
        });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(size[0].div_ceil(WORKGROUP), size[1], 1);
    }

    /// Runs the program for `size` invocations, and reads `n` words of results. `words` describe the job, the positions and
    /// the inputs.
    pub(crate) fn run(
        &self,
        device: &Device,
        words: [&[u32]; 3],
        size: [u32; 2],
        n: usize,
    ) -> Result<Vec<u32>, GpuError> {
        let bytes = 4 * n as u64;
        let read = device.checked("a computation", || {
            let [job, positions, inputs] = words.map(|words| device.filled(words));
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
            let out = device.buffer(bytes, usage);
            let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            let read = device.buffer(bytes, usage);
            let mut encoder = device.device.create_command_encoder(&Default::default());
            self.record(
                device,
                &mut encoder,
                [&job, &positions, &inputs, &out],
                size,
            );
            encoder.copy_buffer_to_buffer(&out, 0, &read, 0, None);
            device.queue.submit([encoder.finish()]);
            read
        })?;
        device.read(&read)
    }
}
