//! A device that runs one compute shader at a time.

/// Number of invocations in a workgroup of the shaders.
const WORKGROUP: usize = 64;

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

    /// Runs the entry point of `shader`, with workgroups of 64, at least `n` times. It writes `words` words each time. The
    /// inputs are storage buffers, bound from binding 0 on; the results are bound after them.
    ///
    /// # Panics
    ///
    /// If the shader is invalid or the device is lost.
    #[must_use]
    pub fn compute(&self, shader: &str, inputs: &[&[u32]], n: usize, words: usize) -> Vec<u32> {
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
        let entries = (0..).zip(&buffers);
        let entries: Vec<_> = entries
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
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

    fn buffer(&self, bytes: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes as u64,
            usage,
            mapped_at_creation: false,
        })
    }
}
