//! Checks a GPU and times its kernels, in less than 3 minutes.
//!
//! The program prints the adapter, the self-test, the number of values that differ from the CPU among ten million, and the
//! throughput of kernels by timestamp queries. It needs no files, so that it can be copied to a machine with a GPU:
//!
//! ```sh
//! cargo build --release -p dapple-gpu --example timings
//! target/release/examples/timings
//! ```
//!
//! Shaders of other libraries are timed in the same run. The expression is a number at the position `at: vec2<f32>`, in
//! units of 64 pixels:
//!
//! ```sh
//! timings --peer noisy_bevy.wgsl 'simplex_noise_2d(at)' --peer cnoise.wgsl 'cnoise(at)'
//! ```
#![expect(clippy::print_stdout, reason = "the program prints its results")]
#![expect(clippy::disallowed_methods, reason = "files of peers are read")]

use dapple_gpu::recipe::hash::Seed;
use dapple_gpu::recipe::raster::{Field as _, Window};
use dapple_gpu::recipe::{Images, MaterialShader, Plan, Recipe, ShaderOptions};
use dapple_gpu::{Gpu, GpuPlan, wgpu};
use dapple_wgsl::{Module, worley_value};
use dapple_worley::Worley3;
use std::error::Error;
use std::sync::mpsc;

/// Recipes with one node, `value`: a name, the size and repetition of the tile, and the node.
const FIELDS: [[&str; 3]; 4] = [
    [
        "Worley 2-D F2 - F1",
        "wrap = [false, false]",
        r#"worley = { frequency = 1.0, value = "f2_minus_f1", range = [0.0, 1.0] }"#,
    ],
    [
        "gradient 2-D fBm 6",
        "wrap = [false, false]",
        r#"noise = { basis = "gradient", frequency = 1.0, octaves = 6 }"#,
    ],
    [
        "PUPs, 700 points",
        "",
        r#"noise = { basis = "pups", frequency = 26.5, octaves = 1 }"#,
    ],
    [
        "wavelet noise, 4 bands",
        "",
        r#"noise = { basis = "wavelet", frequency = 32.0, octaves = 4 }"#,
    ],
];

/// Pixels along a side of the timed windows.
const SIDE: u32 = 4096;

/// A compute shader with a value per pixel.
struct Kernel {
    name: String,
    /// Functions without bindings.
    wgsl: String,
    /// The value at the pixel `id`, as an expression.
    value: String,
    /// Words of the texture `data`.
    data: Vec<u32>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Some((device, queue)) = device()? else {
        return Ok(());
    };
    let gpu = Gpu::new(&device, &queue)?;
    println!("self-test: {:?}", gpu.exactness());
    let gpu = gpu.allow_inexact();
    let differ = compare(&gpu)?;
    if !device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
        println!("the device has no timestamp queries, so nothing is timed");
    } else {
        time_all(&gpu)?;
    }
    match differ {
        0 => Ok(()),
        _ => Err(format!("{differ} values differ from the CPU").into()),
    }
}

/// Opens the fastest adapter with timestamp queries, if it has them; `None` without an adapter.
fn device() -> Result<Option<(wgpu::Device, wgpu::Queue)>, Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    };
    let adapter = match pollster::block_on(instance.request_adapter(&options)) {
        Ok(adapter) => adapter,
        Err(error) => {
            println!("{error}");
            return Ok(None);
        }
    };
    let info = adapter.get_info();
    println!("{}, {} {}", info.name, info.driver, info.driver_info);
    let descriptor = wgpu::DeviceDescriptor {
        required_features: adapter.features() & wgpu::Features::TIMESTAMP_QUERY,
        required_limits: adapter.limits(),
        ..Default::default()
    };
    Ok(Some(pollster::block_on(
        adapter.request_device(&descriptor),
    )?))
}

fn recipe(tile: &str, node: &str) -> Result<(Recipe, Plan), Box<dyn Error>> {
    let recipe = Recipe::from_toml(&format!(
        "dapple = 1\n{tile}\n[nodes]\nvalue.{node}\n[material]\nheight = \"value\"\n"
    ))?;
    let plan = Plan::new(&recipe, &Images::new(), 0.0)?;
    Ok((recipe, plan))
}

