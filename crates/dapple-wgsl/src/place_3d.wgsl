// A position in space: a cell, and a fraction of a cell from 0 to 1. It is equally precise in all cells.
struct Place3d { cell: vec3<i32>, fraction: vec3<f32> }

// Place of a position in a small world, of less than 2^24 cells to each side
fn place_3d(position: vec3<f32>) -> Place3d {
    let whole = vec3<i32>(position);
    let cell = whole - select(vec3(0), vec3(1), vec3<f32>(whole) > position);
    // Clear the sign of a negative zero
    return Place3d(cell, bitcast<vec3<f32>>(bitcast<vec3<u32>>(position - vec3<f32>(cell)) & vec3(0x7fffffffu)));
}

// `factor * place + offset / 2^24`, with fractions rounded down to multiples of 2^-24; `factor` is from 1 to 128
fn moved_3d(place: Place3d, factor: u32, offset: vec3<u32>) -> Place3d {
    let parts = vec3<u32>(place.fraction * 16777216.0) * factor + offset;
    let cell = place.cell * i32(factor) + vec3<i32>(parts >> vec3(24u));
    return Place3d(cell, vec3<f32>(parts & vec3(0xffffffu)) * (1.0 / 16777216.0));
}
