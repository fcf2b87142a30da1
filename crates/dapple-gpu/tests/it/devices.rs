//! Small devices, lost devices, and devices that are not exact.

use crate::{bits, gpu, on_gpu, recipe, window};
use dapple_gpu::{Exactness, Gpu, GpuError, GpuErrorKind, wgpu};
use dapple_recipe::raster::{Field as _, Window};
use dapple_recipe::{BakeOptions, RecipeErrorKind};

const CELLS: &str = r#"
    dapple = 1
    [nodes.cells.worley]
    [material]
    height = "cells"
    "#;

/// Opens a device whose buffers have at most `bytes` bytes.
fn device(bytes: u64) -> Option<(wgpu::Device, wgpu::Queue)> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).ok()?;
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits {
            max_storage_buffer_binding_size: bytes,
            ..Default::default()
        },
        ..Default::default()
    };
    pollster::block_on(adapter.request_device(&descriptor)).ok()
}

#[test]
fn the_adapter_is_exact() {
    let Some(gpu) = gpu() else { return };
    assert_eq!(gpu.exactness(), Exactness::Same);
}

#[test]
fn windows_larger_than_a_buffer_are_computed_in_bands() {
    if gpu().is_none() {
        return;
    }
    let (device, queue) = device(1 << 14).expect("a device");
    let gpu = Gpu::new(&device, &queue).expect("a GPU");
    let made = recipe(CELLS);
    let on_gpu = on_gpu(&gpu, &made);
    let bands = window([100, 301]);
    let expected = made.1.field("cells").expect("a node").to_raster(&bands);
    let found = on_gpu.raster("cells", &bands).expect("a raster");
    assert_eq!(
        bits(found.pixels()),
        bits(expected.expect("a raster").pixels())
    );
    let wide = Window::new([0.0; 2], [1.0; 2], [1 << 13, 1]).expect("a window");
    let error = on_gpu
        .raster("cells", &wide)
        .expect_err("a row is too large");
    let expected = GpuErrorKind::TooLarge {
        what: "number of bytes of a row",
        needed: 1 << 16,
        limit: 1 << 14,
    };
    assert_eq!(*error.kind(), expected);
}

#[test]
fn a_lost_device_is_an_error() {
    if gpu().is_none() {
        return;
    }
    let (device, queue) = device(1 << 27).expect("a device");
    let gpu = Gpu::new(&device, &queue).expect("a GPU");
    let on_gpu = on_gpu(&gpu, &recipe(CELLS));
    let window = window([16, 16]);
    on_gpu.raster("cells", &window).expect("a raster");
    device.destroy();
    let error = on_gpu
        .raster("cells", &window)
        .expect_err("the device is lost");
    assert!(matches!(error.kind(), GpuErrorKind::Lost { .. }), "{error}");
    let error = on_gpu
        .texture("cells", &window)
        .expect_err("the device is lost");
    assert!(matches!(error.kind(), GpuErrorKind::Lost { .. }), "{error}");
    let error = Gpu::new(&device, &queue).expect_err("the device is lost");
    assert!(matches!(error.kind(), GpuErrorKind::Lost { .. }), "{error}");
    // A bake returns the error of the GPU within its own.
    let size = [16, 16];
    let bake = on_gpu.bake(&BakeOptions {
        size,
        ..BakeOptions::default()
    });
    let error = bake
        .and_then(|bake| bake.whole_maps())
        .expect_err("the device is lost");
    let RecipeErrorKind::Renderer(error) = error.kind() else {
        panic!("{error}");
    };
    let error = error
        .get_ref()
        .downcast_ref::<GpuError>()
        .expect("an error of the GPU");
    assert!(matches!(error.kind(), GpuErrorKind::Lost { .. }), "{error}");
}
