// Worley's cellular basis in four dimensions, with the bits of `Worley4` of the crate dapple-worley.

// A feature point: the distance, the vector from the point to the position, and 64 random bits
struct Feature4d {
    distance: f32,
    vector: vec4<f32>,
    id: vec2<u32>,
}

// A point that a search has found: the bits of `key_4d`, the vector in units of 2^-21 cells, and the hash words of its
// cell
struct Found4d {
    key: u32,
    steps: vec4<i32>,
    words: vec2<u32>,
    index: u32,
}

// Length of a vector in units of 2^-21 cells as bits, which are ordered as lengths are; Euclidean lengths are squared
fn key_4d(steps: vec4<i32>, metric: u32, zero: u32) -> u32 {
    let cells = abs(vec4<f32>(steps) * (1.0 / 2097152.0));
    if metric == 2u { return bitcast<u32>(max(max(cells.x, cells.y), max(cells.z, cells.w))); }
    let terms = select(cells, exact_mul(cells, cells, zero), metric == 0u);
    let last = exact_add(terms.yyyy, exact_add(terms.zzzz, terms.wwww, zero), zero);
    return bitcast<u32>(exact_add(terms, last, zero).x);
}

// Whether a point comes before another one: by distance, then by id, then by vector
fn is_before_4d(a: Found4d, b: Found4d) -> bool {
    if a.key != b.key { return a.key < b.key; }
    let a_id = cell_bits(a.words, 0x80000000u + a.index);
    let b_id = cell_bits(b.words, 0x80000000u + b.index);
    if a_id.x != b_id.x { return a_id.x < b_id.x; }
    if a_id.y != b_id.y { return a_id.y < b_id.y; }
    for (var axis = 0u; axis < 4u; axis++) {
        if a.steps[axis] != b.steps[axis] { return a.steps[axis] > b.steps[axis]; }
    }
    return false;
}

fn feature_4d(found: Found4d, metric: u32) -> Feature4d {
    let vector = vec4<f32>(found.steps) * (1.0 / 2097152.0);
    let id = cell_bits(found.words, 0x80000000u + found.index);
    var distance = bitcast<f32>(found.key);
    if metric == 0u { distance = exact_root(distance); }
    return Feature4d(distance, vector, id);
}

// The nearest feature points of a place, nearest first; `count` is from 1 to 4, and further ones are not set
fn worley_4d(worley: Worley, place: Place4d, count: u32, zero: u32) -> array<Feature4d, 4> {
    // Round the position down to steps of 2^-21 cells
    let rounded = vec4<i32>(place.fraction * 2097152.0);
    let cell = place.cell + (rounded >> vec4(21u));
    let steps = rounded & vec4(0x1fffff);
    let sides = min(steps, 2097152 - steps);
    let side = min(min(sides.x, sides.y), min(sides.z, sides.w));
    let none = Found4d(0x7f800000u, vec4(0), vec2(0u), 0u);
    var found = array(none, none, none, none);
    // Visit the cell and its neighbors, then the cells around them
    for (var ring = 1; ring <= 5; ring++) {
        let width = 2 * ring + 1;
        let square = width * width;
        for (var i = 0; i < square * square; i++) {
            // Shifts along the axes, in the order 0, 1, -1, 2, -2 and so on
            let digits = vec4(i % width, i / width % width, i / square % width, i / square / width);
            let shift = select((digits + 1) / 2, -digits / 2, (digits & vec4(1)) == vec4(0));
            if ring > 1 && all(abs(shift) < vec4(ring)) { continue; }
            // Skip cells that cannot contain a nearer point
            let origin = steps - shift * 2097152;
            let gap = max(max(-origin, origin - 2097152), vec4(0));
            if key_4d(gap, worley.metric, zero) > found[count - 1u].key { continue; }
            let xy = wrapped(cell.xy + shift.xy, worley.period.xy);
            let zw = wrapped(cell.zw + shift.zw, worley.period.zw);
            let near = mix_bits(vec4(xy, xy) ^ vec4(worley.keys[0].xy, worley.keys[1].xy));
            let far = mix_bits(vec4(zw, zw) ^ vec4(worley.keys[0].zw, worley.keys[1].zw));
            let words = near.xz ^ near.yw ^ far.xz ^ far.yw;
            let points = count_points(worley, words.x);
            for (var index = 0u; index < points; index++) {
                let random = point_words(words, index);
                let halves = vec4(random.x >> 16u, random.x & 0xffffu, random.y >> 16u, random.y & 0xffffu);
                let free = (halves << vec4(5u)) + 16u;
                let point = (free * worley.jitter + 1048576u * (1024u - worley.jitter)) >> vec4(10u);
                let vector = origin - vec4<i32>(point);
                let next = Found4d(key_4d(vector, worley.metric, zero), vector, words, index);
                // Insert the point among the nearest ones
                var at = count;
                while at > 0u && is_before_4d(next, found[at - 1u]) {
                    if at < count { found[at] = found[at - 1u]; }
                    at -= 1u;
                }
                if at < count { found[at] = next; }
            }
        }
        let border = vec4(side + ring * 2097152, 0, 0, 0);
        if found[count - 1u].key < key_4d(border, worley.metric, zero) { break; }
    }
    return array(
        feature_4d(found[0], worley.metric), feature_4d(found[1], worley.metric),
        feature_4d(found[2], worley.metric), feature_4d(found[3], worley.metric));
}
