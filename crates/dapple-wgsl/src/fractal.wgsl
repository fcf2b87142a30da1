// Fractal sums of octaves, `sum of weight * shape(value)`, with the bits of `Fractal` of the crate dapple-raster.

// The sum with one more octave; the first sum is 0
fn add_octave(sum: f32, weight: f32, value: f32, zero: u32) -> f32 {
    return exact_add(exact(vec4(sum), zero), exact_mul(vec4(weight), vec4(value), zero), zero).x;
}

// Shape of the octaves of a ridged sum; the shape of a billowed sum is `abs`
fn ridge(value: f32, zero: u32) -> f32 {
    return exact_sub(vec4(1.0), vec4(abs(value)), zero).x;
}
