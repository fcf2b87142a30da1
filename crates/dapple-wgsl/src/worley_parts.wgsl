// Parts that Worley's basis shares in all dimensions.

// The basis: the 24 words of `Worley::shader_words` of the crate dapple-worley. There are keys of two hashes and a period
// in cells (0 for none) along each axis, the distribution of the number of points in a cell, and the metric: 0 Euclidean,
// 1 Manhattan, 2 Chebyshev.
struct Worley {
    keys: array<vec4<u32>, 2>,
    period: vec4<u32>,
    thresholds: array<vec4<u32>, 2>,
    least: u32,
    jitter: u32,
    metric: u32,
}

// Number of points in the cell with the first hash word `word`
fn count_points(worley: Worley, word: u32) -> u32 {
    let draw = vec4(mix_bits(vec4(word)).x);
    let above = vec4<u32>(draw > worley.thresholds[0]) + vec4<u32>(draw > worley.thresholds[1]);
    return worley.least + above.x + above.y + above.z + above.w;
}

// Random words for the position of a point in its cell
fn point_words(words: vec2<u32>, index: u32) -> vec2<u32> {
    return mix_bits(vec4(words + vec2(0x9e3779b9u, 0xc2b2ae3du) * (index + 1u), 0u, 0u)).xy;
}

// Random number of a feature point in [0, 1), constant in its Voronoi cell
fn cell_value(id: vec2<u32>) -> f32 {
    return f32(id.x >> 8u) * (1.0 / 16777216.0);
}
