// Extremes, smooth steps and lengths of numbers of 64 bits, with the bits of the CPU.

fn double_min(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> { return select(a, b, double_is_less(b, a)); }
fn double_max(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> { return select(a, b, double_is_less(a, b)); }

fn double_is_negative(x: vec2<u32>) -> bool { return x.x > 0x80000000u || (x.x == 0x80000000u && x.y > 0u); }

// A number clamped to 0 to 1
fn double_unit(x: vec2<u32>) -> vec2<u32> {
    return double_min(double_max(x, vec2(0u)), vec2(0x3ff00000u, 0u));
}

// `3 t^2 - 2 t^3`
fn double_smooth(t: vec2<u32>) -> vec2<u32> {
    let rest = double_sub(vec2(0x40080000u, 0u), double_add(t, t));
    return double_mul(double_mul(t, t), rest);
}

// Length of a vector
fn double_length(x: vec2<u32>, y: vec2<u32>) -> vec2<u32> {
    return double_root(double_add(double_mul(x, x), double_mul(y, y)));
}
