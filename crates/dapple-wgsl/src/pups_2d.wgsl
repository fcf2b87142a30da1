// Textures of control points (partition of unity parametrics), with the bits of `Pups` of the crate dapple-pups.
//
// `first` is the number of the texel at which the words of `Pups::shader_words` start. Its first five texels have
// - the numbers of columns and rows of bins, the kind of weight (0 cubic, 1 quintic, 2 oscillating), and flags:
//   1 and 2 if the texture repeats along x and y, 4 if points have orientations, 8 if the strongest point has the value
// - the origin of the domain, its size, and the numbers of bins per unit, as numbers of 64 bits for both axes
// - the number of dips and their depth
// For each bin, the first word of its candidates follows, then the candidates: texels of control points. Words and texels
// are counted from `first`.

// A coordinate that wraps into the domain, or is clamped far from it
fn pups_coordinate(coordinate: vec2<u32>, origin: vec2<u32>, size: vec2<u32>, wraps: bool) -> vec2<u32> {
    if !wraps {
        // 2^20 sizes from the domain
        let far = double_mul(size, vec2(0x41300000u, 0u));
        let low = double_sub(origin, far);
        let high = double_add(origin, far);
        if double_is_less(coordinate, low) { return low; }
        if double_is_less(high, coordinate) { return high; }
        return coordinate;
    }
    let end = double_add(origin, size);
    if !double_is_less(coordinate, origin) && double_is_less(coordinate, end) { return coordinate; }
    let periods = double_floor(double_div(double_sub(coordinate, origin), size));
    let inside = double_sub(coordinate, double_mul(periods, size));
    if double_is_less(inside, origin) || !double_is_less(inside, end) { return origin; }
    return inside;
}

// A position in the domain of a texture
fn pups_position(data: texture_2d<u32>, first: u32, at: Position2d) -> Position2d {
    let flags = data_words(data, first).w;
    let origin = data_words(data, first + 1u);
    let size = data_words(data, first + 2u);
    return Position2d(
        pups_coordinate(at.x, origin.xy, size.xy, (flags & 1u) != 0u),
        pups_coordinate(at.y, origin.zw, size.zw, (flags & 2u) != 0u));
}

// The first word of the candidates in the bin of a position in the domain, and the word after the last one
fn pups_candidates(data: texture_2d<u32>, first: u32, at: Position2d) -> vec2<u32> {
    let bins = data_words(data, first).xy;
    let origin = data_words(data, first + 1u);
    let per_unit = data_words(data, first + 3u);
    let x = double_mul(double_sub(at.x, origin.xy), per_unit.xy);
    let y = double_mul(double_sub(at.y, origin.zw), per_unit.zw);
    // Bins at the border have the positions outside of the domain
    let inside = vec2<u32>(max(vec2(double_to_int(x), double_to_int(y)), vec2(0)));
    let high = vec2(x.x, y.x);
    let beyond = select(inside, bins, high >= vec2(0x41600000u));
    let bin = min(select(beyond, vec2(0u), high >= vec2(0x80000000u)), bins - 1u);
    let word = 4u * (first + 5u) + bin.y * bins.x + bin.x;
    return vec2(4u * first) + vec2(data_word(data, word), data_word(data, word + 1u));
}

// The weight along an axis at `u`, for four axes
fn pups_axial(u: vec4<f32>, kind: u32, dips: vec4<u32>, zero: u32) -> vec4<f32> {
    let square = exact_mul(u, u, zero);
    if kind == 1u {
        let inner = exact_sub(exact_mul(u, vec4(6.0), zero), vec4(15.0), zero);
        let outer = exact_add(exact_mul(inner, u, zero), vec4(10.0), zero);
        return exact_mul(exact_mul(square, u, zero), outer, zero);
    }
    let cubic = exact_mul(square, exact_add(exact_mul(u, vec4(-2.0), zero), vec4(3.0), zero), zero);
    if kind == 0u { return cubic; }
    // Chebyshev polynomials by their recurrence
    let x = exact_sub(exact_mul(u, vec4(2.0), zero), vec4(1.0), zero);
    var former = vec4(1.0);
    var swing = x;
    for (var n = 1u; n < dips.x; n++) {
        let next = exact_sub(exact_mul(exact_mul(x, swing, zero), vec4(2.0), zero), former, zero);
        former = swing;
        swing = next;
    }
    let dip = exact_add(-exact_mul(swing, swing, zero), vec4(1.0), zero);
    let depth = vec4(-bitcast<f32>(dips.y));
    return exact_mul(cubic, exact_add(exact_mul(exact_mul(dip, dip, zero), depth, zero), vec4(1.0), zero), zero);
}

// A polynomial of one more degree
fn pups_term(sum: vec4<f32>, x: vec4<f32>, coefficient: f32, zero: u32) -> vec4<f32> {
    return exact_add(exact_mul(sum, x, zero), vec4(coefficient), zero);
}

