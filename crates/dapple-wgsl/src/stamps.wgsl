// Stamps with the values of `Stamps` of the crate dapple-pattern. Which stamps are near a cell is known from the data.

// The stamps: texels of the lists of the cells and of the stamps, the period in cells, and options
struct Stamps {
    first: u32,
    first_stamp: u32,
    period: vec2<u32>,
    shape: u32,
    overlap: u32,
    bevel: f32,
    lift: f32,
    tilt: f32,
}

// The stamp that is visible at a position; all values are 0 outside of stamps. `height` may be a sum.
struct StampHit {
    mask: f32,
    height: f32,
    edge: f32,
    angle: f32,
    uv: vec2<f32>,
    random: vec3<f32>,
}

// Height of a flat shape with a rounded bevel
fn stamp_bevel(edge: f32, bevel: f32, zero: u32) -> f32 {
    if edge >= bevel { return 1.0; }
    let t = number_sub(1.0, number_div(edge, bevel, zero), zero);
    return exact_root(number_max(number_sub(1.0, number_mul(t, t, zero), zero), 0.0, zero));
}

// Distance from the outline and profile of a flat shape; the distance is negative outside
fn stamp_flat(edge: f32, bevel: f32, zero: u32) -> vec2<f32> {
    if edge < 0.0 { return vec2(-1.0, 0.0); }
    return vec2(edge, stamp_bevel(edge, bevel, zero));
}

// Distance from the outline and profile of a shape with an elliptic section, from the squared distance to its middle
fn stamp_round(square: f32, zero: u32) -> vec2<f32> {
    if square > 1.0 { return vec2(-1.0, 0.0); }
    return vec2(number_sub(1.0, exact_root(square), zero), exact_root(number_sub(1.0, square, zero)));
}

fn stamp_slate(uv: vec2<f32>, aspect: f32, zero: u32) -> f32 {
    let past = number_mul(number_sub(uv.x, 0.33333334, zero), 1.5, zero);
    let round = number_max(past, 0.0, zero);
    let square = number_add(number_mul(round, round, zero), number_mul(uv.y, uv.y, zero), zero);
    let end = number_sub(1.0, exact_root(square), zero);
    return number_min(end, number_div(number_add(1.0, uv.x, zero), aspect, zero), zero);
}

// Distance from the center of a pebble relative to its outline, which is a sum of harmonics
fn stamp_pebble(direction: vec2<f32>, length: f32, random: vec4<f32>, zero: u32) -> f32 {
    let c = direction.x;
    let s = direction.y;
    let c_2 = number_sub(number_mul(c, c, zero), number_mul(s, s, zero), zero);
    let s_2 = number_mul(number_mul(2.0, c, zero), s, zero);
    let c_3 = number_sub(number_mul(c, c_2, zero), number_mul(s, s_2, zero), zero);
    let s_3 = number_add(number_mul(c, s_2, zero), number_mul(s, c_2, zero), zero);
    let c_5 = number_sub(number_mul(c_2, c_3, zero), number_mul(s_2, s_3, zero), zero);
    let s_5 = number_add(number_mul(c_2, s_3, zero), number_mul(s_2, c_3, zero), zero);
    let part = exact_sub(exact_mul(vec4(2.0), random, zero), vec4(1.0), zero);
    let second = number_add(number_mul(part.x, c_2, zero), number_mul(part.y, s_2, zero), zero);
    let third = number_add(number_mul(part.z, c_3, zero), number_mul(part.w, s_3, zero), zero);
    let fifth = number_add(number_mul(part.y, c_5, zero), number_mul(part.x, s_5, zero), zero);
    let waves = number_add(number_mul(0.08, second, zero), number_mul(0.06, third, zero), zero);
    let wave = number_add(waves, number_mul(0.04, fifth, zero), zero);
    return number_div(length, number_min(number_add(0.8, wave, zero), 1.0, zero), zero);
}

