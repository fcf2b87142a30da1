// Angles of vectors with the bits of `atan2` of the crate libm, which is a translation of e_atan2.c and s_atan.c of FreeBSD:
//
// Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
// Developed at SunPro, a Sun Microsystems, Inc. business. Permission to use, copy, modify, and distribute this software
// is freely granted, provided that this notice is preserved.

// Arctangent of a number that is not negative
fn double_arctangent(size: vec2<u32>) -> vec2<u32> {
    if size.x < 0x3e400000u { return size; }
    let one = vec2(0x3ff00000u, 0x00000000u);
    var start = vec2(0u);
    var rest = vec2(0u);
    var above = size;
    var below = one;
    // Reduce the number to at most 7/16
    if size.x >= 0x40038000u {
        start = vec2(0x3ff921fbu, 0x54442d18u);
        rest = vec2(0x3c91a626u, 0x33145c07u);
        if size.x >= 0x44100000u { return start; }
        above = double_negated(one);
        below = size;
    } else if size.x >= 0x3ff30000u {
        start = vec2(0x3fef730bu, 0xd281f69bu);
        rest = vec2(0x3c700788u, 0x7af0cbbdu);
        above = double_sub(size, vec2(0x3ff80000u, 0x00000000u));
        below = double_add(one, double_mul(vec2(0x3ff80000u, 0x00000000u), size));
    } else if size.x >= 0x3fe60000u {
        start = vec2(0x3fe921fbu, 0x54442d18u);
        rest = vec2(0x3c81a626u, 0x33145c07u);
        above = double_sub(size, one);
        below = double_add(size, one);
    } else if size.x >= 0x3fdc0000u {
        start = vec2(0x3fddac67u, 0x0561bb4fu);
        rest = vec2(0x3c7a2b7fu, 0x222f65e2u);
        above = double_sub(double_add(size, size), one);
        below = double_add(vec2(0x40000000u, 0x00000000u), size);
    }
    let x = double_div(above, below);
    // Odd and even terms of the series
    let z = double_mul(x, x);
    let w = double_mul(z, z);
    var odd = double_term(vec2(0x3f90ad3au, 0xe322da11u), w, vec2(0x3fa97b4bu, 0x24760debu));
    odd = double_term(odd, w, vec2(0x3fb10d66u, 0xa0d03d51u));
    odd = double_term(odd, w, vec2(0x3fb745cdu, 0xc54c206eu));
    odd = double_term(odd, w, vec2(0x3fc24924u, 0x920083ffu));
    odd = double_mul(z, double_term(odd, w, vec2(0x3fd55555u, 0x5555550du)));
    var even = double_term(vec2(0xbfa2b444u, 0x2c6a6c2fu), w, vec2(0xbfadde2du, 0x52defd9au));
    even = double_term(even, w, vec2(0xbfb3b0f2u, 0xaf749a6du));
    even = double_term(even, w, vec2(0xbfbc71c6u, 0xfe231671u));
    even = double_mul(w, double_term(even, w, vec2(0xbfc99999u, 0x9998ebc4u)));
    let series = double_mul(x, double_add(odd, even));
    if size.x < 0x3fdc0000u { return double_sub(x, series); }
    return double_sub(start, double_sub(double_sub(series, rest), x));
}

// Angle of a vector in radians, from -π to π
fn double_angle(y: vec2<u32>, x: vec2<u32>) -> vec2<u32> {
    let pi = vec2(0x400921fbu, 0x54442d18u);
    let y_size = y.x & 0x7fffffffu;
    let x_size = x.x & 0x7fffffffu;
    let sign = y.x & 0x80000000u;
    let is_left = x.x >= 0x80000000u;
    if (y_size | y.y) == 0u { return select(y, vec2(pi.x | sign, pi.y), is_left); }
    if (x_size | x.y) == 0u || x_size + 0x4000000u < y_size { return vec2(vec2(0x3ff921fbu, 0x54442d18u).x | sign, vec2(0x3ff921fbu, 0x54442d18u).y); }
    var angle = vec2(0u);
    if !is_left || y_size + 0x4000000u >= x_size { angle = double_arctangent(double_abs(double_div(y, x))); }
    if is_left { angle = double_sub(pi, double_sub(angle, vec2(0x3ca1a626u, 0x33145c07u))); }
    return vec2(angle.x | sign, angle.y);
}
