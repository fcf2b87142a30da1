// Perlin's gradient noise in two dimensions, with the bits of `GradientNoise2` of the crate dapple-noise.

// The four corners of a cell, x varying fastest: components of their gradients, and of the vectors to the position
struct Corners2d {
    gradient_x: vec4<f32>,
    gradient_y: vec4<f32>,
    x: vec4<f32>,
    y: vec4<f32>,
}

fn corners_2d(noise: GradientNoise, at: Place2d, zero: u32) -> Corners2d {
    var place = at;
    if any(noise.offset.xy > vec2(0u)) { place = moved_2d(at, 1u, noise.offset.xy); }
    let parts = corner_parts(noise.keys.xy, noise.period.xy, place.cell);
    // One of eight gradients of length √2: the diagonals, then x, -x, y, -y
    let pick = corner_bits(parts.xzxz ^ parts.yyww) >> vec4(29u);
    let side = (pick << vec4(31u)) | vec4(0x3fb504f3u);
    let along_y = pick > vec4(5u);
    let x = select((pick << vec4(31u)) | vec4(0x3f800000u), select(side, vec4(0u), along_y), pick > vec4(3u));
    let diagonal_y = ((pick >> vec4(1u)) << vec4(31u)) | vec4(0x3f800000u);
    let y = select(diagonal_y, select(vec4(0u), side, along_y), pick > vec4(3u));
    let t = vec4(place.fraction, exact_sub(vec4(place.fraction, place.fraction), vec4(1.0), zero).xy);
    return Corners2d(bitcast<vec4<f32>>(x), bitcast<vec4<f32>>(y), t.xzxz, t.yyww);
}

// Value at a place
fn gradient_noise_2d(noise: GradientNoise, place: Place2d, zero: u32) -> f32 {
    let corners = corners_2d(noise, place, zero);
    let by = quintic_fade(vec4(corners.x.x, corners.y.x, 0.0, 0.0), zero);
    // Blend the left and the right corners along y: their slopes along x, and their values at x = 0
    let values = exact_add(exact(vec4(0.0), zero), exact_mul(corners.gradient_y, corners.y, zero), zero);
    let near = vec4(corners.gradient_x.xy, values.xy);
    let lines = blended(near, vec4(corners.gradient_x.zw, values.zw), by.y, zero);
    return between_lines(lines, corners.x.x, by.x, zero);
}
