// Gradient noise in three dimensions with its derivatives, as `GradientNoise3::sample_with_gradient` of the crate
// dapple-noise computes them.

// Parts of the four corners with the same x in the derivatives along each axis; y varies fastest
struct Slopes3d { x: vec4<f32>, y: vec4<f32>, z: vec4<f32> }

// `at` has the components of the vectors from the corners to the position, `weight` the blend weights of the corners,
// `slope` the derivatives of these weights
fn slopes_3d(parts: vec4<u32>, at: Slopes3d, weight: Slopes3d, slope: Slopes3d, zero: u32) -> Slopes3d {
    let pick = ((corner_bits(parts) >> vec4(8u)) * 12u) >> vec4(24u);
    let along = pick >> vec4(2u);
    let g = Slopes3d(
        edge_component(pick, along, 0u), edge_component(pick, along, 1u), edge_component(pick, along, 2u));
    let plane = exact_add(exact_mul(g.x, at.x, zero), exact_mul(g.y, at.y, zero), zero);
    let heights = exact_add(plane, exact_mul(g.z, at.z, zero), zero);
    // Product rule: along an axis, the weight of a corner changes, and so does its linear function
    let x = exact_add(exact_mul(slope.x, heights, zero), exact_mul(weight.x, g.x, zero), zero);
    let y = exact_add(exact_mul(slope.y, heights, zero), exact_mul(weight.y, g.y, zero), zero);
    let z = exact_add(exact_mul(slope.z, heights, zero), exact_mul(weight.z, g.z, zero), zero);
    return Slopes3d(
        exact_mul(exact_mul(weight.y, weight.z, zero), x, zero),
        exact_mul(exact_mul(weight.x, weight.z, zero), y, zero),
        exact_mul(exact_mul(weight.x, weight.y, zero), z, zero));
}

// Value, and derivatives along x, y and z, per cell
fn gradient_noise_3d_with_gradient(noise: GradientNoise, at: Place3d, zero: u32) -> vec4<f32> {
    var place = at;
    if any(noise.offset.xyz > vec3(0u)) { place = moved_3d(at, 1u, noise.offset.xyz); }
    let xy = corner_parts(noise.keys.xy, noise.period.xy, place.cell.xy);
    let z = corner_parts(noise.keys.zz, noise.period.zz, place.cell.zz);
    let rows = xy.ywyw ^ z.xxzz;
    // Blend weights of both sides, and their derivatives `30 t^2 (t - 1)^2`
    let t = vec4(place.fraction, 0.0);
    let past = exact_sub(t, vec4(1.0), zero);
    let far = quintic_fade(t, zero);
    let near = exact_sub(vec4(1.0), far, zero);
    let square = exact_mul(exact_mul(vec4(30.0), t, zero), t, zero);
    let slope = exact_mul(exact_mul(square, past, zero), past, zero);
    let at_y = vec4(t.y, past.y, t.y, past.y);
    let weight_y = vec4(near.y, far.y, near.y, far.y);
    let slope_y = vec4(-slope.y, slope.y, -slope.y, slope.y);
    let at_z = vec4(t.zz, past.zz);
    let weight_z = vec4(near.zz, far.zz);
    let slope_z = vec4(-slope.zz, slope.zz);
    let left = slopes_3d(rows ^ xy.xxxx, Slopes3d(t.xxxx, at_y, at_z), Slopes3d(near.xxxx, weight_y, weight_z),
        Slopes3d(-slope.xxxx, slope_y, slope_z), zero);
    let right = slopes_3d(rows ^ xy.zzzz, Slopes3d(past.xxxx, at_y, at_z), Slopes3d(far.xxxx, weight_y, weight_z),
        Slopes3d(slope.xxxx, slope_y, slope_z), zero);
    // Sum all corners, x varying fastest
    var sum = exact(vec4(0.0), zero);
    for (var i = 0u; i < 4u; i++) {
        sum = exact_add(sum, vec4(0.0, left.x[i], left.y[i], left.z[i]), zero);
        sum = exact_add(sum, vec4(0.0, right.x[i], right.y[i], right.z[i]), zero);
    }
    return vec4(gradient_noise_3d(noise, at, zero), sum.yzw);
}
