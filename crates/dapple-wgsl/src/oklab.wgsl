// Mixtures of colors in Oklab (Björn Ottosson, 2020). Lightness, a and b are numbers of 64 bits, as on the CPU.

// Product of a row of a matrix and a color
fn oklab_product(row: array<vec2<u32>, 3>, color: array<vec2<u32>, 3>) -> vec2<u32> {
    let first = double_add(double_mul(row[0], color[0]), double_mul(row[1], color[1]));
    return double_add(first, double_mul(row[2], color[2]));
}

// Linear color between two colors in Oklab; `part` is 0 at `start` and 1 at `end`
fn oklab_mix(start: array<vec2<u32>, 3>, end: array<vec2<u32>, 3>, part: f32) -> vec4<f32> {
    let one = vec2(0x3ff00000u, 0u);
    let by = double_from(part);
    let rest = double_sub(one, by);
    var first = start;
    var last = end;
    var color: array<vec2<u32>, 3>;
    for (var i = 0u; i < 3u; i++) {
        color[i] = double_add(double_mul(first[i], rest), double_mul(last[i], by));
    }
    // Cube roots of the cone responses l, m and s, and their cubes
    var cones = array(
        // 1, 0.3963377774, 0.2158037573
        oklab_product(array(one, vec2(0x3fd95d99u, 0x20068c8au), vec2(0x3fcb9f75u, 0x1ffa8cc8u)), color),
        // 1, -0.1055613458, -0.0638541728
        oklab_product(array(one, vec2(0xbfbb0611u, 0x7feec881u), vec2(0xbfb058bfu, 0x3fe39e34u)), color),
        // 1, -0.0894841775, -1.2914855480
        oklab_product(array(one, vec2(0xbfb6e86fu, 0x5fdf38b5u), vec2(0xbff4a9ecu, 0xbffeaa8du)), color));
    for (var i = 0u; i < 3u; i++) { cones[i] = double_mul(double_mul(cones[i], cones[i]), cones[i]); }
    // 4.0767416621, -3.3077115913, 0.2309699292
    let red = array(vec2(0x40104e95u, 0x5dc3d73au), vec2(0xc00a7631u, 0x7ea9de73u), vec2(0x3fcd906cu, 0x3222ffefu));
    // -1.2684380046, 2.6097574011, -0.3413193965
    let green = array(vec2(0xbff44b85u, 0xa62c2affu), vec2(0x4004e0c8u, 0x7d01bf65u), vec2(0xbfd5d82du, 0x4f5d4f2au));
    // -0.0041960863, -0.7034186147, 1.7076147010
    let blue = array(vec2(0xbf712feau, 0x56e00671u), vec2(0xbfe68267u, 0xc131178du), vec2(0x3ffb5263u, 0xcaef6bcdu));
    return vec4(
        double_to_float(oklab_product(red, cones)),
        double_to_float(oklab_product(green, cones)),
        double_to_float(oklab_product(blue, cones)),
        0.0);
}
