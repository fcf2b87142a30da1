//! Tests of fields that are composed in Rust, as WGSL functions of the position.

use super::{Place, differing, places, words};
use dapple_hash::Seed;
use dapple_noise::GradientNoise2;
use dapple_raster::{Constant, Field, FieldExt as _, Fractal, FractalShape};
use dapple_recipe::{MaterialShader, RecipeErrorKind, field_to_wgsl};
use dapple_wavelet::WaveletNoise2;
use dapple_wgsl_tests::Gpu;
use dapple_worley::{Combination, Worley2};

/// Number of random positions of each field near the origin; the same number of positions is far from it.
const RANDOM: usize = 1 << 14;

/// Returns the WGSL entry point, which evaluates the field at every position.
fn entry_point(data: &str) -> String {
    format!(
        "
@group(0) @binding(0) var<storage> zero: u32;
@group(0) @binding(1) var<storage> places: array<array<vec4<u32>, 2>>;
@group(0) @binding(2) var<storage, read_write> out: array<f32>;
@group(0) @binding(3) var data: texture_2d<u32>;
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let words = places[id.x];
    let place = Place2d(bitcast<vec4<i32>>(words[0]).xy, bitcast<vec4<f32>>(words[1]).xy);
    out[id.x] = field(place, {data}zero);
}}"
    )
}

/// Compares a field with its shader, at positions near the origin and far from it.
fn compare(gpu: &Gpu, name: &str, field: &dyn Field) {
    let mut all: Vec<Place<2>> = Vec::new();
    for bits in [4, 17] {
        all.extend(&places(11, bits)[..RANDOM]);
    }
    let positions: Vec<_> = all.iter().map(Place::position).collect();
    let mut on_cpu = vec![0.0; positions.len()];
    field.values(&positions, &mut on_cpu).expect("one length");
    let on_cpu: Vec<u32> = on_cpu.into_iter().map(f32::to_bits).collect();
    let shader = field_to_wgsl(field).unwrap_or_else(|error| panic!("{name}: {error}"));
    let rest = shader.data.len() % MaterialShader::DATA_ROW;
    assert_eq!(rest, 0, "words after whole rows of {name}");
    let data = if shader.data.is_empty() { "" } else { "data, " };
    let text = shader.wgsl + &entry_point(data);
    let inputs = [&[0][..], &words(&all)];
    let on_gpu = gpu.compute_with_data(&text, &inputs, &shader.data, all.len(), 1);
    assert_eq!(differing(&on_cpu, &on_gpu), 0, "{name}");
}

#[test]
fn composed_fields_have_the_bits_of_the_cpu() {
    let Some(gpu) = Gpu::new() else { return };
    let noise = GradientNoise2::new(Seed(7)).with_period([Some(8), None]);
    let noise = noise.expect("a period");
    let hills = noise.fractal(4, -0.6, 2.0, FractalShape::Ridged);
    let hills = hills.expect("a sum");
    let worley = Worley2::new(Seed(3));
    let cracks = worley
        .combine(Combination::F2_MINUS_F1)
        .with_range([0.1, 0.9]);
    let cracks = cracks.expect("a range");
    let bands = WaveletNoise2::of_size([8, 6], Seed(5)).expect("a tile");
    let stones = worley.cell_values().frequency_per_axis([2.0, 0.75]);
    let joints = worley.edge_distances().rotate(0.3).offset([0.25, -7.0]);
    let bent = (&stones).warp((&hills, Constant(0.5)), 0.7);
    let ground = (&hills)
        .mul(&cracks)
        .add((&bands).frequency(3.0))
        .remap([-1.0, 2.0], [0.25, -0.5])
        .expect("ranges")
        .max(0.0)
        .min(&joints);
    let octaves = Fractal::new(vec![&bent; 3], 0.5, 2.5, FractalShape::Billow);
    let octaves = octaves.expect("a sum");
    let whole = (&ground).mix(&octaves, (&noise).sub(&cracks));
    let fields: [(&str, &dyn Field); 6] = [
        ("noise", &noise),
        ("hills", &hills),
        ("joints", &joints),
        ("ground", &ground),
        ("octaves", &octaves),
        ("whole", &whole),
    ];
    for (name, field) in fields {
        compare(&gpu, name, field);
    }
}

#[test]
fn fields_with_functions_have_no_shader() {
    let noise = GradientNoise2::new(Seed(7));
    let mapped = (&noise).map(f32::abs).add(1.0);
    let refused = field_to_wgsl(&mapped).expect_err("a function has no shader");
    let RecipeErrorKind::NotInShader { nodes } = refused.kind() else {
        panic!("{refused}");
    };
    assert_eq!(nodes[0].1, "a field of this type has no shader");
}