// Powers of numbers from 0 to 1
fn pups_powers(bases: vec4<f32>, exponents: vec4<f32>, zero: u32) -> vec4<f32> {
    // Binary exponents, and mantissas from the root of ½ on
    let bits = bitcast<vec4<u32>>(bases) + vec4(0x4afb0du);
    let mantissas = bitcast<vec4<f32>>((bits & vec4(0x7fffffu)) + vec4(0x3f3504f3u));
    let x = exact_sub(mantissas, vec4(1.0), zero);
    let whole = exact_sub(bitcast<vec4<f32>>((bits >> vec4(23u)) | vec4(0x4b000000u)), vec4(8388735.0), zero);
    var logarithm = pups_term(vec4(-0.2067227), x, 0.3220398, zero);
    logarithm = pups_term(logarithm, x, -0.36742932, zero);
    logarithm = pups_term(logarithm, x, 0.47936413, zero);
    logarithm = pups_term(logarithm, x, -0.72113585, zero);
    logarithm = pups_term(logarithm, x, 1.4427129, zero);
    let scaled = exact_mul(exact_add(whole, exact_mul(x, logarithm, zero), zero), exponents, zero);
    let bounded = max(scaled, vec4(-126.0));
    // Nearest integers, and fractions from -½ to ½
    let rounded = exact_add(bounded, vec4(12582912.0), zero);
    let rest = exact_sub(bounded, exact_sub(rounded, vec4(12582912.0), zero), zero);
    var power = pups_term(vec4(0.009681896), rest, 0.05591946, zero);
    power = pups_term(power, rest, 0.24022022, zero);
    power = pups_term(power, rest, 0.69312155, zero);
    let fraction = exact_add(exact_mul(rest, power, zero), vec4(1.0), zero);
    let result = bitcast<vec4<u32>>(fraction) + (bitcast<vec4<u32>>(rounded) << vec4(23u));
    return bitcast<vec4<f32>>(select(vec4(0u), result, bases > vec4(0.0)));
}

// A weight shifted towards an orientation
fn pups_shifted(weight: f32, shift: vec2<f32>, x: f32, y: f32, zero: u32) -> f32 {
    let squares = exact_mul(vec4(x, y, x, y), vec4(x, y, shift), zero);
    let least = number_add(squares.y, bitcast<f32>(0x800000u), zero);
    let distance = exact_root(number_add(squares.x, least, zero));
    let along = number_add(squares.z, squares.w, zero);
    let near = number_sub(distance, max(along, 0.0), zero);
    let exponent = number_div(near, number_add(distance, min(along, 0.0), zero), zero);
    return pups_powers(vec4(weight), vec4(exponent), zero).x;
}

// `-u` along four axes
fn pups_axes(x: vec4<f32>, y: vec4<f32>, offset: vec2<f32>, zero: u32) -> vec4<f32> {
    let rest = exact_sub(vec4(1.0), exact_mul(y, vec4(offset.y), zero), zero);
    let unbounded = exact_sub(exact_mul(x, vec4(offset.x), zero), rest, zero);
    return min(max(unbounded, vec4(-1.0)), vec4(0.0));
}

// The product of eight axial weights
fn pups_product(a: vec4<f32>, b: vec4<f32>, kind: u32, dips: vec4<u32>, zero: u32) -> f32 {
    var parts = array(a, b);
    if kind > 0u { parts = array(pups_axial(-a, kind, dips, zero), pups_axial(-b, kind, dips, zero)); }
    let sums = array(exact_add(a, vec4(1.5), zero), exact_add(b, vec4(1.5), zero));
    // The cubic weight is a square and a sum, whose products are separate
    var product = vec4(parts[0].x, sums[0].x, 0.0, 0.0);
    for (var axis = 1u; axis < 8u; axis++) {
        product = exact_mul(product, vec4(parts[axis >> 2u][axis & 3u], sums[axis >> 2u][axis & 3u], 0.0, 0.0), zero);
    }
    if kind > 0u { return product.x; }
    let square = number_mul(product.x, product.x, zero);
    return number_mul(square, number_mul(product.y, 256.0, zero), zero);
}

// The product of those of four axial weights that fade, and of a number
fn pups_faded(
    product: f32, axes: vec4<f32>, exponents: vec4<f32>, kind: u32, dips: vec4<u32>, zero: u32,
) -> f32 {
    let sums = exact_mul(exact_add(axes, vec4(1.5), zero), vec4(2.0), zero);
    var weights = exact_mul(exact_mul(axes, axes, zero), sums, zero);
    if kind > 0u { weights = pups_axial(-axes, kind, dips, zero); }
    let powers = pups_powers(weights, exponents, zero);
    var result = product;
    for (var axis = 0u; axis < 4u; axis++) {
        if exponents[axis] < 1.0 { result = number_mul(result, powers[axis], zero); }
    }
    return result;
}

