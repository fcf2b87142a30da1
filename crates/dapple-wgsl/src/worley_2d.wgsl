// Worley's cellular basis in two dimensions, with the bits of `Worley2` of the crate dapple-worley.

// A feature point: the distance, the vector from the point to the position, and 64 random bits
struct Feature2d {
    distance: f32,
    vector: vec2<f32>,
    id: vec2<u32>,
}

// A point that a search has found: the bits of `key_2d`, the vector in units of 2^-21 cells, and the hash words
// of its cell
struct Found2d {
    key: u32,
    steps: vec2<i32>,
    words: vec2<u32>,
    index: u32,
}

// Length of a vector in units of 2^-21 cells as bits, which are ordered as lengths are; Euclidean lengths are squared
fn key_2d(steps: vec2<i32>, metric: u32, zero: u32) -> u32 {
    let cells = abs(vec4(vec2<f32>(steps) * (1.0 / 2097152.0), 0.0, 0.0));
    if metric == 2u { return bitcast<u32>(max(cells.x, cells.y)); }
    let terms = select(cells, exact_mul(cells, cells, zero), metric == 0u);
    return bitcast<u32>(exact_add(terms, terms.yxzw, zero).x);
}

// Whether a point comes before another one: by distance, then by id, then by vector
fn is_before_2d(a: Found2d, b: Found2d) -> bool {
    if a.key != b.key { return a.key < b.key; }
    let a_id = cell_bits(a.words, 0x80000000u + a.index);
    let b_id = cell_bits(b.words, 0x80000000u + b.index);
    if a_id.x != b_id.x { return a_id.x < b_id.x; }
    if a_id.y != b_id.y { return a_id.y < b_id.y; }
    if a.steps.x != b.steps.x { return a.steps.x > b.steps.x; }
    return a.steps.y > b.steps.y;
}

fn feature_2d(found: Found2d, metric: u32) -> Feature2d {
    let vector = vec2<f32>(found.steps) * (1.0 / 2097152.0);
    let id = cell_bits(found.words, 0x80000000u + found.index);
    var distance = bitcast<f32>(found.key);
    if metric == 0u { distance = exact_root(distance); }
    return Feature2d(distance, vector, id);
}

// The two nearest feature points of a place, nearest first
fn worley_2d(worley: Worley, place: Place2d, zero: u32) -> array<Feature2d, 2> {
    // Round the position down to steps of 2^-21 cells
    let rounded = vec2<i32>(place.fraction * 2097152.0);
    let cell = place.cell + (rounded >> vec2(21u));
    let steps = rounded & vec2(0x1fffff);
    let sides = min(steps, 2097152 - steps);
    var first = Found2d(0x7f800000u, vec2(0), vec2(0u), 0u);
    var second = first;
    // Visit the cell and its neighbors, then the cells around them. Two points are always found there.
    for (var ring = 1; ring <= 2; ring++) {
        let width = 2 * ring + 1;
        for (var i = 0; i < width * width; i++) {
            // Shifts along both axes, in the order 0, 1, -1, 2, -2
            let digits = vec2(i % width, i / width);
            let shift = select((digits + 1) / 2, -digits / 2, (digits & vec2(1)) == vec2(0));
            if ring == 2 && all(abs(shift) < vec2(2)) { continue; }
            // Skip cells that cannot contain a nearer point
            let origin = steps - shift * 2097152;
            let gap = max(max(-origin, origin - 2097152), vec2(0));
            if key_2d(gap, worley.metric, zero) > second.key { continue; }
            let at = wrapped(cell + shift, worley.period.xy);
            let parts = mix_bits(vec4(at, at) ^ vec4(worley.keys[0].xy, worley.keys[1].xy));
            let words = parts.xz ^ parts.yw;
            let count = count_points(worley, words.x);
            for (var index = 0u; index < count; index++) {
                let random = point_words(words, index) >> vec2(11u);
                let point = (random * worley.jitter + 1048576u * (1024u - worley.jitter)) >> vec2(10u);
                let vector = origin - vec2<i32>(point);
                let found = Found2d(key_2d(vector, worley.metric, zero), vector, words, index);
                if is_before_2d(found, second) {
                    second = found;
                    if is_before_2d(found, first) {
                        second = first;
                        first = found;
                    }
                }
            }
        }
        let border = vec2(min(sides.x, sides.y) + ring * 2097152, 0);
        if second.key < key_2d(border, worley.metric, zero) { break; }
    }
    return array(feature_2d(first, worley.metric), feature_2d(second, worley.metric));
}
