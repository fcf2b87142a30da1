//! Tests of Worley's basis: distances, vectors and ids of the nearest feature points, and distances to cell borders.

use super::{N, Place, differing, places, words};
use dapple_hash::Seed;
use dapple_hash::rand_core::Rng;
use dapple_wgsl::Module;
use dapple_wgsl_tests::Gpu;
use dapple_worley::{
    Dimensions, Feature, Metric, Scatter, Space, Vector, Worley, Worley2, Worley3, Worley4,
};

/// Returns a shader that writes distance, vector and id of the `n` nearest feature points. `count` is the argument for
/// the number of points, or empty if the function has no such argument.
fn shader(axes: usize, module: Module, n: usize, count: &str) -> String {
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
    var features = worley_{axes}d(worley, Place{axes}d(cell.{swizzle}, fraction.{swizzle}), {count}zero);
    for (var i = 0u; i < {n}u; i++) {{
        let at = {size}u * ({n}u * id.x + i);
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

fn sampled<const D: usize, const NEAREST: usize>(
    worley: &Worley<D>,
    places: &[Place<D>],
) -> Vec<u32>
where
    Dimensions: Space<D>,
{
    let mut on_cpu = Vec::new();
    for place in places {
        let features: [Feature<Vector<D>>; NEAREST] = worley.sample(place.position());
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

/// Compares all scatters, several periods and metrics with the CPU, near the origin and far from it, at `n` positions
/// each.
fn compare<const D: usize, const NEAREST: usize>(
    module: Module,
    count: &str,
    n: usize,
    new: impl Fn(Seed) -> Worley<D>,
) where
    Dimensions: Space<D>,
{
    let Some(gpu) = Gpu::new() else { return };
    let shader = shader(D, module, NEAREST, count);
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
        // A grid whose points all have the same id
        Scatter::Jittered { jitter: 0.0 },
        Scatter::Poisson { density: 0.3 },
    ];
    let periods = [0, 1, 2, 7, 1 << 31, 3, 1, 1, 5];
    let metrics = [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev];
    for (seed, (scatter, period)) in (0..).zip(scatters.into_iter().zip(periods)) {
        let mut cells = [None; D];
        for (axis, cells) in cells.iter_mut().enumerate() {
            *cells = (period > 0).then(|| (period - axis as u32 % 2).max(1));
        }
        let worley = new(Seed(seed)).with_period(cells).expect("a period");
        let worley = worley.with_scatter(scatter).expect("a scatter");
        let metric = metrics[(seed as usize).div_ceil(3) % 3];
        let worley = worley.with_metric(metric).expect("a metric");
        for bits in [2, 29] {
            let mut places = places::<D>(seed, bits);
            places.truncate(n);
            let on_cpu = sampled::<D, NEAREST>(&worley, &places);
            let parameters = worley.shader_words().expect("parameters");
            let inputs = [&[0][..], &parameters, &words(&places)];
            let on_gpu = gpu.compute(&shader, &inputs, n, NEAREST * (3 + D));
            let wrong = differing(&on_cpu, &on_gpu);
            assert_eq!(
                wrong, 0,
                "{scatter:?}, {metric:?}, {cells:?}, cells of {bits} bits"
            );
        }
    }
}

#[test]
fn worley_2d_has_the_bits_of_the_cpu() {
    compare::<2, 2>(Module::Worley2d, "", N >> 2, Worley2::new);
}

#[test]
fn worley_3d_has_the_bits_of_the_cpu() {
    compare::<3, 2>(Module::Worley3d, "", N >> 4, Worley3::new);
}

#[test]
fn worley_4d_has_the_bits_of_the_cpu() {
    compare::<4, 1>(Module::Worley4d, "1u, ", N >> 5, Worley4::new);
    compare::<4, 4>(Module::Worley4d, "4u, ", N >> 7, Worley4::new);
}

#[test]
fn distances_to_edges_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    let shader = Module::WorleyEdges2d.source()
        + "
        @group(0) @binding(0) var<storage> zero: u32;
        @group(0) @binding(1) var<storage> worley: Worley;
        @group(0) @binding(2) var<storage> places: array<array<vec4<u32>, 2>>;
        @group(0) @binding(3) var<storage, read_write> out: array<f32>;
        @compute @workgroup_size(64)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            let words = places[id.x];
            let place = Place2d(bitcast<vec4<i32>>(words[0]).xy, bitcast<vec4<f32>>(words[1]).xy);
            out[id.x] = edge_distance_2d(worley, place, zero);
        }";
    let scatters = [
        (Scatter::default(), 0),
        (Scatter::Jittered { jitter: 1.0 }, 1),
        (Scatter::Jittered { jitter: 0.0 }, 7),
        (Scatter::Poisson { density: 0.3 }, 2),
        (Scatter::Poisson { density: 20.0 }, 1 << 31),
    ];
    for (seed, (scatter, period)) in (0..).zip(scatters) {
        let worley = Worley2::new(Seed(seed)).with_scatter(scatter);
        let worley = worley.expect("a scatter");
        let period = (period > 0).then_some(period);
        let worley = worley.with_period([period; 2]).expect("a period");
        for bits in [2, 29] {
            let mut places = places::<2>(seed, bits);
            places.truncate(N >> 2);
            let on_cpu = places.iter().map(|at| worley.edge_distance(at.position()));
            let on_cpu: Vec<u32> = on_cpu.map(f32::to_bits).collect();
            let parameters = worley.shader_words().expect("parameters");
            let inputs = [&[0][..], &parameters, &words(&places)];
            let on_gpu = gpu.compute(&shader, &inputs, places.len(), 1);
            let wrong = differing(&on_cpu, &on_gpu);
            assert_eq!(wrong, 0, "{scatter:?}, {period:?}, cells of {bits} bits");
            // The distance in 32 bits alone is not exact.
            if seed == 0 && bits == 2 {
                let rounded = "double_to_float(least) * (1.0 / 2097152.0)";
                assert_eq!(shader.matches(rounded).count(), 1, "the last line");
                let on_gpu = gpu.compute(
                    &shader.replace(rounded, "nearest"),
                    &inputs,
                    places.len(),
                    1,
                );
                assert!(differing(&on_cpu, &on_gpu) > places.len() / 100);
            }
        }
    }
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
