//! Tests of the shaders' arithmetic: quotients, powers and 64-bit floats.

use super::{N, differing};
use dapple_hash::rand_core::Rng;
use dapple_hash::{Pcg32, Seed};
use dapple_wgsl::{Module, source};
use dapple_wgsl_tests::Gpu;

/// Runs `body` once for each `width` words of the input. It must set `words` words of `out`, starting at `out[base]`.
/// Returns the output.
fn run(
    gpu: &Gpu,
    modules: &[Module],
    input: &[u32],
    width: usize,
    words: usize,
    body: &str,
) -> Vec<u32> {
    let shader = source(modules)
        + &format!(
            "
@group(0) @binding(0) var<storage> zero: u32;
@group(0) @binding(1) var<storage> values: array<u32>;
@group(0) @binding(2) var<storage, read_write> out: array<u32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let at = {width}u * id.x;
    let base = {words}u * id.x + zero;
    {body}
}}"
        );
    gpu.compute(&shader, &[&[0], input], input.len() / width, words)
}

/// Returns a random normal number whose exponent is from `-range` to `range`. Some mantissas are near a power of two.
fn number(stream: &mut Pcg32, range: u32) -> f32 {
    let draw = stream.next_u32();
    let mantissa = match draw % 8 {
        0 => stream.next_u32() % 4,
        1 => 0x7F_FFFF - stream.next_u32() % 4,
        _ => stream.next_u32() >> 9,
    };
    let exponent = 127 - range + stream.next_u32() % (2 * range + 1);
    f32::from_bits(draw & 0x8000_0000 | exponent << 23 | mantissa)
}

#[test]
fn quotients_are_rounded_to_nearest() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(3).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N {
        let (a, b) = (number(&mut stream, 60), number(&mut stream, 60));
        let (a, b) = match i % 50 {
            0 => (0.0 * a, b),
            // The quotient is infinite, or 0 instead of a denormal number.
            1 => (number(&mut stream, 126), number(&mut stream, 126)),
            2 => (b, b),
            _ => (a, b),
        };
        let quotient = a / b;
        let is_normal = quotient.is_normal() || quotient.is_infinite();
        on_cpu.push(
            if is_normal {
                quotient
            } else {
                0.0_f32.copysign(quotient)
            }
            .to_bits(),
        );
        input.extend([a.to_bits(), b.to_bits()]);
    }
    let body = "let pair = vec2(bitcast<f32>(values[at]), bitcast<f32>(values[at + 1u]));
        out[base] = bitcast<u32>(number_div(pair.x, pair.y, zero));";
    let on_gpu = run(&gpu, &[Module::Number], &input, 2, 1, body);
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
}

#[test]
fn powers_have_the_bits_of_libm() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(4).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N {
        let base = match i % 20 {
            0 => [0.0, -0.0, 1.0, f32::INFINITY, f32::MIN_POSITIVE / 2.0][i / 20 % 5],
            1..10 => number(&mut stream, 1).abs(),
            _ => number(&mut stream, 20).abs(),
        };
        let exponent = match i % 3 {
            0 => f32::from(1 + 2 * (stream.next_u32() % 5) as u16),
            1 => number(&mut stream, 2).abs(),
            _ => number(&mut stream, 6).abs(),
        };
        // These three exponents are separate cases on the CPU, and for the writer of a shader.
        let exponent = if [0.5, 1.0, 2.0].contains(&exponent) {
            3.0
        } else {
            exponent
        };
        let power = libm::powf(base, exponent);
        on_cpu.push(if power.is_subnormal() {
            0
        } else {
            power.to_bits()
        });
        input.extend([base.to_bits(), exponent.to_bits()]);
    }
    let body = "let pair = vec2(bitcast<f32>(values[at]), bitcast<f32>(values[at + 1u]));
        out[base] = bitcast<u32>(number_power(pair.x, pair.y, zero));";
    let on_gpu = run(&gpu, &[Module::Power], &input, 2, 1, body);
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
}

/// Returns a random 64-bit float whose exponent is from `-range` to `range`.
fn double(stream: &mut Pcg32, range: u64) -> f64 {
    let draw = stream.next_u64();
    let mantissa = match draw % 8 {
        0 => stream.next_u64() % 4,
        1 => (1 << 52) - 1 - stream.next_u64() % 4,
        2 => stream.next_u64() >> 12 & !0xFFFF_FFFF,
        3 => stream.next_u64() >> 12 & !0x1FFF_FFFF | 0x1000_0000,
        _ => stream.next_u64() >> 12,
    };
    let exponent = 1023 - range + stream.next_u64() % (2 * range + 1);
    f64::from_bits(draw & 1 << 63 | exponent << 52 | mantissa)
}

