// A position in the plane: a cell, and a fraction of a cell from 0 to 1. It is equally precise in all cells.
struct Place2d { cell: vec2<i32>, fraction: vec2<f32> }

// Place of a position in a small world, of less than 2^24 cells to each side
fn place_2d(position: vec2<f32>) -> Place2d {
    let whole = vec2<i32>(position);
    let cell = whole - select(vec2(0), vec2(1), vec2<f32>(whole) > position);
    // Clear the sign of a negative zero
    return Place2d(cell, bitcast<vec2<f32>>(bitcast<vec2<u32>>(position - vec2<f32>(cell)) & vec2(0x7fffffffu)));
}

// `factor * place + offset / 2^24`, with fractions rounded down to multiples of 2^-24; `factor` is from 1 to 128
fn moved_2d(place: Place2d, factor: u32, offset: vec2<u32>) -> Place2d {
    let parts = vec2<u32>(place.fraction * 16777216.0) * factor + offset;
    let cell = place.cell * i32(factor) + vec2<i32>(parts >> vec2(24u));
    return Place2d(cell, vec2<f32>(parts & vec2(0xffffffu)) * (1.0 / 16777216.0));
}
