// Arithmetic of single numbers with the bits of the CPU. `exact` says what `zero` is for.
fn number(x: f32, zero: u32) -> f32 { return bitcast<f32>(bitcast<u32>(x) ^ zero); }
fn number_add(a: f32, b: f32, zero: u32) -> f32 { return number(a + b, zero); }
fn number_sub(a: f32, b: f32, zero: u32) -> f32 { return number(a - b, zero); }
fn number_mul(a: f32, b: f32, zero: u32) -> f32 { return number(a * b, zero); }

// The smaller and the larger number. Compilers turn a plain selection into `min` and `max`, which may return either zero.
fn number_min(a: f32, b: f32, zero: u32) -> f32 { return select(a, number(b, zero), b < a); }
fn number_max(a: f32, b: f32, zero: u32) -> f32 { return select(a, number(b, zero), b > a); }
fn number_clamp(x: f32, low: f32, high: f32, zero: u32) -> f32 {
    return number_min(number_max(x, low, zero), high, zero);
}

// `start + (end - start) * by`, with `by` clamped to 0 to 1
fn number_mix(start: f32, end: f32, by: f32, zero: u32) -> f32 {
    let part = number_clamp(by, 0.0, 1.0, zero);
    return number_add(start, number_mul(number_sub(end, start, zero), part, zero), zero);
}

// `3 t^2 - 2 t^3`
fn number_smooth(t: f32, zero: u32) -> f32 {
    return number_mul(number_mul(t, t, zero), number_sub(3.0, number_mul(2.0, t, zero), zero), zero);
}

// Quotient rounded to nearest, of normal numbers; WGSL allows an error of several units in the last place. A quotient
// below 2^-126 is 0.
fn number_div(a: f32, b: f32, zero: u32) -> f32 {
    let high = bitcast<vec2<u32>>(vec2(a, b));
    let exponents = vec2<i32>((high >> vec2(23u)) & vec2(0xffu));
    let sign = (high.x ^ high.y) & 0x80000000u;
    if exponents.x == 255 || exponents.y == 255 || exponents.y == 0 { return number(a / b, zero); }
    if exponents.x == 0 { return bitcast<f32>(sign); }
    // Mantissas of 24 bits: the quotient is q / 2^k, where q has 24 bits, too
    let parts = (high & vec2(0x7fffffu)) | vec2(0x800000u);
    let k = select(23u, 24u, parts.x < parts.y);
    let near = f32(parts.x) / f32(parts.y) * f32(1u << k);
    var q = u32(near);
    // The remainder is exact modulo 2^32 as long as q is wrong by less than 64
    let divisor = i32(parts.y);
    var rest = bitcast<i32>((parts.x << k) - q * parts.y);
    for (var steps = 0u; steps < 64u; steps++) {
        if 2 * rest > divisor {
            rest -= divisor;
            q++;
        } else if 2 * rest < -divisor {
            rest += divisor;
            q--;
        } else {
            break;
        }
    }
    let exponent = exponents.x - exponents.y + 150 - i32(k);
    if exponent <= 0 { return bitcast<f32>(sign); }
    if exponent >= 255 { return bitcast<f32>(sign | 0x7f800000u); }
    return bitcast<f32>(sign | ((u32(exponent) << 23u) + q - 0x800000u));
}
