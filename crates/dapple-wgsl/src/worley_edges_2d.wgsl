// Distances to edges of Voronoi cells, with the bits of `Worley2::edge_distance` of the crate dapple-worley.

// Distance, in units of 2^-21 cells, to the plane between two points, given the vectors from the points in these units
fn plane_distance_2d(first: vec2<i32>, other: vec2<i32>) -> vec2<u32> {
    let between = first - other;
    let sum = first + other;
    if all(between == vec2(0)) { return vec2(0u); }
    // The squares and their sums are exact
    let x = double_from_int(between.x);
    let y = double_from_int(between.y);
    let more = double_add(double_mul(x, double_from_int(sum.x)), double_mul(y, double_from_int(sum.y)));
    let apart = double_root(double_add(double_mul(x, x), double_mul(y, y)));
    return double_div(double_negated(more), double_mul(vec2(0x40000000u, 0u), apart));
}

// The same in cells, with errors of less than 2^-18
fn near_plane_distance_2d(first: vec2<i32>, other: vec2<i32>) -> f32 {
    let between = vec2<f32>(first - other) * (1.0 / 2097152.0);
    let sum = vec2<f32>(first + other) * (1.0 / 2097152.0);
    if all(between == vec2(0.0)) { return 0.0; }
    return -dot(between, sum) * 0.5 * inverseSqrt(dot(between, between));
}

// Distance of a place to the nearest edge of its Voronoi cell, in cells
fn edge_distance_2d(worley: Worley, place: Place2d, zero: u32) -> f32 {
    let features = worley_2d(worley, place, zero);
    let first = vec2<i32>(features[0].vector * 2097152.0);
    let second = vec2<i32>(features[1].vector * 2097152.0);
    var nearest = near_plane_distance_2d(first, second);
    var least = plane_distance_2d(first, second);
    // A point at distance d has its plane at least (d - F1) / 2 away
    let reach = features[0].distance + 2.0 * nearest + 1e-4;
    let rounded = vec2<i32>(place.fraction * 2097152.0);
    let cell = place.cell + (rounded >> vec2(21u));
    let steps = rounded & vec2(0x1fffff);
    // The first point is skipped once
    var is_first = true;
    let rings = i32(reach) + 1;
    for (var row = -rings; row <= rings; row++) {
        for (var column = -rings; column <= rings; column++) {
            let shift = vec2(column, row);
            let origin = steps - shift * 2097152;
            let gap = vec2<f32>(max(max(-origin, origin - 2097152), vec2(0))) * (1.0 / 2097152.0);
            if dot(gap, gap) > reach * reach { continue; }
            let at = wrapped(cell + shift, worley.period.xy);
            let parts = mix_bits(vec4(at, at) ^ vec4(worley.keys[0].xy, worley.keys[1].xy));
            let words = parts.xz ^ parts.yw;
            let count = count_points(worley, words.x);
            for (var index = 0u; index < count; index++) {
                let random = point_words(words, index) >> vec2(11u);
                let point = (random * worley.jitter + 1048576u * (1024u - worley.jitter)) >> vec2(10u);
                let vector = origin - vec2<i32>(point);
                if is_first && all(vector == first) {
                    is_first = false;
                    continue;
                }
                // Compute those planes with 64 bits that may be the nearest one
                let near = near_plane_distance_2d(first, vector);
                if near > nearest + 1e-4 { continue; }
                nearest = min(nearest, near);
                let distance = plane_distance_2d(first, vector);
                if double_is_less(distance, least) { least = distance; }
            }
        }
    }
    if (least.x >> 31u) == 1u { return 0.0; }
    return double_to_float(least) * (1.0 / 2097152.0);
}
