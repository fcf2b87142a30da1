//! A GPU device that runs one compute shader at a time.

/// Number of invocations in a workgroup of the shaders.
const WORKGROUP: usize = 64;

/// Number of texels in a row of the texture `data`.
const DATA_WIDTH: u32 = 1024;

/// A GPU, or an adapter that emulates one.
#[derive(Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    name: String,
}

impl Gpu {
    /// Opens the default adapter; `None` if there is none.
    ///
    /// # Panics
    ///
    /// If there is no adapter and `DAPPLE_NO_SKIP=1` is set, or if the adapter gives no device.
    #[must_use]
    #[expect(
        clippy::print_stdout,
        reason = "the output of a test names the adapter"
    )]
    pub fn new() -> Option<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()));
        let Ok(adapter) = adapter else {
            let may_skip = std::env::var_os("DAPPLE_NO_SKIP").is_none_or(|value| value != "1");
            assert!(
                may_skip,
                "there is no graphics adapter; DAPPLE_NO_SKIP=1 lets nothing be skipped"
            );
            println!("skipped: there is no graphics adapter");
            return None;
        };
        let name = adapter.get_info().name;
        println!("on {name}");
        let device = pollster::block_on(adapter.request_device(&Default::default()));
        let (device, queue) = device.expect("a device of the adapter");
        Some(Self {
            device,
            queue,
            name,
        })
    }

    /// Returns whether this is Mesa's software implementation of Vulkan.
    #[must_use]
    pub fn is_lavapipe(&self) -> bool {
        self.name.starts_with("llvmpipe")
    }

    /// Runs the entry point of `shader` for at least `n` invocations, in workgroups of 64. Each invocation writes
    /// `words` words. The inputs are storage buffers with bindings from 0; the buffer of results has the next binding.
    /// Returns the results.
    ///
    /// # Panics
    ///
    /// If the shader is invalid or the device is lost.
    #[must_use]
    pub fn compute(&self, shader: &str, inputs: &[&[u32]], n: usize, words: usize) -> Vec<u32> {
        self.compute_with_data(shader, inputs, &[], n, words)
    }

    /// Runs a shader like [`compute`](Self::compute), with a texture `data` that has the binding after the results:
    /// texels of four words, 1024 in a row. If `data` is empty, no texture is bound.
    ///
    /// # Panics
    ///
    /// If the shader is invalid or the device is lost.
    #[must_use]
    pub fn compute_with_data(
        &self,
        shader: &str,
        inputs: &[&[u32]],
        data: &[u32],
        n: usize,
        words: usize,
    ) -> Vec<u32> {
        let storage = wgpu::BufferUsages::STORAGE;
        let mut buffers = Vec::new();
        for input in inputs {
            let bytes: Vec<u8> = input.iter().flat_map(|word| word.to_le_bytes()).collect();
            let buffer = self.buffer(bytes.len(), storage | wgpu::BufferUsages::COPY_DST);
            self.queue.write_buffer(&buffer, 0, &bytes);
            buffers.push(buffer);
        }
        let bytes = 4 * n * words;
        buffers.push(self.buffer(bytes, storage | wgpu::BufferUsages::COPY_SRC));
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let read = self.buffer(bytes, usage);
        let pipeline = self.pipeline(shader);
        let texture = (!data.is_empty()).then(|| self.texture(data));
        let resources = buffers.iter().map(wgpu::Buffer::as_entire_binding);
        let resources = resources.chain(texture.iter().map(wgpu::BindingResource::TextureView));
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(n.div_ceil(WORKGROUP) as u32, 1, 1);
        }
        encoder.copy_buffer_to_buffer(&buffers[inputs.len()], 0, &read, 0, None);
        self.queue.submit([encoder.finish()]);
        read.map_async(wgpu::MapMode::Read, .., |mapped| {
            mapped.expect("a mapped buffer");
        });
        let wait = wgpu::PollType::wait_indefinitely();
        self.device.poll(wait).expect("the work is done");
        let bytes = read.get_mapped_range(..).expect("its bytes");
        let words = bytes.chunks_exact(4);
        words
            .map(|at| u32::from_le_bytes([at[0], at[1], at[2], at[3]]))
            .collect()
    }

    fn pipeline(&self, shader: &str) -> wgpu::ComputePipeline {
        let module = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(shader.into()),
            });
        self.device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: None,
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                cache: None,
            })
    }

    /// Creates a texture of the format rgba32uint from words.
    fn texture(&self, data: &[u32]) -> wgpu::TextureView {
        let mut bytes: Vec<u8> = data.iter().flat_map(|word| word.to_le_bytes()).collect();
        let row = 16 * DATA_WIDTH as usize;
        bytes.resize(bytes.len().next_multiple_of(row), 0);
        let size = wgpu::Extent3d {
            width: DATA_WIDTH,
            height: (bytes.len() / row) as u32,
            depth_or_array_layers: 1,
        };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba32Uint,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row as u32),
            rows_per_image: None,
        };
        self.queue
            .write_texture(texture.as_image_copy(), &bytes, layout, size);
        texture.create_view(&Default::default())
    }

    fn buffer(&self, bytes: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes as u64,
            usage,
            mapped_at_creation: false,
        })
    }
}
