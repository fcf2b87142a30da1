// Gabor noise with the values of `GaborNoise` of the crate dapple-pattern. The impulses of all cells are in the data.

// The noise: the texel of the first impulse, impulses in a cell, the period in cells, and the factor of the sum
struct Gabor { first: u32, impulses: u32, period: vec2<u32>, scale: vec2<u32> }

// Cosine of an angle in turns, by a polynomial
fn turn_cosine(turns: vec2<u32>) -> vec2<u32> {
    let one = vec2(0x3ff00000u, 0u);
    let part = double_sub(turns, double_floor(double_add(turns, vec2(0x3fe00000u, 0u))));
    // 2π times the distance from a quarter turn
    let angle = double_mul(vec2(0x401921fbu, 0x54442d18u), double_sub(vec2(0x3fd00000u, 0u), double_abs(part)));
    let square = double_mul(angle, angle);
    // Taylor series with the terms 1 / 9!, 1 / 7!, 1 / 5! and 1 / 3!
    var series = double_term(vec2(0x3ec71de3u, 0xa556c734u), square, vec2(0xbf2a01a0u, 0x1a01a01au));
    series = double_term(series, square, vec2(0x3f811111u, 0x11111111u));
    series = double_term(series, square, vec2(0xbfc55555u, 0x55555555u));
    return double_mul(angle, double_term(series, square, one));
}

// Sums of the waves and, if `has_sine` is set, of the waves a quarter turn later, at a position in cells
fn gabor_sums(data: texture_2d<u32>, gabor: Gabor, at: Position2d, has_sine: bool) -> vec4<u32> {
    let column = double_floor(at.x);
    let row = double_floor(at.y);
    let cell = vec2(double_to_int(column), double_to_int(row));
    let x = double_sub(at.x, column);
    let y = double_sub(at.y, row);
    var sums = vec4(0u);
    for (var i = 0; i < 9; i++) {
        let step = vec2(i % 3 - 1, i / 3 - 1);
        let near = wrapped(cell + step, gabor.period);
        let first = gabor.first + 3u * gabor.impulses * (gabor.period.x * near.y + near.x);
        for (var j = 0u; j < gabor.impulses; j++) {
            let center = data_words(data, first + 3u * j);
            let past_x = double_sub(x, double_add(center.xy, double_from_int(step.x)));
            let past_y = double_sub(y, double_add(center.zw, double_from_int(step.y)));
            let square = double_add(double_mul(past_x, past_x), double_mul(past_y, past_y));
            let rest = double_sub(vec2(0x3ff00000u, 0u), square);
            if rest.x >= 0x80000000u || all(rest == vec2(0u)) { continue; }
            let weight = double_mul(double_mul(rest, rest), rest);
            let wave = data_words(data, first + 3u * j + 1u);
            let start = data_words(data, first + 3u * j + 2u);
            let along = double_add(start.xy, double_mul(past_x, wave.xy));
            let phase = double_add(along, double_mul(past_y, wave.zw));
            let cosine = double_mul(weight, turn_cosine(phase));
            sums = vec4(double_add(sums.xy, cosine), sums.zw);
            if has_sine {
                let sine = double_mul(weight, turn_cosine(double_sub(phase, vec2(0x3fd00000u, 0u))));
                sums = vec4(sums.xy, double_add(sums.zw, sine));
            }
        }
    }
    return sums;
}

// Noise with mean 0 and variance 1
fn gabor_noise(data: texture_2d<u32>, gabor: Gabor, at: Position2d) -> f32 {
    return double_to_float(double_mul(gabor.scale, gabor_sums(data, gabor, at, false).xy));
}

// Phase in turns, from 0 to below 1
fn gabor_phase(data: texture_2d<u32>, gabor: Gabor, at: Position2d) -> f32 {
    let sums = gabor_sums(data, gabor, at, true);
    let turns = double_div(double_angle(sums.zw, sums.xy), vec2(0x401921fbu, 0x54442d18u));
    let phase = double_to_float(double_sub(turns, double_floor(turns)));
    return select(0.0, phase, phase < 1.0);
}
