// Worley's cellular basis in three dimensions, with the bits of `Worley3` of the crate dapple-worley.

// A feature point: the distance, the vector from the point to the position, and 64 random bits
struct Feature3d {
    distance: f32,
    vector: vec3<f32>,
    id: vec2<u32>,
}

// A point that a search has found: the bits of `key_3d`, the vector in units of 2^-21 cells, and the hash words
// of its cell
struct Found3d {
    key: u32,
    steps: vec3<i32>,
    words: vec2<u32>,
    index: u32,
}

// Length of a vector in units of 2^-21 cells as bits, which are ordered as lengths are; Euclidean lengths are squared
fn key_3d(steps: vec3<i32>, metric: u32, zero: u32) -> u32 {
    let cells = abs(vec4(vec3<f32>(steps) * (1.0 / 2097152.0), 0.0));
    if metric == 2u { return bitcast<u32>(max(max(cells.x, cells.y), cells.z)); }
    let terms = select(cells, exact_mul(cells, cells, zero), metric == 0u);
    return bitcast<u32>(exact_add(terms, exact_add(terms.yyyy, terms.zzzz, zero), zero).x);
}

// Whether a point comes before another one: by distance, then by id, then by vector
fn is_before_3d(a: Found3d, b: Found3d) -> bool {
    if a.key != b.key { return a.key < b.key; }
    let a_id = cell_bits(a.words, 0x80000000u + a.index);
    let b_id = cell_bits(b.words, 0x80000000u + b.index);
    if a_id.x != b_id.x { return a_id.x < b_id.x; }
    if a_id.y != b_id.y { return a_id.y < b_id.y; }
    if a.steps.x != b.steps.x { return a.steps.x > b.steps.x; }
    if a.steps.y != b.steps.y { return a.steps.y > b.steps.y; }
    return a.steps.z > b.steps.z;
}

fn feature_3d(found: Found3d, metric: u32) -> Feature3d {
    let vector = vec3<f32>(found.steps) * (1.0 / 2097152.0);
    let id = cell_bits(found.words, 0x80000000u + found.index);
    var distance = bitcast<f32>(found.key);
    if metric == 0u { distance = exact_root(distance); }
    return Feature3d(distance, vector, id);
}

// The two nearest feature points of a place, nearest first
fn worley_3d(worley: Worley, place: Place3d, zero: u32) -> array<Feature3d, 2> {
    // Round the position down to steps of 2^-21 cells
    let rounded = vec3<i32>(place.fraction * 2097152.0);
    let cell = place.cell + (rounded >> vec3(21u));
    let steps = rounded & vec3(0x1fffff);
    let sides = min(steps, 2097152 - steps);
    var first = Found3d(0x7f800000u, vec3(0), vec2(0u), 0u);
    var second = first;
    // Visit the cell and its neighbors, then the cells around them. Two points are always found in three rings.
    for (var ring = 1; ring <= 3; ring++) {
        let width = 2 * ring + 1;
        for (var i = 0; i < width * width * width; i++) {
            // Shifts along the axes, in the order 0, 1, -1, 2, -2, 3, -3
            let digits = vec3(i % width, i / width % width, i / (width * width));
            let shift = select((digits + 1) / 2, -digits / 2, (digits & vec3(1)) == vec3(0));
            if ring > 1 && all(abs(shift) < vec3(ring)) { continue; }
            // Skip cells that cannot contain a nearer point
            let origin = steps - shift * 2097152;
            let gap = max(max(-origin, origin - 2097152), vec3(0));
            if key_3d(gap, worley.metric, zero) > second.key { continue; }
            let xy = wrapped(cell.xy + shift.xy, worley.period.xy);
            let z = wrapped(cell.zz + shift.zz, worley.period.zz);
            let parts = mix_bits(vec4(xy, xy) ^ vec4(worley.keys[0].xy, worley.keys[1].xy));
            let depth = mix_bits(vec4(z, z) ^ vec4(worley.keys[0].zz, worley.keys[1].zz));
            let words = parts.xz ^ parts.yw ^ depth.xz;
            let count = count_points(worley, words.x);
            for (var index = 0u; index < count; index++) {
                let random = point_words(words, index);
                let last = ((random.x & 0x7ffu) << 10u) | (random.y & 0x3ffu);
                let free = vec3(random >> vec2(11u), last);
                let point = (free * worley.jitter + 1048576u * (1024u - worley.jitter)) >> vec3(10u);
                let vector = origin - vec3<i32>(point);
                let found = Found3d(key_3d(vector, worley.metric, zero), vector, words, index);
                if is_before_3d(found, second) {
                    second = found;
                    if is_before_3d(found, first) {
                        second = first;
                        first = found;
                    }
                }
            }
        }
        let border = vec3(min(min(sides.x, sides.y), sides.z) + ring * 2097152, 0, 0);
        if second.key < key_3d(border, worley.metric, zero) { break; }
    }
    return array(feature_3d(first, worley.metric), feature_3d(second, worley.metric));
}
