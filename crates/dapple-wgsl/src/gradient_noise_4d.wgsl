// Perlin's gradient noise in four dimensions, with the bits of `GradientNoise4` of the crate dapple-noise.

// The four corners with the same x and w, y varying fastest: their slopes along x and their values at x = 0, blended
// along y. `y`, `z` and `w` are components of the vectors from the corners to the position.
fn corners_4d(parts: vec4<u32>, y: vec4<f32>, z: vec4<f32>, w: f32, by: f32, zero: u32) -> vec4<f32> {
    let pick = corner_bits(parts) >> vec4(27u);
    let along = pick >> vec4(3u);
    let slopes = edge_component(pick, along, 0u);
    let value_y = exact_add(exact(vec4(0.0), zero), exact_mul(edge_component(pick, along, 1u), y, zero), zero);
    let value_z = exact_add(value_y, exact_mul(edge_component(pick, along, 2u), z, zero), zero);
    let values = exact_add(value_z, exact_mul(edge_component(pick, along, 3u), vec4(w), zero), zero);
    return blended(vec4(slopes.xz, values.xz), vec4(slopes.yw, values.yw), by, zero);
}

// Value at a place
fn gradient_noise_4d(noise: GradientNoise, at: Place4d, zero: u32) -> f32 {
    var place = at;
    if any(noise.offset > vec4(0u)) { place = moved_4d(at, 1u, noise.offset); }
    let xy = corner_parts(noise.keys.xy, noise.period.xy, place.cell.xy);
    let zw = corner_parts(noise.keys.zw, noise.period.zw, place.cell.zw);
    let t = place.fraction;
    let by = quintic_fade(t, zero);
    let past = exact_sub(t, vec4(1.0), zero);
    let y = vec4(t.y, past.y, t.y, past.y);
    let z = vec4(t.zz, past.zz);
    var lines: array<vec4<f32>, 2>;
    for (var side = 0u; side < 2u; side++) {
        let rows = xy.ywyw ^ zw.xxzz ^ vec4(select(zw.y, zw.w, side > 0u));
        let w = select(t.w, past.w, side > 0u);
        let left = corners_4d(rows ^ xy.xxxx, y, z, w, by.y, zero);
        let right = corners_4d(rows ^ xy.zzzz, y, z, w, by.y, zero);
        let near = vec4(left.x, right.x, left.z, right.z);
        lines[side] = blended(near, vec4(left.y, right.y, left.w, right.w), by.z, zero);
    }
    return between_lines(blended(lines[0], lines[1], by.w, zero), t.x, by.x, zero);
}
