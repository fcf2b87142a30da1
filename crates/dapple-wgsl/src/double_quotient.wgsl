// Quotients, square roots and comparisons of numbers of 64 bits, rounded as on the CPU. They are computed bit by bit.

// Difference of integers of 64 bits, as upper and lower words
fn wide_difference(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2(a.x - b.x - u32(a.y < b.y), a.y - b.y);
}

fn wide_is_less(a: vec2<u32>, b: vec2<u32>) -> bool { return a.x < b.x || (a.x == b.x && a.y < b.y); }

// The exponent with bias, and the mantissa of 53 bits
fn double_exponent(x: vec2<u32>) -> i32 { return i32((x.x >> 20u) & 0x7ffu); }
fn double_mantissa(x: vec2<u32>) -> vec2<u32> { return vec2((x.x & 0xfffffu) | 0x100000u, x.y); }

// Quotient of normal numbers; the first may be 0
fn double_div(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let sign = (a.x ^ b.x) & 0x80000000u;
    if double_exponent(a) == 0 { return vec2(sign, 0u); }
    var exponent = double_exponent(a) - double_exponent(b) + 1023;
    let divisor = double_mantissa(b);
    var rest = double_mantissa(a);
    if wide_is_less(rest, divisor) {
        rest = vec2((rest.x << 1u) | (rest.y >> 31u), rest.y << 1u);
        exponent -= 1;
    }
    var quotient = vec2(0u);
    for (var bit = 0u; bit < 53u; bit++) {
        let is_one = !wide_is_less(rest, divisor);
        quotient = vec2((quotient.x << 1u) | (quotient.y >> 31u), (quotient.y << 1u) | u32(is_one));
        if is_one { rest = wide_difference(rest, divisor); }
        rest = vec2((rest.x << 1u) | (rest.y >> 31u), rest.y << 1u);
    }
    // A quotient of 53 bits is never halfway between two numbers
    return double_of(sign, exponent, quotient, select(0u, 0xffffffffu, wide_is_less(divisor, rest)));
}

// Square root of 0 or of a positive number
fn double_root(x: vec2<u32>) -> vec2<u32> {
    let exponent = double_exponent(x);
    if exponent == 0 { return vec2(0u); }
    // Mantissa of 54 bits with an even exponent, at the top of 64 bits
    let left = select(11u, 10u, (exponent & 1) == 1);
    let mantissa = double_mantissa(x);
    var digits = vec2((mantissa.x << left) | (mantissa.y >> (32u - left)), mantissa.y << left);
    var root = vec2(0u);
    var rest = vec2(0u);
    for (var bit = 0u; bit < 53u; bit++) {
        // Append two bits to the rest, and try whether the root has one more bit
        rest = vec2((rest.x << 2u) | (rest.y >> 30u), (rest.y << 2u) | (digits.x >> 30u));
        digits = vec2((digits.x << 2u) | (digits.y >> 30u), digits.y << 2u);
        let trial = vec2((root.x << 2u) | (root.y >> 30u), (root.y << 2u) | 1u);
        let is_one = !wide_is_less(rest, trial);
        if is_one { rest = wide_difference(rest, trial); }
        root = vec2((root.x << 1u) | (root.y >> 31u), (root.y << 1u) | u32(is_one));
    }
    let up = select(0u, 0xffffffffu, wide_is_less(root, rest));
    return double_of(0u, ((exponent - 1023) >> 1u) + 1023, root, up);
}

fn double_is_less(a: vec2<u32>, b: vec2<u32>) -> bool {
    let difference = double_sub(a, b);
    return difference.x > 0x80000000u || (difference.x == 0x80000000u && difference.y > 0u);
}