/// Compares ten million values with the CPU: from 10^-5 to 5 units a pixel, near the origin and far from it. Returns the
/// number of different values.
fn compare(gpu: &Gpu) -> Result<usize, Box<dyn Error>> {
    let size = [640, 512];
    let mut all = [0; 2];
    for [name, tile, node] in FIELDS {
        let (recipe, plan) = recipe(tile, node)?;
        let on_gpu = GpuPlan::new(gpu, &recipe, &plan)?;
        let field = plan.field("value")?;
        let mut counts = [0; 2];
        for pixel in [1e-5, 1.0 / 64.0, 0.3, 5.0] {
            for origin in [[0.0, 0.0], [-1e5 + 0.1, 3e6 + 0.7]] {
                let extent = size.map(|side| pixel * f64::from(side));
                let window = Window::new(origin, extent, size)?;
                let made = on_gpu.raster("value", &window)?;
                let expected = field.to_raster(&window)?;
                let pairs = made.pixels().iter().zip(expected.pixels());
                let differ = pairs.filter(|(gpu, cpu)| gpu.to_bits() != cpu.to_bits());
                counts[0] += differ.count();
                counts[1] += made.pixels().len();
            }
        }
        println!("{name}: {} of {} values differ", counts[0], counts[1]);
        all = [0, 1].map(|at| all[at] + counts[at]);
    }
    println!("all: {} of {} values differ", all[0], all[1]);
    Ok(all[0])
}

/// Times the fields, a slice of 3-D cells, and the peers on the command line.
fn time_all(gpu: &Gpu) -> Result<(), Box<dyn Error>> {
    for [name, tile, node] in FIELDS {
        let (recipe, plan) = recipe(tile, node)?;
        let shader = recipe.to_wgsl_with(&plan, &ShaderOptions::default())?;
        let data = if shader.data.is_empty() { "" } else { "data, " };
        // Tiles repeat after 4096 pixels, and cells are 64 pixels wide.
        let shift = if tile.is_empty() { 12 } else { 6 };
        time(
            gpu,
            &Kernel {
                name: name.to_owned(),
                wgsl: shader.wgsl,
                value: format!("material({}, {data}zero).height", place(shift)),
                data: shader.data,
            },
        )?;
    }
    let words = Worley3::new(Seed(7)).shader_words()?;
    time(
        gpu,
        &Kernel {
            name: "Worley 3-D F1, a slice".to_owned(),
            wgsl: Module::Worley3d.source()
                + &format!("\nconst CELLS = {};\n", worley_value(&words)),
            value: "worley_3d(CELLS, place_3d(vec3(at, 0.4)), zero)[0].distance".to_owned(),
            data: Vec::new(),
        },
    )?;
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    for peer in arguments.chunks(3) {
        let [option, file, value] = peer else {
            return Err("a peer is --peer FILE EXPRESSION".into());
        };
        if option != "--peer" {
            return Err(format!("unknown option {option}").into());
        }
        time(
            gpu,
            &Kernel {
                name: format!("{file}: {value}"),
                wgsl: std::fs::read_to_string(file)?,
                value: value.clone(),
                data: Vec::new(),
            },
        )?;
    }
    Ok(())
}

/// Returns the position of the pixel `id` as a cell and a fraction, for cells of 2^`shift` pixels.
fn place(shift: u32) -> String {
    let mask = (1_u32 << shift) - 1;
    let scale = 1.0 / f64::from(1_u32 << shift);
    format!(
        "Place2d(vec2<i32>(id.xy >> vec2({shift}u)), vec2<f32>(id.xy & vec2({mask}u)) * {scale:?})"
    )
}

