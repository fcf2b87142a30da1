// A position in four dimensions: a cell, and a fraction of a cell from 0 to 1. It is equally precise in all cells.
struct Place4d { cell: vec4<i32>, fraction: vec4<f32> }

// Place of a position in a small world, of less than 2^24 cells to each side
fn place_4d(position: vec4<f32>) -> Place4d {
    let whole = vec4<i32>(position);
    let cell = whole - select(vec4(0), vec4(1), vec4<f32>(whole) > position);
    // Clear the sign of a negative zero
    return Place4d(cell, bitcast<vec4<f32>>(bitcast<vec4<u32>>(position - vec4<f32>(cell)) & vec4(0x7fffffffu)));
}

// `factor * place + offset / 2^24`, with fractions rounded down to multiples of 2^-24; `factor` is from 1 to 128
fn moved_4d(place: Place4d, factor: u32, offset: vec4<u32>) -> Place4d {
    let parts = vec4<u32>(place.fraction * 16777216.0) * factor + offset;
    let cell = place.cell * i32(factor) + vec4<i32>(parts >> vec4(24u));
    return Place4d(cell, vec4<f32>(parts & vec4(0xffffffu)) * (1.0 / 16777216.0));
}
