//! Tests of gradient noise and its fractal sums.

use super::{N, differing, places, without_barrier, words};
use dapple_hash::Seed;
use dapple_hash::rand_core::Rng;
use dapple_noise::{GradientNoise, GradientNoise2, GradientNoise3, GradientNoise4};
use dapple_raster::{Field, Fractal, FractalShape};
use dapple_wgsl::{Module, source};
use dapple_wgsl_tests::Gpu;

/// Returns the bindings of all entry points, and a function that reads a position with `axes` axes.
fn bindings(axes: usize) -> String {
    let swizzle = &"xyzw"[..axes];
    format!(
        "
@group(0) @binding(0) var<storage> zero: u32;
@group(0) @binding(1) var<storage> octaves: array<GradientNoise>;
@group(0) @binding(2) var<storage> places: array<array<vec4<u32>, 2>>;
@group(0) @binding(3) var<storage, read_write> out: array<f32>;
fn read_place(index: u32) -> Place{axes}d {{
    let words = places[index];
    let cell = bitcast<vec4<i32>>(words[0]);
    let fraction = bitcast<vec4<f32>>(words[1]);
    return Place{axes}d(cell.{swizzle}, fraction.{swizzle});
}}"
    )
}

/// Returns a shader that computes the noise value at every position.
fn values(axes: usize, module: Module) -> String {
    module.source()
        + &bindings(axes)
        + &format!(
            "
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    out[id.x] = gradient_noise_{axes}d(octaves[0], read_place(id.x), zero);
}}"
        )
}

/// Compares the noise of several seeds and periods with the CPU, near the origin and far from it.
fn compare_values<const D: usize>(module: Module, new: impl Fn(Seed) -> GradientNoise<D>) {
    let Some(gpu) = Gpu::new() else { return };
    let shader = values(D, module);
    for (seed, period) in (0..).zip([0, 1, 7, 4, 1000, 1 << 31]) {
        // Axes have different periods, and the last one has none.
        let mut periods = [None; D];
        for (axis, cells) in periods[..D - 1].iter_mut().enumerate() {
            *cells = (period > 0).then(|| period - (axis as u32).min(period - 1));
        }
        let noise = new(Seed(seed)).with_period(periods).expect("a period");
        for bits in [2, 12, 29] {
            let places = places::<D>(seed, bits);
            let positions: Vec<_> = places.iter().map(|place| place.position()).collect();
            let mut values = vec![0.0; N];
            let filled = noise.sample_many(&positions, &mut values);
            filled.expect("one length");
            let on_cpu: Vec<u32> = values.iter().map(|value| value.to_bits()).collect();
            let parameters = noise.shader_words(1.0).expect("parameters");
            let inputs = [&[0][..], &parameters, &words(&places)];
            let on_gpu = gpu.compute(&shader, &inputs, N, 1);
            let wrong = differing(&on_cpu, &on_gpu);
            assert_eq!(wrong, 0, "{periods:?}, cells of {bits} bits");
            if gpu.is_lavapipe() && seed == 0 && bits == 12 {
                let on_gpu = gpu.compute(&without_barrier(&shader), &inputs, N, 1);
                let wrong = differing(&on_cpu, &on_gpu);
                // Mesa leaves out no step of the noise in four dimensions; other compilers may.
                assert!(D == 4 || wrong > 0, "the barrier has an effect");
            }
        }
    }
}

/// Compares values and derivatives with the CPU. Also compares an octave, whose positions have an offset.
fn compare_gradients<const D: usize>(module: Module, new: impl Fn(Seed) -> GradientNoise<D>) {
    let Some(gpu) = Gpu::new() else { return };
    let words_out = D + 1;
    let shader = module.source()
        + &bindings(D)
        + &format!(
            "
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    var values = gradient_noise_{D}d_with_gradient(octaves[0], read_place(id.x), zero);
    for (var i = 0u; i < {words_out}u; i++) {{
        out[{words_out}u * id.x + i] = values[i];
    }}
}}"
        );
    for (seed, bits) in [2, 20].into_iter().enumerate() {
        let noise = new(Seed(seed as u64)).with_period([Some(6); D]);
        let sum = noise
            .expect("a period")
            .fractal(3, 0.5, 1.0, FractalShape::Sum);
        let sum = sum.expect("a sum");
        let (octave, ..) = sum.octaves().last().expect("three octaves");
        for noise in [new(Seed(seed as u64)), *octave] {
            let places = places::<D>(seed as u64, bits);
            let mut on_cpu = Vec::new();
            for place in &places {
                let (value, gradient) = noise.sample_with_gradient(place.position());
                on_cpu.push(value.to_bits());
                on_cpu.extend(gradient.map(f32::to_bits));
            }
            let parameters = noise.shader_words(1.0).expect("parameters");
            let inputs = [&[0][..], &parameters, &words(&places)];
            let on_gpu = gpu.compute(&shader, &inputs, N, words_out);
            assert_eq!(differing(&on_cpu, &on_gpu), 0, "cells of {bits} bits");
        }
    }
}