/// Returns the upper and the lower word of a number's bits.
fn words(x: f64) -> [u32; 2] {
    [(x.to_bits() >> 32) as u32, x.to_bits() as u32]
}

#[test]
fn sums_and_products_of_64_bits_are_rounded_to_nearest_even() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(5).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N {
        let a = double(&mut stream, 40);
        let b = match i % 10 {
            0 => [0.0, -0.0][i / 10 % 2],
            // Nearly or fully cancels
            1 => -a,
            2 => f64::from_bits((-a).to_bits() ^ (stream.next_u64() % 8)),
            // Exponents are close, so that the sum is rounded halfway between two numbers
            3 | 4 => a * double(&mut stream, 2),
            // The sum is rounded halfway between two numbers
            5 => f64::from_bits((a.to_bits() & 0xFFF << 52) - (53 << 52)),
            _ => double(&mut stream, 70),
        };
        input.extend(words(a).into_iter().chain(words(b)));
        for result in [a + b, a - b, a * b] {
            on_cpu.extend(words(result));
        }
    }
    let body = "let a = vec2(values[at], values[at + 1u]);
        let b = vec2(values[at + 2u], values[at + 3u]);
        let results = array(double_add(a, b), double_sub(a, b), double_mul(a, b));
        out[base] = results[0].x;
        out[base + 1u] = results[0].y;
        out[base + 2u] = results[1].x;
        out[base + 3u] = results[1].y;
        out[base + 4u] = results[2].x;
        out[base + 5u] = results[2].y;";
    let on_gpu = run(&gpu, &[Module::Double], &input, 4, 6, body);
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
}

#[test]
fn conversions_of_64_bits_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(6).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N {
        let x = match i % 10 {
            0 => [
                0.0,
                -0.0,
                -1.0,
                1.0,
                0.5,
                -0.5,
                2_147_483_647.5,
                -2_147_483_648.0,
            ][i / 10 % 8],
            1 => f64::from(stream.next_u32().cast_signed()),
            2 => f64::from(stream.next_u32().cast_signed()) + 0.5,
            _ => double(&mut stream, 30),
        };
        let int = stream.next_u32() >> (i % 32);
        let float = number(&mut stream, 100);
        input.extend(words(x));
        input.extend([int, float.to_bits()]);
        on_cpu.extend(words(x.floor()));
        // A conversion to an integer leaves out the fraction.
        on_cpu.extend([(x as f32).to_bits(), (x as i32).cast_unsigned()]);
        on_cpu.extend(words(f64::from(int.cast_signed())));
        on_cpu.extend(words(f64::from(float)));
        on_cpu.extend(words(x.abs()));
    }
    let body = "let x = vec2(values[at], values[at + 1u]);
        let whole = double_floor(x);
        let int = double_from_int(i32(values[at + 2u]));
        let float = double_from(bitcast<f32>(values[at + 3u]));
        let size = double_abs(x);
        out[base] = whole.x;
        out[base + 1u] = whole.y;
        out[base + 2u] = bitcast<u32>(double_to_float(x));
        out[base + 3u] = u32(double_to_int(x));
        out[base + 4u] = int.x;
        out[base + 5u] = int.y;
        out[base + 6u] = float.x;
        out[base + 7u] = float.y;
        out[base + 8u] = size.x;
        out[base + 9u] = size.y;";
    let on_gpu = run(&gpu, &[Module::Double], &input, 4, 10, body);
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
}

#[test]
fn selections_keep_the_sign_of_zero_and_sums_keep_their_rounding() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(7).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N {
        let pair = match i % 4 {
            0 => [[0.0, -0.0], [-0.0, 0.0]][i / 4 % 2],
            _ => [number(&mut stream, 3), number(&mut stream, 3)],
        };
        let [a, b] = pair;
        input.extend(pair.map(f32::to_bits));
        // The first number unless the second is less or more
        let [least, most] = [if b < a { b } else { a }, if b > a { b } else { a }];
        let results = [least, most, a.clamp(0.0, 1.0), a + b - a, a * b + a];
        on_cpu.extend(results.map(f32::to_bits));
    }
    let body = "let a = bitcast<f32>(values[at]);
        let b = bitcast<f32>(values[at + 1u]);
        out[base] = bitcast<u32>(number_min(a, b, zero));
        out[base + 1u] = bitcast<u32>(number_max(a, b, zero));
        out[base + 2u] = bitcast<u32>(number_clamp(a, 0.0, 1.0, zero));
        out[base + 3u] = bitcast<u32>(number_sub(number_add(a, b, zero), a, zero));
        out[base + 4u] = bitcast<u32>(number_add(number_mul(a, b, zero), a, zero));";
    let on_gpu = run(&gpu, &[Module::Number], &input, 2, 5, body);
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
    // Mesa simplifies the difference of a sum and its first term.
    if gpu.is_lavapipe() {
        let body = body.replace(", zero)", ", 0u)");
        let on_gpu = run(&gpu, &[Module::Number], &input, 2, 5, &body);
        assert!(
            differing(&on_cpu, &on_gpu) > N / 100,
            "the barrier has an effect"
        );
    }
}

