// Powers with the bits of `powf` of the crate libm, which is a translation of e_powf.c of FreeBSD:
//
// Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
// Developed at SunPro, a Sun Microsystems, Inc. business. Permission to use, copy, modify, and distribute this software
// is freely granted, provided that this notice is preserved.

// The upper 12 bits of a mantissa
fn power_high(x: f32) -> f32 { return bitcast<f32>(bitcast<u32>(x) & 0xfffff000u); }

// `a * x + b`
fn power_term(a: f32, x: f32, b: f32, zero: u32) -> f32 { return number_add(number_mul(a, x, zero), b, zero); }

// Power of a number that is not negative, with an exponent above 0 and below 2^27, but not ½, 1 and 2
fn number_power(base: f32, exponent: f32, zero: u32) -> f32 {
    var bits = bitcast<u32>(base) & 0x7fffffffu;
    let is_odd = exponent == floor(exponent) && exponent * 0.5 != floor(exponent * 0.5);
    if bits == 0u { return select(0.0, base, is_odd); }
    if bits == 0x3f800000u || bits >= 0x7f800000u { return base; }
    // Mantissa from 1 to 2, or from √3/2 to 1 near a power of two
    var n = 0;
    if bits < 0x800000u {
        let shift = countLeadingZeros(bits) - 8u;
        bits <<= shift;
        n = -i32(shift);
    }
    n += i32(bits >> 23u) - 127;
    let part = bits & 0x7fffffu;
    var ix = part | 0x3f800000u;
    let is_middle = part > 0x1cc471u && part < 0x5db3d7u;
    if part >= 0x5db3d7u {
        n += 1;
        ix -= 0x800000u;
    }
    let ax = bitcast<f32>(ix);
    let center = select(1.0, 1.5, is_middle);
    // s = (x - center) / (x + center)
    let above = number_sub(ax, center, zero);
    let inverse = number_div(1.0, number_add(ax, center, zero), zero);
    let s = number_mul(above, inverse, zero);
    let s_h = power_high(s);
    let sum_bits = (((ix >> 1u) & 0xfffff000u) | 0x20000000u) + 0x400000u + select(0u, 0x200000u, is_middle);
    let sum_h = bitcast<f32>(sum_bits);
    let sum_l = number_sub(ax, number_sub(sum_h, center, zero), zero);
    let rest = number_sub(above, number_mul(s_h, sum_h, zero), zero);
    let s_l = number_mul(inverse, number_sub(rest, number_mul(s_h, sum_l, zero), zero), zero);
    // Logarithm of the mantissa to base 2, as t_1 + t_2 with the exponent
    let s_2 = number_mul(s, s, zero);
    var r = power_term(s_2, 2.0697501302e-01, 2.3066075146e-01, zero);
    r = power_term(s_2, r, 2.7272811532e-01, zero);
    r = power_term(s_2, r, 3.3333334327e-01, zero);
    r = power_term(s_2, r, 4.2857143283e-01, zero);
    r = power_term(s_2, r, 6.0000002384e-01, zero);
    r = number_mul(number_mul(s_2, s_2, zero), r, zero);
    r = number_add(r, number_mul(s_l, number_add(s_h, s, zero), zero), zero);
    let square = number_mul(s_h, s_h, zero);
    let t_h = power_high(number_add(number_add(3.0, square, zero), r, zero));
    let t_l = number_sub(r, number_sub(number_sub(t_h, 3.0, zero), square, zero), zero);
    let u = number_mul(s_h, t_h, zero);
    let v = number_add(number_mul(s_l, t_h, zero), number_mul(t_l, s, zero), zero);
    let log_h = power_high(number_add(u, v, zero));
    let log_l = number_sub(v, number_sub(log_h, u, zero), zero);
    let z_h = number_mul(9.6191406250e-01, log_h, zero);
    let z_parts = number_add(number_mul(-1.1736857402e-04, log_h, zero), number_mul(log_l, 9.6179670095e-01, zero), zero);
    let z_l = number_add(z_parts, number(select(0.0, 1.56322085e-06, is_middle), zero), zero);
    let middle = number(select(0.0, 5.84960938e-01, is_middle), zero);
    let whole = f32(n);
    let t_1 = power_high(number_add(number_add(number_add(z_h, z_l, zero), middle, zero), whole, zero));
    let t_2 = number_sub(z_l, number_sub(number_sub(number_sub(t_1, whole, zero), middle, zero), z_h, zero), zero);
    // The exponent times the logarithm
    let y_h = power_high(exponent);
    let p_l = number_add(
        number_mul(number_sub(exponent, y_h, zero), t_1, zero), number_mul(exponent, t_2, zero), zero);
    var p_h = number_mul(y_h, t_1, zero);
    var z = number_add(p_l, p_h, zero);
    let bits_z = bitcast<i32>(z);
    if bits_z > 0x43000000 { return bitcast<f32>(0x7f800000u); }
    if bits_z == 0x43000000 {
        if number_add(p_l, 4.2995665694e-08, zero) > number_sub(z, p_h, zero) { return bitcast<f32>(0x7f800000u); }
    } else if (bits_z & 0x7fffffff) > 0x43160000 {
        return 0.0;
    } else if bitcast<u32>(bits_z) == 0xc3160000u && p_l <= number_sub(z, p_h, zero) {
        return 0.0;
    }
    // 2 to this power
    n = 0;
    if (bits_z & 0x7fffffff) > 0x3f000000 {
        let k = u32(((bits_z & 0x7fffffff) >> 23u) - 126);
        let near = bits_z + (0x800000 >> k);
        let digits = u32(((near & 0x7fffffff) >> 23u) - 127);
        let mask = select(~(0x7fffffu >> digits), 0xffffffffu, digits > 23u);
        n = ((near & 0x7fffff) | 0x800000) >> (23u - digits);
        if bits_z < 0 { n = -n; }
        p_h = number_sub(p_h, bitcast<f32>(bitcast<u32>(near) & mask), zero);
    }
    let t = bitcast<f32>(bitcast<u32>(number_add(p_l, p_h, zero)) & 0xffff8000u);
    let e_h = number_mul(t, 6.93145752e-01, zero);
    let lost = number_sub(p_l, number_sub(t, p_h, zero), zero);
    let e_l = number_add(number_mul(lost, 6.9314718246e-01, zero), number_mul(t, 1.42860654e-06, zero), zero);
    z = number_add(e_h, e_l, zero);
    let w = number_sub(e_l, number_sub(z, e_h, zero), zero);
    let z_2 = number_mul(z, z, zero);
    var q = power_term(z_2, 4.1381369442e-08, -1.6533901999e-06, zero);
    q = power_term(z_2, q, 6.6137559770e-05, zero);
    q = power_term(z_2, q, -2.7777778450e-03, zero);
    q = power_term(z_2, q, 1.6666667163e-01, zero);
    q = number_sub(z, number_mul(z_2, q, zero), zero);
    let ratio = number_div(number_mul(z, q, zero), number_sub(q, 2.0, zero), zero);
    r = number_sub(ratio, number_add(w, number_mul(z, w, zero), zero), zero);
    z = number_sub(1.0, number_sub(r, z, zero), zero);
    // A power below 2^-126 is 0
    let result = bitcast<i32>(z) + (n << 23u);
    return bitcast<f32>(select(0, result, (result >> 23u) > 0));
}
