// Mixtures of colors in Oklab (Björn Ottosson, 2020), in numbers of 32 bits. The CPU computes them with 64 bits; linear
// components between 0 and 1 differ by less than 4e-6.

// Linear color between two colors; `part` is 0 at `start` and 1 at `end`. These are the cube roots of the cone responses
// l, m and s, of which the components of Oklab are sums, so mixtures of both are equal.
fn oklab_mix(start: vec4<f32>, end: vec4<f32>, part: f32, zero: u32) -> vec4<f32> {
    let rest = exact_sub(vec4(1.0), vec4(part), zero);
    let roots = exact_add(exact_mul(start, rest, zero), exact_mul(end, vec4(part), zero), zero);
    let cones = exact_mul(exact_mul(roots, roots, zero), roots, zero);
    let l = exact_mul(vec4(4.0767416621, -1.2684380046, -0.0041960863, 0.0), cones.xxxx, zero);
    let m = exact_mul(vec4(-3.3077115913, 2.6097574011, -0.7034186147, 0.0), cones.yyyy, zero);
    let s = exact_mul(vec4(0.2309699292, -0.3413193965, 1.7076147010, 0.0), cones.zzzz, zero);
    return exact_add(exact_add(l, m, zero), s, zero);
}