#[test]
fn sines_have_the_bits_of_libm() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(9).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N {
        // Phases of all sizes, and angles next to multiples of a quarter of π
        let turns = match i % 4 {
            0 => f64::from(stream.next_u32()) / 4_294_967_296.0,
            1 => f64::from(stream.next_u32() % 9) / 8.0,
            2 => double(&mut stream, 20).abs() % 1.0,
            _ => f64::from(stream.next_u32() >> (stream.next_u32() % 24)) / 4_294_967_296.0,
        };
        let angle = core::f64::consts::TAU * turns;
        let angle = f64::from_bits(angle.to_bits() + stream.next_u64() % 3);
        input.extend(words(angle));
        on_cpu.extend(words(libm::sin(angle)));
    }
    let body = "let sine = double_sine(vec2(values[at], values[at + 1u]));
        out[base] = sine.x;
        out[base + 1u] = sine.y;";
    let on_gpu = run(&gpu, &[Module::DoubleSine], &input, 2, 2, body);
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
}

#[test]
fn quotients_and_roots_of_64_bits_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(8).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N {
        let a = double(&mut stream, 40);
        let b = match i % 6 {
            0 => a,
            1 => f64::from_bits(a.to_bits() ^ (stream.next_u64() % 8)),
            2 => -a,
            _ => double(&mut stream, 70),
        };
        let a = if i % 50 == 0 { 0.0 } else { a };
        // Squares have exact roots, and their neighbors nearly exact ones.
        let square = match i % 4 {
            0 => f64::from((a as f32).abs()) * f64::from((a as f32).abs()),
            1 => f64::from_bits((a * a).to_bits() + stream.next_u64() % 3),
            _ => a.abs(),
        };
        input.extend([a, b, square].into_iter().flat_map(words));
        on_cpu.extend([a / b, square.sqrt()].into_iter().flat_map(words));
        on_cpu.push(u32::from(a < b));
    }
    let body = "let a = vec2(values[at], values[at + 1u]);
        let b = vec2(values[at + 2u], values[at + 3u]);
        let results = array(double_div(a, b), double_root(vec2(values[at + 4u], values[at + 5u])));
        out[base] = results[0].x;
        out[base + 1u] = results[0].y;
        out[base + 2u] = results[1].x;
        out[base + 3u] = results[1].y;
        out[base + 4u] = u32(double_is_less(a, b));";
    let on_gpu = run(&gpu, &[Module::DoubleQuotient], &input, 6, 5, body);
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
}

#[test]
fn angles_and_extremes_of_64_bits_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(8).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N {
        let a = match i % 10 {
            0 => [0.0, -0.0][i / 10 % 2],
            1 => f64::from(stream.next_u32()),
            _ => double(&mut stream, 40),
        };
        let b = match i % 7 {
            0 => a + 1e-9,
            1 => 1.0 / (1.0 + f64::from(stream.next_u32() % 1000)),
            2 => double(&mut stream, 2) * a,
            _ => double(&mut stream, 40),
        };
        let b = if b == 0.0 { 1.0 } else { b };
        input.extend(words(a).into_iter().chain(words(b)));
        for result in [libm::atan2(a, b), a.min(b).max(0.25)] {
            on_cpu.extend(words(result));
        }
    }
    let body = "let a = vec2(values[at], values[at + 1u]);
        let b = vec2(values[at + 2u], values[at + 3u]);
        let results = array(double_angle(a, b), double_max(double_min(a, b), vec2(0x3fd00000u, 0u)));
        out[base] = results[0].x;
        out[base + 1u] = results[0].y;
        out[base + 2u] = results[1].x;
        out[base + 3u] = results[1].y;";
    let on_gpu = run(
        &gpu,
        &[Module::DoubleAngle, Module::DoubleFunctions],
        &input,
        4,
        4,
        body,
    );
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
}