/// Compares fractal sums with the CPU, near the origin and at the largest positions for which the cells of the last
/// octave fit in 32 bits.
fn compare_sums<const D: usize>(module: Module, new: impl Fn(Seed) -> GradientNoise<D>) {
    let Some(gpu) = Gpu::new() else { return };
    let shapes = [
        (FractalShape::Sum, "value"),
        (FractalShape::Ridged, "ridge(value, zero)"),
        (FractalShape::Billow, "abs(value)"),
    ];
    // Octaves, gain, lacunarity, period, bits of the cells. The product of a position and 3^5 must be exact in `f64`.
    let cases = [
        (8, 0.5, 2.0, None, 3),
        (8, 0.5, 2.0, None, 20),
        (8, 0.6, 2.0, Some(12), 20),
        (6, -0.7, 3.0, Some(5), 3),
        (6, 0.3, 3.0, None, 18),
        (1, 0.5, 2.0, None, 29),
    ];
    for (seed, (octaves, gain, lacunarity, period, bits)) in (0..).zip(cases) {
        let (shape, shape_code) = shapes[seed as usize % 3];
        let noise = new(Seed(seed)).with_period([period; D]).expect("a period");
        let sum = noise.fractal(octaves, gain, lacunarity, shape);
        let sum: Fractal<GradientNoise<D>> = sum.expect("a sum");
        let places = places::<D>(seed, bits);
        let positions: Vec<_> = places.iter().map(|place| place.position()).collect();
        let mut values = vec![0.0; N];
        sum.values(&positions, &mut values).expect("one length");
        let on_cpu: Vec<u32> = values.iter().map(|value| value.to_bits()).collect();
        let mut parameters = Vec::new();
        for (noise, _, weight) in sum.octaves() {
            parameters.extend(noise.shader_words(weight).expect("parameters"));
        }
        let shader = source(&[module, Module::Fractal])
            + &bindings(D)
            + &format!(
                "
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    var place = read_place(id.x);
    var sum = 0.0;
    for (var i = 0u; i < arrayLength(&octaves); i++) {{
        let octave = octaves[i];
        let value = gradient_noise_{D}d(octave, place, zero);
        sum = add_octave(sum, octave.weight, {shape_code}, zero);
        place = moved_{D}d(place, {lacunarity}u, vec{D}(0u));
    }}
    out[id.x] = sum;
}}"
            );
        let inputs = [&[0][..], &parameters, &words(&places)];
        let on_gpu = gpu.compute(&shader, &inputs, N, 1);
        let wrong = differing(&on_cpu, &on_gpu);
        assert_eq!(
            wrong, 0,
            "{octaves} octaves, lacunarity {lacunarity}, {bits} bits"
        );
    }
}

/// Compares the noise at positions that the shader splits from `f32` coordinates with the CPU.
fn compare_positions<const D: usize>(module: Module, new: impl Fn(Seed) -> GradientNoise<D>) {
    let Some(gpu) = Gpu::new() else { return };
    let noise = new(Seed(3));
    let mut stream = Seed(5).stream();
    let mut number = || {
        let draw = stream.next_u32();
        let unit = (draw >> 8) as f32 / 16_777_216.0 - 0.5;
        match draw % 16 {
            0 => -0.0,
            1 => -f32::EPSILON * unit.abs(),
            2 => (unit * 100.0).round(),
            3 => 16_777_215.0 * unit.signum(),
            size => unit * (1_u32 << (2 * size - 6)) as f32,
        }
    };
    let positions: Vec<[f32; D]> = (0..N).map(|_| [(); D].map(|()| number())).collect();
    let on_cpu = positions
        .iter()
        .map(|position| noise.sample(position.map(f64::from)).to_bits());
    let on_cpu: Vec<u32> = on_cpu.collect();
    let mut input = Vec::new();
    for position in &positions {
        let mut words = [0; 8];
        for (word, part) in words.iter_mut().zip(position) {
            *word = part.to_bits();
        }
        input.extend(words);
    }
    let swizzle = &"xyzw"[..D];
    let shader = module.source()
        + &bindings(D)
        + &format!(
            "
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let position = bitcast<vec4<f32>>(places[id.x][0]);
    out[id.x] = gradient_noise_{D}d(octaves[0], place_{D}d(position.{swizzle}), zero);
}}"
        );
    let parameters = noise.shader_words(1.0).expect("parameters");
    let on_gpu = gpu.compute(&shader, &[&[0], &parameters, &input], N, 1);
    assert_eq!(differing(&on_cpu, &on_gpu), 0, "{D} dimensions");
}

#[test]
fn gradient_noise_2d_has_the_bits_of_the_cpu() {
    compare_values(Module::GradientNoise2d, GradientNoise2::new);
}

#[test]
fn gradient_noise_3d_has_the_bits_of_the_cpu() {
    compare_values(Module::GradientNoise3d, GradientNoise3::new);
}

#[test]
fn gradient_noise_4d_has_the_bits_of_the_cpu() {
    compare_values(Module::GradientNoise4d, GradientNoise4::new);
}

#[test]
fn derivatives_have_the_bits_of_the_cpu() {
    compare_gradients(Module::GradientNoise2dWithGradient, GradientNoise2::new);
    compare_gradients(Module::GradientNoise3dWithGradient, GradientNoise3::new);
}

#[test]
fn fractal_sums_have_the_bits_of_the_cpu() {
    compare_sums(Module::GradientNoise2d, GradientNoise2::new);
    compare_sums(Module::GradientNoise3d, GradientNoise3::new);
    compare_sums(Module::GradientNoise4d, GradientNoise4::new);
}

#[test]
fn positions_of_a_small_world_have_the_bits_of_the_cpu() {
    compare_positions(Module::GradientNoise2d, GradientNoise2::new);
    compare_positions(Module::GradientNoise3d, GradientNoise3::new);
    compare_positions(Module::GradientNoise4d, GradientNoise4::new);
}