fn stamp_leaf(uv: vec2<f32>, bevel: f32, random: f32, zero: u32) -> vec2<f32> {
    let u = uv.x;
    // Half of the width along the leaf
    let round = number_sub(1.0, number_mul(u, u, zero), zero);
    let taper = number_sub(1.0, number_mul(0.35, u, zero), zero);
    let width = number_mul(number_mul(round, taper, zero), 0.94, zero);
    let across = abs(uv.y);
    if across >= width { return vec2(-1.0, 0.0); }
    let edge = number_sub(1.0, number_div(across, width, zero), zero);
    // Side veins, which are grooves, and the midrib
    let along = number_sub(u, number_mul(0.6, across, zero), zero);
    let phase = number_add(number_mul(4.0, along, zero), random, zero);
    let part = number_sub(phase, floor(phase), zero);
    let vein = abs(number_sub(number_mul(2.0, part, zero), 1.0, zero));
    let depth = number_max(number_mul(number_sub(vein, 0.8, zero), 5.0, zero), 0.0, zero);
    let groove = number_mul(number_mul(0.08, depth, zero), number_min(edge, 0.5, zero), zero);
    let rib_width = number_mul(0.07, number_sub(1.25, u, zero), zero);
    let rise = number_sub(1.0, number_div(across, rib_width, zero), zero);
    let rib = number_mul(0.15, number_max(rise, 0.0, zero), zero);
    let middle = number_sub(1.0, edge, zero);
    let bent = number_mul(number_mul(0.35, middle, zero), middle, zero);
    let sheet = number_add(number_sub(number_add(0.5, bent, zero), groove, zero), rib, zero);
    return vec2(edge, number_mul(number_min(sheet, 1.0, zero), stamp_bevel(edge, bevel, zero), zero));
}

fn stamp_blade(uv: vec2<f32>, random: f32, zero: u32) -> vec2<f32> {
    // Parameter from 0 at the root to 1 at the tip
    let t = number_add(0.5, number_mul(0.5, uv.x, zero), zero);
    let side = number_sub(number_mul(2.0, random, zero), 1.0, zero);
    let bend = number_mul(number_mul(number_mul(0.65, side, zero), t, zero), t, zero);
    let rest = number_sub(1.0, number_mul(t, t, zero), zero);
    let width = number_mul(0.35, number_max(rest, 0.0, zero), zero);
    let across = abs(number_sub(uv.y, bend, zero));
    if across >= width { return vec2(-1.0, 0.0); }
    let edge = number_sub(1.0, number_div(across, width, zero), zero);
    // The sides rise from a fold in the middle.
    let fold = number_add(0.75, number_mul(0.25, number_sub(1.0, edge, zero), zero), zero);
    return vec2(edge, number_mul(number_add(0.15, number_mul(0.85, t, zero), zero), fold, zero));
}

// Distance from the outline, negative outside, and profile of a stamp
fn stamp_profile(stamps: Stamps, uv: vec2<f32>, aspect: f32, random: vec4<f32>, zero: u32) -> vec2<f32> {
    let square = number_add(number_mul(uv.x, uv.x, zero), number_mul(uv.y, uv.y, zero), zero);
    let length = exact_root(square);
    let bevel = stamps.bevel;
    var direction = vec2(1.0, 0.0);
    if stamps.shape == 5u || stamps.shape >= 9u {
        if length > 0.0 { direction = vec2(number_div(uv.x, length, zero), number_div(uv.y, length, zero)); }
    }
    switch stamps.shape {
        case 0u: { return stamp_round(square, zero); }
        case 1u: {
            let edge = number_sub(1.0, length, zero);
            return select(vec2(edge, edge), vec2(-1.0, 0.0), edge < 0.0);
        }
        case 2u: { return stamp_flat(number_sub(1.0, length, zero), bevel, zero); }
        case 3u: {
            let along = number_div(number_sub(1.0, abs(uv.x), zero), aspect, zero);
            return stamp_flat(number_min(along, number_sub(1.0, abs(uv.y), zero), zero), bevel, zero);
        }
        case 4u: { return stamp_flat(stamp_slate(uv, aspect, zero), bevel, zero); }
        case 5u: {
            let part = stamp_pebble(direction, length, random, zero);
            if part > 1.0 { return vec2(-1.0, 0.0); }
            let part_2 = number_mul(part, part, zero);
            let rest = number_sub(1.0, number_mul(part_2, part_2, zero), zero);
            return vec2(number_sub(1.0, part, zero), exact_root(rest));
        }
        case 6u: { return stamp_leaf(uv, bevel, random.x, zero); }
        case 7u: { return stamp_blade(uv, random.x, zero); }
        case 8u: {
            let past = number_sub(abs(uv.x), number_sub(1.0, aspect, zero), zero);
            let along = number_max(number_div(past, aspect, zero), 0.0, zero);
            let across = number_mul(uv.y, uv.y, zero);
            return stamp_round(number_add(number_mul(along, along, zero), across, zero), zero);
        }
        case 9u: {
            // Cosine of the fivefold angle
            let c_2 = number_mul(direction.x, direction.x, zero);
            let inner = number_mul(c_2, number_sub(number_mul(16.0, c_2, zero), 20.0, zero), zero);
            let lobe = number_mul(direction.x, number_add(5.0, inner, zero), zero);
            let radius = number_add(0.7, number_mul(0.3, lobe, zero), zero);
            return stamp_flat(number_sub(1.0, number_div(length, radius, zero), zero), bevel, zero);
        }
        default: {
            // Square of the cosine of the threefold angle
            let c_2 = number_mul(number_mul(4.0, direction.x, zero), direction.x, zero);
            let triple = number_mul(direction.x, number_sub(c_2, 3.0, zero), zero);
            let lobe = number_mul(triple, triple, zero);
            let wave = number_mul(number_mul(0.75, lobe, zero), lobe, zero);
            let radius = number_add(0.25, wave, zero);
            return stamp_flat(number_sub(1.0, number_div(length, radius, zero), zero), bevel, zero);
        }
    }
}

