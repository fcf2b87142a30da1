//! Worley's basis: distances, vectors and ids of the two nearest feature points.

use super::{N, Place, differing, places, words};
use dapple_hash::Seed;
use dapple_hash::rand_core::Rng;
use dapple_wgsl::Module;
use dapple_wgsl_tests::Gpu;
use dapple_worley::{Dimensions, Feature, Scatter, Space, Vector, Worley, Worley2, Worley3};

/// Returns a shader that writes distance, vector and id of both points.
fn shader(axes: usize, module: Module) -> String {
    let swizzle = &"xyzw"[..axes];
    module.source()
        + &format!(
            "
@group(0) @binding(0) var<storage> zero: u32;
@group(0) @binding(1) var<storage> worley: Worley;
@group(0) @binding(2) var<storage> places: array<array<vec4<u32>, 2>>;
@group(0) @binding(3) var<storage, read_write> out: array<u32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let words = places[id.x];
    let cell = bitcast<vec4<i32>>(words[0]);
    let fraction = bitcast<vec4<f32>>(words[1]);
    var features = worley_{axes}d(worley, Place{axes}d(cell.{swizzle}, fraction.{swizzle}), zero);
    for (var i = 0u; i < 2u; i++) {{
        let at = {size}u * (2u * id.x + i);
        out[at] = bitcast<u32>(features[i].distance);
        out[at + 1u] = features[i].id.x;
        out[at + 2u] = features[i].id.y;
        for (var axis = 0u; axis < {axes}u; axis++) {{
            out[at + 3u + axis] = bitcast<u32>(features[i].vector[axis]);
        }}
    }}
}}",
            size = 3 + axes
        )
}

fn sampled<const D: usize>(worley: &Worley<D>, places: &[Place<D>]) -> Vec<u32>
where
    Dimensions: Space<D>,
{
    let mut on_cpu = Vec::new();
    for place in places {
        let features: [Feature<Vector<D>>; 2] = worley.sample(place.position());
        for feature in features {
            let [high, low] = [feature.id >> 32, feature.id & 0xFFFF_FFFF];
            on_cpu.extend([feature.distance.to_bits(), high as u32, low as u32]);
            let vector: [f64; D] = feature.vector.into();
            // Vectors are numbers of `f32`.
            on_cpu.extend(vector.map(|part| (part as f32).to_bits()));
        }
    }
    on_cpu
}

/// Compares all scatters, several periods, near and far.
fn compare<const D: usize>(module: Module, new: impl Fn(Seed) -> Worley<D>)
where
    Dimensions: Space<D>,
{
    let Some(gpu) = Gpu::new() else { return };
    let shader = shader(D, module);
    let scatters = [
        Scatter::default(),
        Scatter::Jittered { jitter: 1.0 },
        Scatter::Jittered { jitter: 0.7 },
        // A regular grid: many points have equal distances.
        Scatter::Jittered { jitter: 0.0 },
        Scatter::Poisson { density: 0.3 },
        Scatter::Poisson { density: 8.0 },
        // The least number of points is never drawn, and a threshold is 0.
        Scatter::Poisson { density: 64.0 },
    ];
    let periods = [0, 1, 2, 7, 1 << 31, 3, 1];
    for (seed, (scatter, period)) in (0..).zip(scatters.into_iter().zip(periods)) {
        let mut cells = [None; D];
        for (axis, cells) in cells.iter_mut().enumerate() {
            *cells = (period > 0).then(|| (period - axis as u32 % 2).max(1));
        }
        let worley = new(Seed(seed)).with_period(cells).expect("a period");
        let worley = worley.with_scatter(scatter).expect("a scatter");
        for bits in [2, 29] {
            let places = places::<D>(seed, bits);
            let on_cpu = sampled(&worley, &places);
            let parameters = worley.shader_words().expect("parameters");
            let inputs = [&[0][..], &parameters, &words(&places)];
            let on_gpu = gpu.compute(&shader, &inputs, N, 2 * (3 + D));
            let wrong = differing(&on_cpu, &on_gpu);
            assert_eq!(wrong, 0, "{scatter:?}, {cells:?}, cells of {bits} bits");
        }
    }
}

#[test]
fn worley_2d_has_the_bits_of_the_cpu() {
    compare(Module::Worley2d, Worley2::new);
}

#[test]
fn worley_3d_has_the_bits_of_the_cpu() {
    compare(Module::Worley3d, Worley3::new);
}

#[test]
fn roots_are_rounded_to_nearest_from_any_near_approximation() {
    let Some(gpu) = Gpu::new() else { return };
    let mut stream = Seed(2).stream();
    let mut input = Vec::new();
    let mut on_cpu = Vec::new();
    for i in 0..N as u32 {
        // Normal numbers of all exponents, among them squares of numbers halfway between two of 24 bits
        let exponent = 1 + stream.next_u32() % 254;
        let mantissa = match i % 4 {
            0 => 0,
            1 => 0x7F_FFFF - stream.next_u32() % 4,
            _ => stream.next_u32() >> 9,
        };
        let bits = exponent << 23 | mantissa;
        let root = f32::from_bits(bits).sqrt().to_bits();
        let error = stream.next_u32() % 61;
        input.extend([bits, root + error - 30]);
        on_cpu.push(root);
    }
    let shader = Module::Root.source()
        + "
        @group(0) @binding(0) var<storage> pairs: array<vec2<f32>>;
        @group(0) @binding(1) var<storage, read_write> out: array<f32>;
        @compute @workgroup_size(64)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            let pair = pairs[id.x];
            out[id.x] = corrected_root(pair.x, pair.y);
        }";
    let on_gpu = gpu.compute(&shader, &[&input], N, 1);
    assert_eq!(differing(&on_cpu, &on_gpu), 0);
    let shader = shader.replace("corrected_root(pair.x, pair.y)", "pair.y");
    let on_gpu = gpu.compute(&shader, &[&input], N, 1);
    assert!(differing(&on_cpu, &on_gpu) > N / 2);
}
