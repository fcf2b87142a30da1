// Positions in the plane as the CPU computes them, in numbers of 64 bits.
struct Position2d { x: vec2<u32>, y: vec2<u32> }

// `cell + fraction`
fn position_2d(place: Place2d) -> Position2d {
    return Position2d(
        double_add(double_from_int(place.cell.x), double_from(place.fraction.x)),
        double_add(double_from_int(place.cell.y), double_from(place.fraction.y)));
}

// Positions multiplied by a number for each axis
fn scaled_2d(at: Position2d, x: vec2<u32>, y: vec2<u32>) -> Position2d {
    return Position2d(double_mul(at.x, x), double_mul(at.y, y));
}

// Positions plus a number for each axis
fn shifted_2d(at: Position2d, x: vec2<u32>, y: vec2<u32>) -> Position2d {
    return Position2d(double_add(at.x, x), double_add(at.y, y));
}

// Positions after a clockwise rotation about the origin
fn rotated_2d(at: Position2d, cos: vec2<u32>, sin: vec2<u32>) -> Position2d {
    return Position2d(
        double_add(double_mul(at.x, cos), double_mul(at.y, sin)),
        double_sub(double_mul(at.y, cos), double_mul(at.x, sin)));
}

// Cell and fraction of a position in cells, for gradient noise: the fraction is rounded to nearest, and may be 1
fn noise_place_2d(at: Position2d) -> Place2d {
    let x = double_floor(at.x);
    let y = double_floor(at.y);
    let fraction = vec2(double_to_float(double_sub(at.x, x)), double_to_float(double_sub(at.y, y)));
    return Place2d(vec2(double_to_int(x), double_to_int(y)), fraction);
}

// Cell and fraction of a position in cells, for Worley's basis: the fraction is rounded down to a multiple of 2^-21
fn worley_place_2d(at: Position2d) -> Place2d {
    let x = double_floor(at.x);
    let y = double_floor(at.y);
    // Multiply the fractions by 2^21
    let steps = vec2(0x41400000u, 0u);
    let columns = double_to_int(double_mul(double_sub(at.x, x), steps));
    let rows = double_to_int(double_mul(double_sub(at.y, y), steps));
    return Place2d(vec2(double_to_int(x), double_to_int(y)), vec2(f32(columns), f32(rows)) * (1.0 / 2097152.0));
}
