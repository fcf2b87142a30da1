//! Rasters and textures of windows.

use crate::{bits, gpu, on_gpu, recipe, window};
use dapple_gpu::GpuErrorKind;
use dapple_gpu::wgpu;
use dapple_recipe::raster::{Field as _, Window};

/// A number and a color that the GPU computes, each from a node that the CPU computes (F4 has no shader).
const HYBRID: &str = r##"
    dapple = 1
    extent = [4.0, 4.0]
    [nodes]
    cells.worley = { frequency = 4.0, value = "f2_minus_f1" }
    bumps.worley = { frequency = 5.0, value = "f4" }
    swell.noise = { basis = "pups", frequency = 5.0, octaves = 2 }
    sum.add = ["cells", "bumps", "swell"]
    color.ramp = { input = "sum", colors = ["#204060", "#f0e0d0"], space = "linear" }
    [material]
    height = "sum"
    albedo = "color"
    "##;

#[test]
fn rasters_have_the_bits_of_the_plan() {
    let Some(gpu) = gpu() else { return };
    let made = recipe(HYBRID);
    let on_gpu = on_gpu(&gpu, &made);
    for size in [[1, 1], [65, 3], [200, 130]] {
        let window = window(size);
        for node in ["cells", "sum"] {
            let expected = made.1.field(node).expect("a node").to_raster(&window);
            let found = on_gpu.raster(node, &window).expect("a raster");
            let expected = expected.expect("a raster");
            assert_eq!(bits(found.pixels()), bits(expected.pixels()), "{node}");
        }
        let expected = made.1.colors("color").expect("a node").to_raster(&window);
        let found = on_gpu.colors("color", &window).expect("a raster");
        assert_eq!(found, expected.expect("a raster"));
    }
}

#[test]
fn textures_have_the_bits_of_rasters() {
    let Some(gpu) = gpu() else { return };
    let made = recipe(HYBRID);
    let on_gpu = on_gpu(&gpu, &made);
    let window = window([70, 5]);
    let heights = on_gpu.texture("sum", &window).expect("a texture");
    assert_eq!(heights.format(), wgpu::TextureFormat::R32Float);
    let expected = on_gpu.raster("sum", &window).expect("a raster");
    assert_eq!(read(&gpu, &heights, 1), bits(expected.pixels()));
    let colors = on_gpu.texture("color", &window).expect("a texture");
    assert_eq!(colors.format(), wgpu::TextureFormat::Rgba32Float);
    let expected = on_gpu.colors("color", &window).expect("a raster");
    let expected = expected.pixels().iter().flat_map(|color| {
        let [r, g, b] = color.to_array();
        [r, g, b, 1.0].map(f32::to_bits)
    });
    assert_eq!(read(&gpu, &colors, 4), expected.collect::<Vec<_>>());
}

/// Reads a texture with `channels` words for a pixel.
fn read(gpu: &dapple_gpu::Gpu, texture: &wgpu::Texture, channels: u32) -> Vec<u32> {
    let (device, size) = (gpu.device(), texture.size());
    let row = (4 * channels * size.width).next_multiple_of(256);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * size.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(row),
        rows_per_image: None,
    };
    let to = wgpu::TexelCopyBufferInfo {
        buffer: &buffer,
        layout,
    };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), to, size);
    gpu.queue().submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("a buffer"));
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("results");
    let bytes = buffer.get_mapped_range(..).expect("bytes");
    let rows = bytes.chunks_exact(row as usize);
    let words = rows.flat_map(|row| {
        row[..4 * (channels * size.width) as usize]
            .as_chunks::<4>()
            .0
    });
    words.map(|word| u32::from_le_bytes(*word)).collect()
}

#[test]
fn nodes_without_a_shader_and_unknown_nodes_are_errors() {
    let Some(gpu) = gpu() else { return };
    let on_gpu = on_gpu(&gpu, &recipe(HYBRID));
    let window = window([8, 8]);
    let error = on_gpu
        .raster("bumps", &window)
        .expect_err("it has no shader");
    let node = "bumps".to_owned();
    assert_eq!(*error.kind(), GpuErrorKind::NotInShader { node });
    for node in ["color", "unknown"] {
        let error = on_gpu.raster(node, &window).expect_err("it has no numbers");
        assert!(matches!(error.kind(), GpuErrorKind::Recipe(_)), "{error}");
    }
    let wide = Window::new([0.0; 2], [1.0; 2], [1 << 20, 1]).expect("a window");
    let error = on_gpu.texture("sum", &wide).expect_err("it is too wide");
    assert!(
        matches!(error.kind(), GpuErrorKind::TooLarge { .. }),
        "{error}"
    );
}
