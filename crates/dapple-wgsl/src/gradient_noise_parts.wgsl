// Parts that gradient noise of all dimensions shares.

// Noise, or an octave of a fractal sum: the 16 words of `GradientNoise::shader_words` of the crate dapple-noise.
// Each axis has a key of the hash, a period in cells (0 for none), and an offset in units of 2^-24 cells.
struct GradientNoise {
    keys: vec4<u32>,
    period: vec4<u32>,
    offset: vec4<u32>,
    weight: f32,
}

// Hash parts of the corners on both sides of a cell, along two axes: near, near, far, far
fn corner_parts(keys: vec2<u32>, period: vec2<u32>, cell: vec2<i32>) -> vec4<u32> {
    let near = wrapped(cell, period);
    let far = select(near + 1u, vec2(0u), near + 1u == period);
    return mix_bits(vec4(near, far) ^ keys.xyxy);
}

// Perlin's quintic fade function, `t * t * t * (t * (t * 6 - 15) + 10)`
fn quintic_fade(t: vec4<f32>, zero: u32) -> vec4<f32> {
    let inner = exact_sub(exact_mul(t, vec4(6.0), zero), vec4(15.0), zero);
    let outer = exact_add(exact_mul(t, inner, zero), vec4(10.0), zero);
    return exact_mul(exact_mul(exact_mul(t, t, zero), t, zero), outer, zero);
}

// `near + by * (far - near)`
fn blended(near: vec4<f32>, far: vec4<f32>, by: f32, zero: u32) -> vec4<f32> {
    return exact_add(near, exact_mul(vec4(by), exact_sub(far, near, zero), zero), zero);
}

// Value between the lines of the left and the right corners, given as (left slope, right slope, left value at x = 0,
// right value at x = 1)
fn between_lines(lines: vec4<f32>, x: f32, by: f32, zero: u32) -> f32 {
    let ends = exact_add(exact_mul(lines, vec4(x, exact_sub(vec4(x), vec4(1.0), zero).xxx), zero), lines.zwzw, zero);
    return blended(ends.xxxx, ends.yyyy, by, zero).x;
}
