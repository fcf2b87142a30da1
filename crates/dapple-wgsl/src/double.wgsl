// Numbers of 64 bits, in which the CPU computes positions, as the upper and the lower word of their bits. Sums and
// products are rounded to nearest even, computed with `u32`. There are no infinite numbers, no NaN and no denormal
// numbers; results below 2^-1022 are 0.

// Product of two words: the upper and the lower word
fn wide_product(a: u32, b: u32) -> vec2<u32> {
    let low = (a & 0xffffu) * (b & 0xffffu);
    let first = (a & 0xffffu) * (b >> 16u) + (low >> 16u);
    let second = (a >> 16u) * (b & 0xffffu) + (first & 0xffffu);
    let high = (a >> 16u) * (b >> 16u) + (first >> 16u) + (second >> 16u);
    return vec2(high, (second << 16u) | (low & 0xffffu));
}

// A number from its sign, its exponent with bias, and its mantissa of 53 bits. `rest` is the fraction that follows the
// mantissa, in units of 2^-32.
fn double_of(sign: u32, exponent: i32, mantissa: vec2<u32>, rest: u32) -> vec2<u32> {
    if exponent <= 0 { return vec2(sign, 0u); }
    let up = u32(rest > 0x80000000u || (rest == 0x80000000u && (mantissa.y & 1u) == 1u));
    let low = mantissa.y + up;
    let high = (u32(exponent) << 20u) + mantissa.x - 0x100000u + u32(low < up);
    return vec2(sign | high, low);
}

fn double_from_int(x: i32) -> vec2<u32> {
    let size = u32(abs(x));
    if size == 0u { return vec2(0u); }
    let zeros = countLeadingZeros(size);
    let top = size << zeros;
    return double_of(u32(x) & 0x80000000u, 1054 - i32(zeros), vec2(top >> 11u, top << 21u), 0u);
}

fn double_from(x: f32) -> vec2<u32> {
    let bits = bitcast<u32>(x);
    let exponent = (bits >> 23u) & 0xffu;
    let mantissa = (bits & 0x7fffffu) | 0x800000u;
    if exponent == 0u { return vec2(bits & 0x80000000u, 0u); }
    return double_of(bits & 0x80000000u, i32(exponent) + 896, vec2(mantissa >> 3u, mantissa << 29u), 0u);
}

// The nearest number of 32 bits; 0 below 2^-126
fn double_to_float(x: vec2<u32>) -> f32 {
    let sign = x.x & 0x80000000u;
    let exponent = i32((x.x >> 20u) & 0x7ffu) - 896;
    if exponent <= 0 { return bitcast<f32>(sign); }
    if exponent >= 255 { return bitcast<f32>(sign | 0x7f800000u); }
    let bits = (u32(exponent) << 23u) | ((x.x & 0xfffffu) << 3u) | (x.y >> 29u);
    let rest = x.y << 3u;
    let up = u32(rest > 0x80000000u || (rest == 0x80000000u && (bits & 1u) == 1u));
    return bitcast<f32>(sign | (bits + up));
}

fn double_negated(x: vec2<u32>) -> vec2<u32> { return vec2(x.x ^ 0x80000000u, x.y); }

fn double_mul(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let sign = (a.x ^ b.x) & 0x80000000u;
    let exponents = (vec2(a.x, b.x) >> vec2(20u)) & vec2(0x7ffu);
    if exponents.x == 0u || exponents.y == 0u { return vec2(sign, 0u); }
    let high = (vec2(a.x, b.x) & vec2(0xfffffu)) | vec2(0x100000u);
    // Product of 106 bits, in four words
    let p = wide_product(a.y, b.y);
    let q = wide_product(a.y, high.y);
    let r = wide_product(high.x, b.y);
    let s = wide_product(high.x, high.y);
    let sum = q.y + r.y;
    let second = sum + p.x;
    let carry = u32(sum < q.y) + u32(second < sum);
    let third = q.x + r.x + carry;
    let upper = third + s.y;
    let top = s.x + u32(upper < third);
    // The first bit of the product is bit 8 or 9 of the top word
    let is_long = top >= 0x200u;
    let left = select(12u, 11u, is_long);
    let right = 32u - left;
    let mantissa = vec2((top << left) | (upper >> right), (upper << left) | (second >> right));
    let rest = (second << left) | (p.y >> right) | u32((p.y << left) != 0u);
    return double_of(sign, i32(exponents.x + exponents.y) - 1023 + i32(is_long), mantissa, rest);
}

