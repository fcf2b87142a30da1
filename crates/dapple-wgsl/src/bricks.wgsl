// Bricks and tiles with the values of `Bricks` of the crate dapple-pattern.

// The bricks: the words of `Bricks::shader_words`
struct Bricks {
    seed: vec2<u32>,
    period: vec2<u32>,
    // Number of the bond, and the length of a brick in squares
    bond: vec2<u32>,
    frequency_x: vec2<u32>,
    frequency_y: vec2<u32>,
    width: vec2<u32>,
    height: vec2<u32>,
    unit: vec2<u32>,
    // Half of the joint, and the largest displacement of an edge, in units
    inset: vec2<u32>,
    jitter: vec2<u32>,
    // In units of the plane
    bevel: vec2<u32>,
    rounding: vec2<u32>,
    // Shift of every other course, and largest displacement of the end of a plank, in bricks
    offset: vec2<u32>,
    variation: vec2<u32>,
    // Seeds of the courses and of the ends of planks
    courses: vec2<u32>,
    ends: vec2<u32>,
}

// A brick and a position in its cell, as the values `height`, `u` and `v`; not clamped
struct Brick {
    id: vec2<i32>,
    is_upright: bool,
    u: vec2<u32>,
    v: vec2<u32>,
    height: vec2<u32>,
}

// Distance from the side of a cell to the face of its brick
fn brick_inset(bricks: Bricks, state: vec2<u32>, side: u32) -> vec2<u32> {
    let random = double_mul(bricks.jitter, state_double(state, 4u + side));
    return double_mul(bricks.unit, double_add(bricks.inset, random));
}

// Rise from 0 at the border of a face to 1 past the bevel
fn brick_rise(bricks: Bricks, depth: vec2<u32>) -> vec2<u32> {
    if !double_is_less(vec2(0u), depth) { return vec2(0u); }
    if !double_is_less(depth, bricks.bevel) { return vec2(0x3ff00000u, 0u); }
    return double_smooth(double_div(depth, bricks.bevel));
}

// Position across a face, from 0 to 1
fn brick_part(at: vec2<u32>, half: vec2<u32>) -> vec2<u32> {
    let half_at = double_mul(vec2(0x3fe00000u, 0u), at);
    return double_unit(double_add(vec2(0x3fe00000u, 0u), double_div(half_at, half)));
}

// Signed distance to the border of a rounded box, positive inside
fn brick_corner(past_x: vec2<u32>, past_y: vec2<u32>, radius: vec2<u32>) -> vec2<u32> {
    let x = double_add(past_x, radius);
    let y = double_add(past_y, radius);
    let outside = double_length(double_max(x, vec2(0u)), double_max(y, vec2(0u)));
    return double_sub(double_sub(radius, outside), double_min(double_max(x, y), vec2(0u)));
}

// Shift of a course, in bricks
fn brick_shift(bricks: Bricks, course: i32) -> vec2<u32> {
    return select(vec2(0u), bricks.offset, (course & 1) == 1);
}

fn brick_wrapped(bricks: Bricks, id: vec2<i32>) -> vec2<i32> { return vec2<i32>(wrapped(id, bricks.period)); }
fn brick_random(bricks: Bricks, id: vec2<i32>, index: u32) -> f32 {
    return state_number(cell_state(bricks.seed, id), index);
}
