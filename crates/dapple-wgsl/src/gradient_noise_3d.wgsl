// Perlin's gradient noise in three dimensions, with the bits of `GradientNoise3` of the crate dapple-noise.

// The four corners with the same x, y varying fastest: their slopes along x and their values at x = 0, blended along y.
// `y` and `z` are components of the vectors from the corners to the position.
fn corners_3d(parts: vec4<u32>, y: vec4<f32>, z: vec4<f32>, by: f32, zero: u32) -> vec4<f32> {
    let pick = ((corner_bits(parts) >> vec4(8u)) * 12u) >> vec4(24u);
    let along = pick >> vec4(2u);
    let slopes = edge_component(pick, along, 0u);
    let value_y = exact_add(exact(vec4(0.0), zero), exact_mul(edge_component(pick, along, 1u), y, zero), zero);
    let values = exact_add(value_y, exact_mul(edge_component(pick, along, 2u), z, zero), zero);
    return blended(vec4(slopes.xz, values.xz), vec4(slopes.yw, values.yw), by, zero);
}

// Value at a place
fn gradient_noise_3d(noise: GradientNoise, at: Place3d, zero: u32) -> f32 {
    var place = at;
    if any(noise.offset.xyz > vec3(0u)) { place = moved_3d(at, 1u, noise.offset.xyz); }
    let xy = corner_parts(noise.keys.xy, noise.period.xy, place.cell.xy);
    let z = corner_parts(noise.keys.zz, noise.period.zz, place.cell.zz);
    let t = vec4(place.fraction, 0.0);
    let by = quintic_fade(t, zero);
    let past = exact_sub(t, vec4(1.0), zero);
    let rows = xy.ywyw ^ z.xxzz;
    let left = corners_3d(rows ^ xy.xxxx, vec4(t.y, past.y, t.y, past.y), vec4(t.zz, past.zz), by.y, zero);
    let right = corners_3d(rows ^ xy.zzzz, vec4(t.y, past.y, t.y, past.y), vec4(t.zz, past.zz), by.y, zero);
    // Blend along z, then interpolate along x
    let near = vec4(left.x, right.x, left.z, right.z);
    let lines = blended(near, vec4(left.y, right.y, left.w, right.w), by.z, zero);
    return between_lines(lines, t.x, by.x, zero);
}
