// Gradient noise in two dimensions with its derivatives, as `GradientNoise2::sample_with_gradient` of the crate
// dapple-noise computes them.

// Sum of the corners, in their order
fn sum_of_corners(parts: vec4<f32>, zero: u32) -> f32 {
    var sum = exact_add(exact(vec4(0.0), zero), parts.xxxx, zero);
    sum = exact_add(sum, parts.yyyy, zero);
    sum = exact_add(sum, parts.zzzz, zero);
    return exact_add(sum, parts.wwww, zero).x;
}

// Value, and derivatives along x and y, per cell
fn gradient_noise_2d_with_gradient(noise: GradientNoise, place: Place2d, zero: u32) -> vec3<f32> {
    let corners = corners_2d(noise, place, zero);
    let t = vec4(corners.x.x, corners.y.x, 0.0, 0.0);
    let past = vec4(corners.x.y, corners.y.z, 0.0, 0.0);
    // Blend weights of both sides, and their derivatives `30 t^2 (t - 1)^2`
    let far = quintic_fade(t, zero);
    let near = exact_sub(vec4(1.0), far, zero);
    let square = exact_mul(exact_mul(vec4(30.0), t, zero), t, zero);
    let slope = exact_mul(exact_mul(square, past, zero), past, zero);
    let weight_x = vec4(near.x, far.x, near.x, far.x);
    let weight_y = vec4(near.yy, far.yy);
    let slope_x = vec4(-slope.x, slope.x, -slope.x, slope.x);
    let slope_y = vec4(-slope.yy, slope.yy);
    // Product rule: along an axis, the weight of a corner changes, and so does its linear function
    let along_x = exact_mul(corners.gradient_x, corners.x, zero);
    let heights = exact_add(along_x, exact_mul(corners.gradient_y, corners.y, zero), zero);
    let linear_x = exact_mul(weight_x, corners.gradient_x, zero);
    let linear_y = exact_mul(weight_y, corners.gradient_y, zero);
    let x = exact_mul(weight_y, exact_add(exact_mul(slope_x, heights, zero), linear_x, zero), zero);
    let y = exact_mul(weight_x, exact_add(exact_mul(slope_y, heights, zero), linear_y, zero), zero);
    return vec3(gradient_noise_2d(noise, place, zero), sum_of_corners(x, zero), sum_of_corners(y, zero));
}
