//! Tests that the shaders of `dapple-wgsl` have the same bits as the CPU.

mod fields;
mod gradient_noise;
mod lookups;
mod naga_oil;
mod numbers;
mod recipes;
mod worley;

use dapple_hash::Seed;
use dapple_hash::rand_core::Rng;
use dapple_wgsl_tests::Gpu;

/// Number of positions per run.
const N: usize = 1 << 18;

/// A position as a shader reads it: integer cells, and fractions as multiples of 2^-24.
#[derive(Clone, Copy)]
struct Place<const D: usize> {
    cell: [i32; D],
    fraction: [u32; D],
}

impl<const D: usize> Place<D> {
    /// Returns the position in cells. It is exact if the cell is below 2^29.
    fn position(&self) -> [f64; D] {
        std::array::from_fn(|axis| {
            f64::from(self.cell[axis]) + f64::from(self.fraction[axis]) / f64::from(1 << 24)
        })
    }

    /// Splits a position into cells and fractions. Its coordinates must be multiples of 2^-24.
    fn of(position: [f64; D]) -> Self {
        let place = Self {
            cell: position.map(|part| part.floor() as i32),
            fraction: position.map(|part| ((part - part.floor()) * f64::from(1 << 24)) as u32),
        };
        assert_eq!(place.position(), position, "the position is exact");
        place
    }

    /// Returns the words that a shader reads: four for the cell and four for the fraction.
    fn words(&self) -> [u32; 8] {
        let mut words = [0; 8];
        for axis in 0..D {
            words[axis] = self.cell[axis].cast_unsigned();
            let fraction = self.fraction[axis] as f32 / 16_777_216.0;
            words[4 + axis] = fraction.to_bits();
        }
        words
    }
}

/// Returns random positions whose cells have at most `bits` bits and a sign. A quarter of the fractions are at, or next
/// to, a side or the center of the cell.
fn places<const D: usize>(seed: u64, bits: u32) -> Vec<Place<D>> {
    let mut stream = Seed(seed).child("places", u64::from(bits)).stream();
    let mut place = || {
        let cell = [(); D].map(|()| stream.next_u32().cast_signed() >> (31 - bits));
        let fraction = [(); D].map(|()| {
            let draw = stream.next_u32();
            match draw % 20 {
                0 => 0,
                1 => 1,
                2 => (1 << 24) - 1,
                3 => 1 << 23,
                4 => (1 << 23) + 1,
                _ => draw >> 8,
            }
        });
        Place { cell, fraction }
    };
    (0..N).map(|_| place()).collect()
}

fn words<const D: usize>(places: &[Place<D>]) -> Vec<u32> {
    places.iter().flat_map(Place::words).collect()
}

/// Returns the shader's source with its barrier removed.
fn without_barrier(source: &str) -> String {
    let barrier = "return bitcast<vec4<f32>>(bitcast<vec4<u32>>(x) ^ vec4(zero));";
    assert_eq!(source.matches(barrier).count(), 1, "one barrier");
    source.replace(barrier, "return x;")
}

/// Returns the number of results whose bits differ, and prints the first such result.
#[expect(clippy::print_stdout, reason = "it is shown if a test fails")]
fn differing(on_cpu: &[u32], on_gpu: &[u32]) -> usize {
    assert_eq!(on_cpu.len(), on_gpu.len(), "number of results");
    let pairs = on_cpu.iter().zip(on_gpu).enumerate();
    let mut wrong = pairs.filter(|(_, (a, b))| a != b);
    let Some((first, (a, b))) = wrong.next() else {
        return 0;
    };
    println!("result {first} is {a:#x} on the CPU and {b:#x} on the GPU");
    1 + wrong.count()
}

#[test]
fn a_sum_minus_its_first_term_is_simplified_without_the_barrier() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(1).stream();
    let numbers: Vec<f32> = (0..2 * N)
        .map(|_| (stream.next_u32() >> 8) as f32 / 16_777_216.0)
        .collect();
    let pairs = numbers.chunks_exact(2);
    let on_cpu: Vec<u32> = pairs.map(|ab| (ab[0] + ab[1] - ab[0]).to_bits()).collect();
    let input: Vec<u32> = numbers.iter().map(|number| number.to_bits()).collect();
    let shader = dapple_wgsl::Module::Exact.source()
        + "
        @group(0) @binding(0) var<storage> zero: u32;
        @group(0) @binding(1) var<storage> pairs: array<vec2<f32>>;
        @group(0) @binding(2) var<storage, read_write> out: array<f32>;
        @compute @workgroup_size(64)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            let pair = pairs[id.x];
            let sum = exact_add(vec4(pair.x), vec4(pair.y), zero);
            out[id.x + zero] = exact_sub(sum, vec4(pair.x), zero).x;
        }";
    let with = gpu.compute(&shader, &[&[0], &input], N, 1);
    assert_eq!(differing(&on_cpu, &with), 0);
    // A driver may leave out the simplification, but Mesa has it, and a literal does not prevent it.
    if gpu.is_lavapipe() {
        for wrong_shader in [without_barrier(&shader), shader.replace(", zero)", ", 0u)")] {
            let without = gpu.compute(&wrong_shader, &[&[0], &input], N, 1);
            let wrong = differing(&on_cpu, &without);
            assert!(wrong > N / 100, "only {wrong} results differ");
        }
    }
}
