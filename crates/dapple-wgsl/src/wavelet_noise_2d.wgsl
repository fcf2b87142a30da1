// Wavelet noise in two dimensions, with the bits of `WaveletNoise2` of the crate dapple-wavelet.

// Weights of the coefficients of the previous cell, this cell and the next cell
fn spline_weights(fraction: f32, zero: u32) -> vec4<f32> {
    let after = vec4(fraction);
    let before = exact_sub(vec4(1.0), after, zero);
    let ends = vec4(before.x, after.x, 0.0, 0.0);
    let squares = exact_mul(exact_mul(vec4(0.5), ends, zero), ends, zero);
    let middle = exact_add(vec4(0.5), exact_mul(after, before, zero), zero);
    return vec4(squares.x, middle.x, squares.y, 0.0);
}

// Three coefficients of a row, starting at a word
fn spline_row(data: texture_2d<u32>, at: u32) -> vec4<f32> {
    let words = vec4(data_word(data, at), data_word(data, at + 1u), data_word(data, at + 2u), 0u);
    return bitcast<vec4<f32>>(words);
}

// Value at a position in cells of the first band. `first` is the number of the texel at which the words of
// `WaveletNoise2::shader_words` start.
fn wavelet_noise_2d(data: texture_2d<u32>, first: u32, at: Position2d, zero: u32) -> f32 {
    let size = data_words(data, first);
    let whole = Position2d(double_floor(at.x), double_floor(at.y));
    let fraction = Position2d(double_sub(at.x, whole.x), double_sub(at.y, whole.y));
    let cell = wrapped(vec2(double_to_int(whole.x), double_to_int(whole.y)), size.xy);
    let tile = 4u * (first + 1u + size.z);
    let width = size.x + 2u;
    var sum = 0.0;
    for (var index = 0u; index < size.z; index++) {
        // Weight, binary logarithm of the frequency, offset
        let band = data_words(data, first + 1u + index);
        var fine = fraction;
        var place = cell;
        if band.y > 0u {
            let frequency = vec2((1023u + band.y) << 20u, 0u);
            let scaled = scaled_2d(fraction, frequency, frequency);
            let steps = Position2d(double_floor(scaled.x), double_floor(scaled.y));
            fine = Position2d(double_sub(scaled.x, steps.x), double_sub(scaled.y, steps.y));
            // Double the cell as often as the band doubles the frequency; it stays on the tile
            for (var doubled = 0u; doubled < band.y; doubled++) {
                place = select(2u * place - size.xy, 2u * place, 2u * place < size.xy);
            }
            let moved = vec2(u32(double_to_int(steps.x)), u32(double_to_int(steps.y))) + band.zw;
            place = (place + moved) % size.xy;
        }
        let across = spline_weights(double_to_float(fine.x), zero);
        let down = spline_weights(double_to_float(fine.y), zero);
        // Blend three rows of coefficients, then three columns
        let corner = tile + place.y * width + place.x;
        let top = exact_mul(down.xxxx, spline_row(data, corner), zero);
        let middle = exact_mul(down.yyyy, spline_row(data, corner + width), zero);
        let bottom = exact_mul(down.zzzz, spline_row(data, corner + 2u * width), zero);
        let row = exact_mul(across, exact_add(exact_add(top, middle, zero), bottom, zero), zero);
        let value = exact_add(exact_add(row.xxxx, row.yyyy, zero), row.zzzz, zero).x;
        sum = add_octave(sum, bitcast<f32>(band.x), value, zero);
    }
    return sum;
}
