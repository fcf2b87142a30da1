//! Textures on a real GPU, by `wgpu`: the data that the example `10_gpu_texture` prepares is uploaded intact and
//! sampled correctly.
//!
//! ```sh
//! cargo test -p dapple-tests --test gpu
//! ```
//!
//! Without an adapter the tests print a note and pass. On Linux without a GPU, the packages `libvulkan1` and
//! `mesa-vulkan-drivers` provide an adapter that runs on the processor.

#[path = "../../crates/dapple/examples/upload/mod.rs"]
mod upload;

use dapple::color::{LinearRgb, NormalOptions, Palette, normal_map};
use dapple::hash::Seed;
use dapple::pups::{NoiseOptions, noise};
use dapple::raster::{Field, Raster, Window};
use upload::{Format, Upload};

/// A shader that samples the top row of a repeating texture, shifted by two periods along x and one along y.
const SHADER: &str = "
@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var repeating: sampler;
@group(0) @binding(2) var<storage, read_write> seen: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = vec2<f32>(textureDimensions(picture));
    let uv = vec2<f32>((f32(id.x) + 0.5) / size.x + 2.0, 0.5 / size.y - 1.0);
    seen[id.x] = textureSampleLevel(picture, repeating, uv, 0.0);
}";

#[test]
fn bytes_of_every_level_come_back_as_they_were_sent() {
    let Some(gpu) = Gpu::new() else { return };
    // The small levels of the first size have padded rows; all levels of the second have, and its sides do not stay
    // even.
    for size in [[256, 128], [200, 75]] {
        let height = height(size);
        let normals = normal_map(&height, &NormalOptions::default()).expect("normals");
        let colors = Palette::Ember.ramp().apply(&height);
        let uploads = [Upload::color(&colors), Upload::normal(&normals)];
        for upload in uploads.map(|upload| upload.expect("mip levels")) {
            let texture = gpu.texture(&upload);
            for (level, sent) in (0..).zip(&upload.levels) {
                let bytes = gpu.read(&texture, level, sent.bytes_per_row);
                let row = sent.bytes_per_row;
                let used = 4 * sent.size[0] as usize;
                let back = bytes.chunks_exact(row).map(|row| &row[..used]);
                let format = upload.format;
                assert!(
                    sent.rows().eq(back),
                    "level {level} of {size:?}, {format:?}"
                );
            }
        }
    }
}

#[test]
fn a_repeating_sampler_sees_the_linear_colors_of_the_raster() {
    let Some(gpu) = Gpu::new() else { return };
    let colors = Palette::Ember.ramp().apply(&height([256, 64]));
    let texture = gpu.texture(&Upload::color(&colors).expect("mip levels"));
    let seen = gpu.sampled_row(&texture, 256);
    for (color, seen) in colors.row(0).iter().zip(seen) {
        // The color as the 8 bits of the file give it. GPUs also have 8 bits for positions between pixels.
        let coded = LinearRgb::from_srgb(color.to_srgb::<u8>());
        let pairs = coded.to_array().into_iter().zip(seen);
        let gap = pairs.fold(0.0_f32, |gap, (a, b)| gap.max((a - b).abs()));
        assert!(gap < 0.005, "{coded:?} is seen as {seen:?}");
    }
}

/// Returns a height map of noise from 0 to 1, over the unit square.
fn height(size: [u32; 2]) -> Raster<f32> {
    let window = Window::unit(size).expect("a window");
    let noise = noise(&NoiseOptions::default(), Seed(7)).expect("noise");
    noise.to_raster(&window).expect("a picture")
}

/// A GPU, or an adapter that emulates one.
struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
}

impl Gpu {
    #[expect(
        clippy::print_stdout,
        reason = "the output of a test names the adapter"
    )]
    fn new() -> Option<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let adapter = pollster::block_on(instance.request_adapter(&Default::default()));
        let Ok(adapter) = adapter else {
            println!("skipped: there is no graphics adapter");
            return None;
        };
        println!("on {}", adapter.get_info().name);
        let device = pollster::block_on(adapter.request_device(&Default::default()));
        let (device, queue) = device.expect("a device of the adapter");
        Some(Self { device, queue })
    }

    /// Creates the GPU texture with all of its mip levels.
    fn texture(&self, upload: &Upload) -> wgpu::Texture {
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: extent(upload.levels[0].size),
            mip_level_count: upload.levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: format(upload.format),
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_DST
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        for (mip_level, level) in (0..).zip(&upload.levels) {
            let destination = wgpu::TexelCopyTextureInfo {
                mip_level,
                ..texture.as_image_copy()
            };
            let layout = rows(level.bytes_per_row);
            self.queue
                .write_texture(destination, &level.bytes, layout, extent(level.size));
        }
        texture
    }

    /// Reads back the bytes of a mip level, with padded rows.
    fn read(&self, texture: &wgpu::Texture, mip_level: u32, bytes_per_row: usize) -> Vec<u8> {
        let [width, height] = [texture.width(), texture.height()].map(|side| side >> mip_level);
        let size = [width.max(1), height.max(1)];
        let buffer = self.buffer(
            bytes_per_row * size[1] as usize,
            wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        );
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let source = wgpu::TexelCopyTextureInfo {
            mip_level,
            ..texture.as_image_copy()
        };
        let destination = wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: rows(bytes_per_row),
        };
        encoder.copy_texture_to_buffer(source, destination, extent(size));
        self.queue.submit([encoder.finish()]);
        self.mapped(&buffer)
    }

    /// Returns the colors that a repeating sampler reads along the top row.
    fn sampled_row(&self, texture: &wgpu::Texture, width: u32) -> Vec<[f32; 3]> {
        let pipeline = self.pipeline();
        let sampler = self.device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: wgpu::AddressMode::Repeat,
            address_mode_v: wgpu::AddressMode::Repeat,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let bytes = 16 * width as usize;
        let seen = self.buffer(
            bytes,
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        );
        let read = self.buffer(
            bytes,
            wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        );
        let view = texture.create_view(&Default::default());
        let resources = [
            wgpu::BindingResource::TextureView(&view),
            wgpu::BindingResource::Sampler(&sampler),
            seen.as_entire_binding(),
        ];
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
            pass.dispatch_workgroups(width / 64, 1, 1);
        }
        encoder.copy_buffer_to_buffer(&seen, 0, &read, 0, None);
        self.queue.submit([encoder.finish()]);
        let bytes = self.mapped(&read);
        let number = |at: &[u8]| f32::from_le_bytes([at[0], at[1], at[2], at[3]]);
        let colors = bytes.chunks_exact(16);
        colors
            .map(|color| [0, 4, 8].map(|at| number(&color[at..])))
            .collect()
    }

    fn pipeline(&self) -> wgpu::ComputePipeline {
        let module = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(SHADER.into()),
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

    /// Returns the bytes of a buffer, after all submitted work is done.
    fn mapped(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        buffer.map_async(wgpu::MapMode::Read, .., |mapped| {
            mapped.expect("a mapped buffer");
        });
        let wait = wgpu::PollType::wait_indefinitely();
        self.device.poll(wait).expect("the work is done");
        buffer.get_mapped_range(..).expect("its bytes").to_vec()
    }
}

fn format(format: Format) -> wgpu::TextureFormat {
    match format {
        Format::Rgba8UnormSrgb => wgpu::TextureFormat::Rgba8UnormSrgb,
        Format::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
    }
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

fn rows(bytes_per_row: usize) -> wgpu::TexelCopyBufferLayout {
    wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(bytes_per_row as u32),
        rows_per_image: None,
    }
}