// The weight of a control point at a position in the domain. A point has its value, its shift, and the numbers of all
// blocks of axes and of those that fade; its center; and the blocks, of eight axes each.
fn pups_weight(data: texture_2d<u32>, first: u32, point: u32, at: Position2d, zero: u32) -> f32 {
    let kind = data_words(data, first);
    let dips = data_words(data, first + 4u);
    let head = data_words(data, point);
    let center = data_words(data, point + 1u);
    let offset = vec2(
        double_to_float(double_sub(at.x, center.xy)), double_to_float(double_sub(at.y, center.zw)));
    let full = (head.w & 0xffffu) - (head.w >> 16u);
    var quad = point + 2u;
    var weight = 1.0;
    for (var block = 0u; block < (head.w & 0xffffu); block++) {
        let x = array(bitcast<vec4<f32>>(data_words(data, quad)), bitcast<vec4<f32>>(data_words(data, quad + 1u)));
        let y = array(bitcast<vec4<f32>>(data_words(data, quad + 2u)), bitcast<vec4<f32>>(data_words(data, quad + 3u)));
        let a = pups_axes(x[0], y[0], offset, zero);
        let b = pups_axes(x[1], y[1], offset, zero);
        quad += 4u;
        var product: f32;
        if block < full {
            product = pups_product(a, b, kind.z, dips, zero);
        } else {
            let near = bitcast<vec4<f32>>(data_words(data, quad));
            let far = bitcast<vec4<f32>>(data_words(data, quad + 1u));
            product = pups_faded(1.0, a, near, kind.z, dips, zero);
            product = pups_faded(product, b, far, kind.z, dips, zero);
            quad += 2u;
        }
        if block == 0u { weight = product; } else { weight = number_mul(weight, product, zero); }
    }
    if (kind.w & 4u) == 0u { return weight; }
    return pups_shifted(weight, bitcast<vec2<f32>>(head.yz), offset.x, offset.y, zero);
}

// The value of the nearest control point, where all weights vanish
fn pups_nearest(data: texture_2d<u32>, first: u32, candidates: vec2<u32>, at: Position2d) -> f32 {
    var value = 0.0;
    var nearest = vec2(0x7ff00000u, 0u);
    for (var word = candidates.x; word < candidates.y; word++) {
        let point = first + data_word(data, word);
        let center = data_words(data, point + 1u);
        let x = double_sub(at.x, center.xy);
        let y = double_sub(at.y, center.zw);
        let square = double_add(double_mul(x, x), double_mul(y, y));
        if square.x < nearest.x || (square.x == nearest.x && square.y < nearest.y) {
            nearest = square;
            value = bitcast<f32>(data_words(data, point).x);
        }
    }
    return value;
}

// Value at a position in the domain: the mean of the values of the control points by their weights, or the value of the
// point with the largest weight
fn pups_value(data: texture_2d<u32>, first: u32, at: Position2d, zero: u32) -> f32 {
    let candidates = pups_candidates(data, first, at);
    // The weights, and the values times the weights
    var sums = exact(vec4(0.0), zero);
    var best = 0.0;
    var strongest = 0.0;
    for (var word = candidates.x; word < candidates.y; word++) {
        let point = first + data_word(data, word);
        let weight = pups_weight(data, first, point, at, zero);
        let value = bitcast<f32>(data_words(data, point).x);
        sums = exact_add(sums, exact_mul(vec4(weight), vec4(1.0, value, 0.0, 0.0), zero), zero);
        if weight > best {
            best = weight;
            strongest = value;
        }
    }
    let is_label = (data_words(data, first).w & 8u) != 0u;
    if select(sums.x < 1e-30, best == 0.0, is_label) { return pups_nearest(data, first, candidates, at); }
    if is_label { return strongest; }
    return number_div(sums.y, sums.x, zero);
}

// Weighted sum of layers. Each has a texel, from `layers` on: its first texel, its amplitude, 1 if it is folded, and the
// binary logarithm of its frequency.
fn pups_sum(data: texture_2d<u32>, layers: u32, count: u32, at: Position2d, zero: u32) -> f32 {
    var sum = 0.0;
    for (var index = 0u; index < count; index++) {
        let layer = data_words(data, layers + index);
        let frequency = vec2((1023u + layer.w) << 20u, 0u);
        let place = pups_position(data, layer.x, scaled_2d(at, frequency, frequency));
        var value = pups_value(data, layer.x, place, zero);
        if layer.z == 1u { value = number_mul(2.0, abs(number_sub(value, 0.5, zero)), zero); }
        sum = add_octave(sum, bitcast<f32>(layer.y), number_clamp(value, 0.0, 1.0, zero), zero);
    }
    return sum;
}