// Coordinate of an offset along an axis of a stamp
fn stamp_coordinate(axis: vec4<u32>, x: vec2<u32>, y: vec2<u32>) -> vec2<u32> {
    return double_add(double_mul(x, axis.xy), double_mul(y, axis.zw));
}

// Whether a number is outside of -1 to 1
fn stamp_is_past(x: vec2<u32>) -> bool {
    let size = double_abs(x);
    return size.x > 0x3ff00000u || (size.x == 0x3ff00000u && size.y > 0u);
}

// The visible stamp at a position in cells
fn stamp_hit(data: texture_2d<u32>, stamps: Stamps, at: Position2d, zero: u32) -> StampHit {
    let column = double_floor(at.x);
    let row = double_floor(at.y);
    let x = double_sub(at.x, column);
    let y = double_sub(at.y, row);
    let cell = wrapped(vec2(double_to_int(column), double_to_int(row)), stamps.period);
    let list = 4u * stamps.first + stamps.period.x * cell.y + cell.x;
    let last = data_word(data, list + 1u);
    var hit = StampHit(0.0, 0.0, 0.0, 0.0, vec2(0.0), vec3(0.0));
    var top = 0u;
    var sum = 0.0;
    for (var item = data_word(data, list); item < last; item++) {
        // Number of the stamp, and the offset of its cell plus 16
        let entry = data_word(data, 4u * stamps.first + item);
        let quad = stamps.first_stamp + 6u * (entry >> 10u);
        let numbers = bitcast<vec4<f32>>(data_words(data, quad + 3u));
        // A stamp that is nowhere as high as the top so far does not matter.
        if stamps.overlap == 0u && hit.mask > 0.0 && numbers.y < hit.height { continue; }
        let center = data_words(data, quad);
        let center_x = double_add(center.xy, double_from_int(i32((entry >> 5u) & 31u) - 16));
        let center_y = double_add(center.zw, double_from_int(i32(entry & 31u) - 16));
        let past_x = double_sub(x, center_x);
        let past_y = double_sub(y, center_y);
        let u = stamp_coordinate(data_words(data, quad + 1u), past_x, past_y);
        if stamp_is_past(u) { continue; }
        let v = stamp_coordinate(data_words(data, quad + 2u), past_x, past_y);
        if stamp_is_past(v) { continue; }
        let uv = vec2(double_to_float(u), double_to_float(v));
        let outline = bitcast<vec4<f32>>(data_words(data, quad + 4u));
        let aspect = bitcast<f32>(data_words(data, quad + 5u).w);
        let profile = stamp_profile(stamps, uv, aspect, outline, zero);
        if profile.x < 0.0 { continue; }
        // The profile is tilted, and lifted by the place in the random order
        let slope = number_add(1.0, number_mul(stamps.tilt, uv.x, zero), zero);
        let steepest = number_add(1.0, abs(stamps.tilt), zero);
        let tilted = number_div(number_mul(profile.y, slope, zero), steepest, zero);
        let rest = number_mul(number_sub(1.0, stamps.lift, zero), tilted, zero);
        let part = number_add(number_mul(stamps.lift, numbers.z, zero), rest, zero);
        let height = number_mul(numbers.x, part, zero);
        sum = number_add(sum, height, zero);
        if hit.mask == 0.0 || height >= hit.height {
            hit = StampHit(1.0, height, profile.x, numbers.w, uv, vec3(0.0));
            top = quad;
        }
        if stamps.overlap == 1u || stamps.overlap == 2u { break; }
    }
    if hit.mask == 0.0 { return hit; }
    hit.random = bitcast<vec4<f32>>(data_words(data, top + 5u)).xyz;
    hit.uv.x = number_add(0.5, number_mul(0.5, hit.uv.x, zero), zero);
    hit.uv.y = number_add(0.5, number_mul(0.5, hit.uv.y, zero), zero);
    if stamps.overlap == 3u { hit.height = sum; }
    return hit;
}
