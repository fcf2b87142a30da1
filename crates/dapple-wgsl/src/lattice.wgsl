// Parts that patterns of the crate dapple-pattern share, in numbers of 64 bits.

// A coordinate in cells: the cell, and the offset in it from 0 to below 1
struct Split { cell: i32, offset: vec2<u32> }

// Moves the whole part of an offset to the cell
fn carried(cell: i32, offset: vec2<u32>) -> Split {
    let whole = double_floor(offset);
    let rest = double_sub(offset, whole);
    let first = cell + double_to_int(whole);
    // A tiny negative offset rounds to 1: it belongs to the next cell.
    if rest.x >= 0x3ff00000u { return Split(first + 1, vec2(0u)); }
    return Split(first, rest);
}

fn split_of(coordinate: vec2<u32>) -> Split { return carried(0, coordinate); }
fn split_shifted(split: Split, by: vec2<u32>) -> Split { return carried(split.cell, double_add(split.offset, by)); }

// Remainder of a division that rounds down
fn floor_remainder(a: i32, b: i32) -> i32 { return ((a % b) + b) % b; }

// Hash state of a seed, given as its upper and lower word
fn seed_state(seed: vec2<u32>) -> vec2<u32> { return absorbed(absorbed(vec2(0u), seed.x), seed.y); }

// Hash state after one more coordinate of a cell
fn axis_state(state: vec2<u32>, coordinate: i32) -> vec2<u32> {
    return absorbed(absorbed(state, u32(coordinate >> 31u)), u32(coordinate));
}

// Hash state of a cell
fn cell_state(seed: vec2<u32>, cell: vec2<i32>) -> vec2<u32> {
    return axis_state(axis_state(seed_state(seed), cell.y), cell.x);
}

// Random number from 0 to below 1 of a hash state and a counter, in 32 and in 64 bits
fn state_number(state: vec2<u32>, counter: u32) -> f32 { return cell_value(cell_bits(state, counter)); }
fn state_double(state: vec2<u32>, counter: u32) -> vec2<u32> {
    let bits = cell_bits(state, counter) & vec2(0xffffffffu, 0xfffff800u);
    if all(bits == vec2(0u)) { return bits; }
    // Move the first bit to the top
    let is_low = bits.x == 0u;
    let top = select(bits, vec2(bits.y, 0u), is_low);
    let zeros = countLeadingZeros(top.x);
    let low = select(top.y >> (32u - zeros), 0u, zeros == 0u);
    let moved = vec2((top.x << zeros) | low, top.y << zeros);
    let exponent = 1022 - i32(zeros) - select(0, 32, is_low);
    return double_of(0u, exponent, vec2(moved.x >> 11u, (moved.x << 21u) | (moved.y >> 11u)), 0u);
}
