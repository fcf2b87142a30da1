// Sines with the bits of `sin` of the crate libm, which is a translation of s_sin.c, k_sin.c, k_cos.c and e_rem_pio2.c of
// FreeBSD:
//
// Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
// Developed at SunPro, a Sun Microsystems, Inc. business. Permission to use, copy, modify, and distribute this software
// is freely granted, provided that this notice is preserved.

// Sine of an angle `x + y` from -π/4 to π/4; `y` is the part that `x` has no bits for, if `has_part` is set
fn near_sine(x: vec2<u32>, y: vec2<u32>, has_part: bool) -> vec2<u32> {
    let z = double_mul(x, x);
    let w = double_mul(z, z);
    let low = double_term(double_term(vec2(0x3ec71de3u, 0x57b1fe7du), z, vec2(0xbf2a01a0u, 0x19c161d5u)), z, vec2(0x3f811111u, 0x1110f8a6u));
    let high = double_term(vec2(0x3de5d93au, 0x5acfd57cu), z, vec2(0xbe5ae5e6u, 0x8a2b9cebu));
    let r = double_add(low, double_mul(double_mul(z, w), high));
    let v = double_mul(z, x);
    let first = vec2(0xbfc55555u, 0x55555549u);
    if !has_part { return double_add(x, double_mul(v, double_add(first, double_mul(z, r)))); }
    let half = double_sub(double_mul(vec2(0x3fe00000u, 0u), y), double_mul(v, r));
    return double_sub(x, double_sub(double_sub(double_mul(z, half), y), double_mul(v, first)));
}

// Cosine of an angle `x + y` from -π/4 to π/4
fn near_cosine(x: vec2<u32>, y: vec2<u32>) -> vec2<u32> {
    let z = double_mul(x, x);
    let w = double_mul(z, z);
    let low = double_mul(z, double_term(double_term(vec2(0x3efa01a0u, 0x19cb1590u), z, vec2(0xbf56c16cu, 0x16c15177u)), z, vec2(0x3fa55555u, 0x5555554cu)));
    let high = double_term(double_term(vec2(0xbda8fae9u, 0xbe8838d4u), z, vec2(0x3e21ee9eu, 0xbdb4b1c4u)), z, vec2(0xbe927e4fu, 0x809c52adu));
    let r = double_add(low, double_mul(double_mul(w, w), high));
    let half = double_mul(vec2(0x3fe00000u, 0u), z);
    let one = vec2(0x3ff00000u, 0u);
    let rest = double_sub(one, half);
    let lost = double_sub(double_sub(one, rest), half);
    return double_add(rest, double_add(lost, double_sub(double_mul(z, r), double_mul(x, y))));
}

// Sine of an angle from 0 to 2π
fn double_sine(x: vec2<u32>) -> vec2<u32> {
    if x.x < 0x3e500000u { return x; }
    if x.x <= 0x3fe921fbu { return near_sine(x, vec2(0u), false); }
    // Number of right angles
    var turns = select(4u, 3u, x.x <= 0x4015fdbcu);
    turns = select(turns, 2u, x.x <= 0x400f6a7au);
    turns = select(turns, 1u, x.x <= 0x4002d97cu);
    var n = double_from_int(i32(turns));
    let is_multiple = ((x.x & 0xfffffu) == 0x921fbu) || x.x == 0x4012d97cu;
    if is_multiple {
        let shift = vec2(0x43380000u, 0x00000000u);
        n = double_sub(double_add(double_mul(x, vec2(0x3fe45f30u, 0x6dc9c883u)), shift), shift);
        turns = u32(double_to_int(n));
    }
    var rest = double_sub(x, double_mul(n, vec2(0x3ff921fbu, 0x54400000u)));
    var lost = double_mul(n, vec2(0x3dd0b461u, 0x1a626331u));
    var near = double_sub(rest, lost);
    // More digits of π near a multiple of a right angle
    if is_multiple && i32(x.x >> 20u) - i32((near.x >> 20u) & 0x7ffu) > 16 {
        let before = rest;
        let part = double_mul(n, vec2(0x3dd0b461u, 0x1a600000u));
        rest = double_sub(before, part);
        lost = double_sub(double_mul(n, vec2(0x3ba3198au, 0x2e037073u)), double_sub(double_sub(before, rest), part));
        near = double_sub(rest, lost);
        if i32(x.x >> 20u) - i32((near.x >> 20u) & 0x7ffu) > 49 {
            let last = rest;
            let least = double_mul(n, vec2(0x3ba3198au, 0x2e000000u));
            rest = double_sub(last, least);
            lost = double_sub(double_mul(n, vec2(0x397b839au, 0x252049c1u)), double_sub(double_sub(last, rest), least));
            near = double_sub(rest, lost);
        }
    }
    let far = double_sub(double_sub(rest, near), lost);
    if (turns & 1u) == 1u {
        let cosine = near_cosine(near, far);
        return vec2(cosine.x ^ ((turns & 2u) << 30u), cosine.y);
    }
    let sine = near_sine(near, far, true);
    return vec2(sine.x ^ ((turns & 2u) << 30u), sine.y);
}
