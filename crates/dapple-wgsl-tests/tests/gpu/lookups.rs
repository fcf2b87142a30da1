//! Noise that looks up words in a texture: wavelet noise.

use super::{Place, differing, places, words};
use dapple_hash::Seed;
use dapple_wavelet::WaveletNoise2;
use dapple_wgsl::Module;
use dapple_wgsl_tests::Gpu;

/// Positions of each texture, near the origin and far from it.
fn everywhere(seed: u64, n: usize) -> Vec<Place<2>> {
    let near_and_far = [2, 17].map(|bits| places::<2>(seed, bits));
    let all = near_and_far.into_iter().flat_map(|mut places| {
        places.truncate(n / 2);
        places
    });
    all.collect()
}

/// Appends the call for each position to a module. The words of its texture start at the texel `first`.
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

/// The textures of a test: all words, and for each position its texel and the value on the CPU.
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

    /// Returns the number of values that differ.
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
