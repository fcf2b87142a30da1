// Curves through points, in numbers of 64 bits.

// A part of a curve: the first point, the width, the last value, and the slopes at both ends times the width
struct SplinePart {
    x: vec2<u32>,
    start: vec2<u32>,
    width: vec2<u32>,
    end: vec2<u32>,
    first_slope: vec2<u32>,
    last_slope: vec2<u32>,
}

// Value of a part at a position in it
fn spline_value(part: SplinePart, x: f32) -> f32 {
    let one = vec2(0x3ff00000u, 0u);
    let t = double_div(double_sub(double_from(x), part.x), part.width);
    let rest = double_sub(one, t);
    let twice = double_add(t, t);
    let first = double_mul(double_mul(double_mul(part.start, double_add(one, twice)), rest), rest);
    let last = double_mul(double_mul(double_mul(part.end, double_sub(vec2(0x40080000u, 0u), twice)), t), t);
    let bend = double_sub(double_mul(part.first_slope, rest), double_mul(part.last_slope, t));
    let ends = double_add(first, last);
    return double_to_float(double_add(ends, double_mul(double_mul(t, rest), bend)));
}