/// Prints the throughput of a kernel: of the fastest of five passes of about 50 ms, or of one dispatch.
fn time(gpu: &Gpu, kernel: &Kernel) -> Result<(), Box<dyn Error>> {
    let (device, queue) = (gpu.device(), gpu.queue());
    let (pipeline, group) = pipeline(gpu, kernel);
    let queries = device.create_query_set(&wgpu::QuerySetDescriptor {
        label: None,
        ty: wgpu::QueryType::Timestamp,
        count: 2,
    });
    let buffer = |usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 16,
            usage,
            mapped_at_creation: false,
        })
    };
    let resolved = buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC);
    let seconds = |dispatches: u32| -> Result<f64, Box<dyn Error>> {
        let read = buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: None,
                timestamp_writes: Some(wgpu::ComputePassTimestampWrites {
                    query_set: &queries,
                    beginning_of_pass_write_index: Some(0),
                    end_of_pass_write_index: Some(1),
                }),
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            for _ in 0..dispatches {
                pass.dispatch_workgroups(SIDE / 8, SIDE / 8, 1);
            }
        }
        encoder.resolve_query_set(&queries, 0..2, &resolved, 0);
        encoder.copy_buffer_to_buffer(&resolved, 0, &read, 0, None);
        queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        read.map_async(wgpu::MapMode::Read, .., move |mapped| {
            // The receiver lives as long as the wait below.
            let _ = sender.send(mapped);
        });
        device.poll(wgpu::PollType::wait_indefinitely())?;
        receiver.recv()??;
        let bytes = read.get_mapped_range(..)?;
        let ticks: Vec<_> = bytes
            .as_chunks::<8>()
            .0
            .iter()
            .map(|ticks| u64::from_le_bytes(*ticks))
            .collect();
        let period = f64::from(queue.get_timestamp_period());
        Ok((ticks[1] - ticks[0]) as f64 * period / 1e9)
    };
    // A slow adapter runs each kernel once. The first dispatch of a pipeline also loads it.
    let first = seconds(1)?;
    let (single, passes) = match first < 0.5 {
        true => (seconds(1)?, 5),
        false => (first, 0),
    };
    let dispatches = (0.05 / single).clamp(1.0, 64.0) as u32;
    let mut fastest = single;
    for _ in 0..passes {
        fastest = fastest.min(seconds(dispatches)? / f64::from(dispatches));
    }
    let pixels = f64::from(SIDE) * f64::from(SIDE);
    let speed = pixels / fastest / 1e9;
    println!("{}: {speed:.3} Gpx/s, {:.3} ms", kernel.name, fastest * 1e3);
    Ok(())
}

/// Compiles a kernel, and binds its buffers.
fn pipeline(gpu: &Gpu, kernel: &Kernel) -> (wgpu::ComputePipeline, wgpu::BindGroup) {
    let (device, queue) = (gpu.device(), gpu.queue());
    let data = match kernel.data.is_empty() {
        true => "",
        false => "@group(0) @binding(2) var data: texture_2d<u32>;",
    };
    let text = format!(
        "{}
@group(0) @binding(0) var<storage> job_zero: u32;
@group(0) @binding(1) var<storage, read_write> out: array<f32>;
{data}
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let zero = job_zero;
    let at = vec2<f32>(id.xy) / 64.0;
    out[id.y * {SIDE}u + id.x + zero] = {};
}}",
        kernel.wgsl, kernel.value
    );
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(&kernel.name),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let buffer = |size| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        })
    };
    // New buffers hold zeros.
    let [zero, out] = [4, 4 * u64::from(SIDE) * u64::from(SIDE)].map(buffer);
    let texture = (!kernel.data.is_empty()).then(|| texture(device, queue, &kernel.data));
    let resources = [zero.as_entire_binding(), out.as_entire_binding()];
    let resources = resources
        .into_iter()
        .chain(texture.iter().map(wgpu::BindingResource::TextureView));
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    (pipeline, group)
}

/// Uploads the words that a shader looks up.
fn texture(device: &wgpu::Device, queue: &wgpu::Queue, words: &[u32]) -> wgpu::TextureView {
    let row = MaterialShader::DATA_ROW;
    let size = wgpu::Extent3d {
        width: row as u32 / 4,
        height: (words.len() / row) as u32,
        depth_or_array_layers: 1,
    };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
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
        bytes_per_row: Some(4 * row as u32),
        rows_per_image: None,
    };
    queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
    texture.create_view(&Default::default())
}
