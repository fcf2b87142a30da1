//! Tests of noise that looks up words in a texture: wavelet noise and textures of control points.

use super::{Place, differing, places, without_barrier, words};
use dapple_hash::Seed;
use dapple_pups::glam::{DVec2, DVec3};
use dapple_pups::points::Domain;
use dapple_pups::{
    AxialWeight, CellsOptions, CowOptions, NetField, NetOptions, NoiseOptions, Orientations,
    PupsField, PupsRecipe, Spacing,
};
use dapple_wavelet::WaveletNoise2;
use dapple_wgsl::Module;
use dapple_wgsl_tests::Gpu;
use std::sync::Arc;

/// Returns random positions near the origin and far from it.
fn everywhere(seed: u64, n: usize) -> Vec<Place<2>> {
    let near_and_far = [2, 17].map(|bits| places::<2>(seed, bits));
    let all = near_and_far.into_iter().flat_map(|mut places| {
        places.truncate(n / 2);
        places
    });
    all.collect()
}

/// Returns the source of a module with an entry point that evaluates `call` at each position. The words of a position's
/// texture start at the texel `first`.
fn shader(module: Module, call: &str) -> String {
    module.source()
        + &format!(
            "
@group(0) @binding(0) var<storage> zero: u32;
@group(0) @binding(1) var<storage> places: array<array<vec4<u32>, 2>>;
@group(0) @binding(2) var<storage> texels: array<u32>;
@group(0) @binding(3) var<storage, read_write> out: array<f32>;
@group(0) @binding(4) var data: texture_2d<u32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let words = places[id.x];
    let at = position_2d(Place2d(bitcast<vec4<i32>>(words[0]).xy, bitcast<vec4<f32>>(words[1]).xy));
    let first = texels[id.x];
    out[id.x] = {call};
}}"
        )
}

/// Inputs of a test with several textures: the words of all textures; and for each position, the first texel of its
/// texture and the value on the CPU.
#[derive(Default)]
struct Textures {
    data: Vec<u32>,
    places: Vec<Place<2>>,
    texels: Vec<u32>,
    on_cpu: Vec<u32>,
}

impl Textures {
    fn add(&mut self, words: &[u32], n: usize, value: impl Fn([f64; 2]) -> f32) {
        // A texel has four words.
        let first = self.data.len().next_multiple_of(4);
        self.data.resize(first, 0);
        self.data.extend_from_slice(words);
        let places = everywhere(first as u64, n);
        self.texels.extend(places.iter().map(|_| first as u32 / 4));
        let values = places.iter().map(|place| value(place.position()).to_bits());
        self.on_cpu.extend(values);
        self.places.extend(places);
    }

    /// Returns the number of values that differ between CPU and GPU.
    fn differing(&self, gpu: &Gpu, shader: &str) -> usize {
        let inputs = [&[0][..], &words(&self.places), &self.texels];
        let on_gpu = gpu.compute_with_data(shader, &inputs, &self.data, self.places.len(), 1);
        differing(&self.on_cpu, &on_gpu)
    }
}

#[test]
fn wavelet_noise_has_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    let mut textures = Textures::default();
    let tiles: [([u32; 2], &[f32]); 6] = [
        ([4, 4], &[1.0]),
        ([128, 128], &[1.0, 0.5, 0.25, 0.125, 0.0625]),
        ([6, 100], &[0.0, -3.0, 0.0, 1e-3]),
        ([250, 12], &[1.0, 0.0, 0.7]),
        ([32, 64], &[0.9; 16]),
        // No band
        ([8, 8], &[0.0]),
    ];
    for (seed, (size, weights)) in (0..).zip(tiles) {
        let noise = WaveletNoise2::of_size(size, Seed(seed)).expect("a tile");
        let noise = noise.with_weights(weights).expect("weights");
        textures.add(&noise.shader_words(), 1 << 16, |at| noise.sample(at));
    }
    let call = "wavelet_noise_2d(data, first, at, zero)";
    let shader = shader(Module::WaveletNoise2d, call);
    assert_eq!(textures.differing(&gpu, &shader), 0);
    // The order of sums has an effect.
    let sum = "exact_add(exact_add(top, middle, zero), bottom, zero)";
    assert_eq!(shader.matches(sum).count(), 1, "the sum of the rows");
    let other = shader.replace(sum, "exact_add(top, exact_add(middle, bottom, zero), zero)");
    assert!(textures.differing(&gpu, &other) > textures.places.len() / 100);
}

/// Returns textures with all axial weights, with and without orientations and fading axes, some of which repeat.
fn nets() -> Vec<Arc<dyn NetField>> {
    let domain = |wrap| Domain {
        origin: DVec2::new(0.3, -7.0),
        size: DVec2::new(3.0, 5.0),
        wrap,
    };
    let oriented = |strength| NetOptions {
        orientations: Orientations::Random,
        strength,
        ..NetOptions::default()
    };
    let quintic = NetOptions {
        weight: AxialWeight::Quintic,
        ..NetOptions::default()
    };
    let faded = NetOptions {
        axis_scale: 2.0,
        fade: 0.5,
        ..NetOptions::default()
    };
    let dips = NetOptions {
        weight: AxialWeight::Oscillating {
            dips: 3,
            depth: 0.7,
        },
        orientations: Orientations::Same(DVec3::new(1.0, 0.3, 0.2)),
        fade: 0.25,
        ..NetOptions::default()
    };
    let noises = [
        (Domain::paper_torus(), 400, NetOptions::default()),
        (domain([true, true]), 5, NetOptions::default()),
        (domain([false, true]), 60, oriented(0.5)),
        (domain([true, false]), 30, oriented(0.999_999)),
        (domain([false, false]), 100, quintic),
        (Domain::paper_torus(), 1, NetOptions::default()),
        (domain([true, true]), 80, faded),
        (domain([true, true]), 40, dips),
    ];
    let noises = noises.map(|(domain, count, net)| NoiseOptions {
        domain,
        spacing: Spacing::Count(count),
        net,
    });
    let mut fields = Vec::new();
    for (seed, options) in (0..).zip(noises) {
        fields.push(options.build(&(), Seed(seed)));
    }
    fields.push(CellsOptions::of_three_or_four().build(&(), Seed(8)));
    fields.push(CowOptions::default().build(&(), Seed(9)));
    let fields = fields.into_iter().map(|field| match field {
        Ok(PupsField::Numbers(field)) => field,
        other => panic!("{other:?}"),
    });
    fields.collect()
}

#[test]
fn textures_of_control_points_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    let mut textures = Textures::default();
    for net in nets() {
        let layers = net.shader_layers();
        assert_eq!(layers.layers.len(), 1, "a single net");
        textures.add(&layers.layers[0].words, 1 << 14, |at| net.value(at));
    }
    let call = "pups_value(data, first, pups_position(data, first, at), zero)";
    let shader = shader(Module::Pups2d, call);
    assert_eq!(textures.differing(&gpu, &shader), 0);
    // Mesa simplifies the rounding of logarithms, which powers of weights need.
    if gpu.is_lavapipe() {
        let wrong = textures.differing(&gpu, &without_barrier(&shader));
        assert!(wrong > textures.places.len() / 100, "only {wrong} differ");
    }
}
