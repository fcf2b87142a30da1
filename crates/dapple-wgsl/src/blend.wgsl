// Layers blended by weights, with the values of `blend` of the crate dapple-tile.

// Share of a layer: its weight divided by the sum of all weights
fn blend_share(weight: f32, sum: vec2<u32>) -> f32 { return double_to_float(double_div(double_from(weight), sum)); }

// Level of a layer with this share and height; a layer without a share is below all others
fn blend_level(share: f32, height: f32) -> vec2<u32> {
    if share == 0.0 { return vec2(0xfe37e43cu, 0u); }
    let part = double_from(share);
    let past = double_sub(double_div(vec2(0x3fd00000u, 0u), part), vec2(0x3ff00000u, 0u));
    return double_sub(double_add(double_from(height), part), double_max(past, vec2(0u)));
}

// Weight of a layer by its level below the top
fn blend_near(share: f32, level: vec2<u32>, top: vec2<u32>, depth: vec2<u32>) -> f32 {
    if share == 0.0 { return 0.0; }
    let near = double_sub(vec2(0x3ff00000u, 0u), double_div(double_sub(top, level), depth));
    return double_to_float(double_mul(double_from(share), double_max(near, vec2(0u))));
}

// Ramp from 1, where the mask is below the threshold, to 0, where it is above
fn blend_step(threshold: vec2<u32>, mask: f32, half_width: vec2<u32>) -> vec2<u32> {
    let one = vec2(0x3ff00000u, 0u);
    let half = vec2(0x3fe00000u, 0u);
    // Narrow the ramp near 0 and 1
    let width = double_min(double_min(half_width, threshold), double_sub(one, threshold));
    let above = double_sub(double_from(mask), threshold);
    if double_is_less(vec2(0u), width) {
        return double_unit(double_sub(half, double_div(double_mul(half, above), width)));
    }
    let is_below = double_is_less(above, vec2(0u)) || !double_is_less(threshold, one);
    return select(vec2(0u), one, is_below);
}

// Difference of the ramps at two thresholds
fn blend_between(up_to: vec2<u32>, below: vec2<u32>) -> f32 {
    return double_to_float(double_max(double_sub(up_to, below), vec2(0u)));
}

// Sums of layers, and the ranges of those that have a share
struct BlendSums { sums: array<vec2<u32>, 3>, low: vec3<f32>, high: vec3<f32> }

fn blend_start() -> BlendSums {
    return BlendSums(array(vec2(0u), vec2(0u), vec2(0u)), vec3(3.4028234663852886e38), vec3(-3.4028234663852886e38));
}

fn blend_add(before: BlendSums, share: f32, color: vec3<f32>) -> BlendSums {
    var sums = before;
    for (var i = 0u; i < 3u; i++) {
        sums.sums[i] = double_add(sums.sums[i], double_mul(double_from(share), double_from(color[i])));
    }
    let has_share = vec3(share > 0.0);
    sums.low = select(sums.low, select(sums.low, color, color < sums.low), has_share);
    sums.high = select(sums.high, select(sums.high, color, color > sums.high), has_share);
    return sums;
}

fn blend_color(sums: BlendSums, zero: u32) -> vec4<f32> {
    var color = vec4(0.0);
    for (var i = 0u; i < 3u; i++) {
        let sum = double_to_float(sums.sums[i]);
        color[i] = number_min(number_max(sum, sums.low[i], zero), sums.high[i], zero);
    }
    return color;
}