fn double_add(first: vec2<u32>, second: vec2<u32>) -> vec2<u32> {
    // `a` is the larger one in size
    let sizes = vec2(first.x, second.x) & vec2(0x7fffffffu);
    let is_less = sizes.x < sizes.y || (sizes.x == sizes.y && first.y < second.y);
    let a = select(first, second, is_less);
    let b = select(second, first, is_less);
    let sign = a.x & 0x80000000u;
    let exponents = (vec2(a.x, b.x) >> vec2(20u)) & vec2(0x7ffu);
    if exponents.y == 0u { return select(a, vec2(a.x & b.x & 0x80000000u, 0u), exponents.x == 0u); }
    // Mantissas, followed by ten bits
    let high = (vec2(a.x, b.x) & vec2(0xfffffu)) | vec2(0x100000u);
    let large = vec2((high.x << 10u) | (a.y >> 22u), a.y << 10u);
    var small = vec2((high.y << 10u) | (b.y >> 22u), b.y << 10u);
    // Align the smaller number. Its last bit is set if any bit after it was set.
    let shift = exponents.x - exponents.y;
    if shift >= 64u {
        small = vec2(0u, 1u);
    } else {
        var lost = 0u;
        if shift >= 32u {
            lost = small.y;
            small = vec2(0u, small.x);
        }
        let right = shift & 31u;
        if right > 0u {
            lost |= small.y << (32u - right);
            small = vec2(small.x >> right, (small.y >> right) | (small.x << (32u - right)));
        }
        small.y |= u32(lost != 0u);
    }
    var sum: vec2<u32>;
    if ((a.x ^ b.x) >> 31u) == 0u {
        sum.y = large.y + small.y;
        sum.x = large.x + small.x + u32(sum.y < small.y);
    } else {
        sum.y = large.y - small.y;
        sum.x = large.x - small.x - u32(large.y < small.y);
        if all(sum == vec2(0u)) { return vec2(0u); }
    }
    // Move the first bit to the top
    var exponent = i32(exponents.x) + 1;
    if sum.x == 0u {
        sum = vec2(sum.y, 0u);
        exponent -= 32;
    }
    let zeros = countLeadingZeros(sum.x);
    exponent -= i32(zeros);
    if zeros > 0u {
        sum = vec2((sum.x << zeros) | (sum.y >> (32u - zeros)), sum.y << zeros);
    }
    return double_of(sign, exponent, vec2(sum.x >> 11u, (sum.x << 21u) | (sum.y >> 11u)), sum.y << 21u);
}

fn double_sub(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> { return double_add(a, double_negated(b)); }

// The largest integer that is not larger
fn double_floor(x: vec2<u32>) -> vec2<u32> {
    let exponent = i32((x.x >> 20u) & 0x7ffu) - 1023;
    if exponent >= 52 || all((x & vec2(0x7fffffffu, 0xffffffffu)) == vec2(0u)) { return x; }
    let is_negative = (x.x >> 31u) == 1u;
    if exponent < 0 { return select(vec2(0u), vec2(0xbff00000u, 0u), is_negative); }
    // Clear the bits after the point
    let n = u32(52 - exponent);
    let mask = select(vec2(0xffffffffu, 0xffffffffu << (n & 31u)), vec2(0xffffffffu << (n & 31u), 0u), n >= 32u);
    let whole = x & mask;
    if is_negative && any(whole != x) { return double_add(whole, vec2(0xbff00000u, 0u)); }
    return whole;
}

// An integer between -2^31 and 2^31
fn double_to_int(x: vec2<u32>) -> i32 {
    let exponent = i32((x.x >> 20u) & 0x7ffu) - 1023;
    if exponent < 0 { return 0; }
    let top = (((x.x & 0xfffffu) | 0x100000u) << 11u) | (x.y >> 21u);
    let size = i32(top >> (31u - min(u32(exponent), 31u)));
    return select(size, -size, (x.x >> 31u) == 1u);
}

fn double_abs(x: vec2<u32>) -> vec2<u32> { return vec2(x.x & 0x7fffffffu, x.y); }

// `a * x + b`
fn double_term(a: vec2<u32>, x: vec2<u32>, b: vec2<u32>) -> vec2<u32> { return double_add(b, double_mul(x, a)); }
