// Hexagonal tiles, as `Bricks` of the crate dapple-pattern places them.

// A hexagon: column and course, and the position relative to its center
struct HexagonCell { id: vec2<i32>, x: vec2<u32>, y: vec2<u32> }

// Half of the width and height of a hexagon and of a square around it, then for each of eight neighbors the vector to its
// center, and the unit normal and the distance of the half-plane of positions that are nearer: the words of
// `Bricks::hexagon_words`
struct HexagonSides { words: array<vec2<u32>, 43> }

// The hexagon whose center is nearest
fn hexagon_at(bricks: Bricks, x: Split, y: Split) -> HexagonCell {
    let half = vec2(0x3fe00000u, 0u);
    var found = HexagonCell(vec2(0), vec2(0u), vec2(0u));
    var least = vec2(0u);
    for (var i = 0; i < 15; i++) {
        let columns = i % 3 - 1;
        let courses = i / 3 - 2;
        let course = y.cell + courses;
        let center_x = double_mul(half, double_from_int(2 * columns + 1 + (course & 1)));
        let center_y = double_mul(half, double_from_int(2 * courses + 1));
        let at_x = double_mul(double_sub(x.offset, center_x), bricks.width);
        let at_y = double_mul(double_sub(y.offset, center_y), bricks.height);
        let square = double_add(double_mul(at_x, at_x), double_mul(at_y, at_y));
        if i == 0 || double_is_less(square, least) {
            found = HexagonCell(vec2(x.cell + columns, course), at_x, at_y);
            least = square;
        }
    }
    return found;
}

// Signed distance to a line, positive on the side of the origin
fn line_depth(normal_x: vec2<u32>, normal_y: vec2<u32>, distance: vec2<u32>, x: vec2<u32>, y: vec2<u32>) -> vec2<u32> {
    return double_sub(distance, double_add(double_mul(normal_x, x), double_mul(normal_y, y)));
}

// Distance of a point, given relative to the start of a line segment, to the segment
fn segment_distance(x: vec2<u32>, y: vec2<u32>, side_x: vec2<u32>, side_y: vec2<u32>) -> vec2<u32> {
    let square = double_add(double_mul(side_x, side_x), double_mul(side_y, side_y));
    var part = vec2(0u);
    // A segment of length 0 is a point.
    if square.x > 0u {
        let along = double_add(double_mul(x, side_x), double_mul(y, side_y));
        part = double_unit(double_div(along, square));
    }
    return double_length(
        double_sub(x, double_mul(part, side_x)),
        double_sub(y, double_mul(part, side_y)));
}

// Signed distance to the border of a hexagon's face, positive inside
fn hexagon_depth(bricks: Bricks, sides: HexagonSides, cell: HexagonCell) -> vec2<u32> {
    var known = sides.words;
    let state = cell_state(bricks.seed, brick_wrapped(bricks, cell.id));
    // Move the sides inward
    var distances: array<vec2<u32>, 8>;
    var least = vec2(0u);
    for (var i = 0u; i < 8u; i++) {
        distances[i] = double_sub(known[7u + 5u * i], brick_inset(bricks, state, i));
        least = select(double_min(least, distances[i]), distances[i], i == 0u);
    }
    // Inset the polygon by the radius of the corners, at most 0.9 of the least distance
    let radius = double_min(bricks.rounding, double_mul(vec2(0x3fecccccu, 0xcccccccdu), least));
    var inside = vec2(0u);
    for (var i = 0u; i < 8u; i++) {
        distances[i] = double_sub(distances[i], radius);
        let depth = line_depth(known[5u + 5u * i], known[6u + 5u * i], distances[i], cell.x, cell.y);
        inside = select(double_min(inside, depth), depth, i == 0u);
    }
    if !double_is_negative(inside) { return double_add(radius, inside); }
    // Clip a square by all sides (Sutherland and Hodgman)
    let plus = known[2];
    let minus = double_negated(plus);
    var corners: array<vec4<u32>, 12>;
    corners[0] = vec4(minus, minus);
    corners[1] = vec4(plus, minus);
    corners[2] = vec4(plus, plus);
    corners[3] = vec4(minus, plus);
    var count = 4u;
    for (var i = 0u; i < 8u; i++) {
        var clipped: array<vec4<u32>, 12>;
        var kept = 0u;
        for (var j = 0u; j < count; j++) {
            let corner = corners[j];
            let next = corners[(j + 1u) % count];
            let x = known[5u + 5u * i];
            let y = known[6u + 5u * i];
            let start = line_depth(x, y, distances[i], corner.xy, corner.zw);
            let end = line_depth(x, y, distances[i], next.xy, next.zw);
            let is_start_inside = !double_is_negative(start);
            if is_start_inside {
                clipped[min(kept, 11u)] = corner;
                kept++;
            }
            if is_start_inside == double_is_negative(end) {
                let part = double_div(start, double_sub(start, end));
                clipped[min(kept, 11u)] = vec4(
                    double_add(corner.xy, double_mul(part, double_sub(next.xy, corner.xy))),
                    double_add(corner.zw, double_mul(part, double_sub(next.zw, corner.zw))));
                kept++;
            }
        }
        corners = clipped;
        count = min(kept, 12u);
    }
    var distance = vec2(0u);
    for (var i = 0u; i < count; i++) {
        let corner = corners[i];
        let next = corners[(i + 1u) % count];
        let found = segment_distance(
            double_sub(cell.x, corner.xy), double_sub(cell.y, corner.zw),
            double_sub(next.xy, corner.xy), double_sub(next.zw, corner.zw));
        distance = select(double_min(distance, found), found, i == 0u);
    }
    return double_sub(radius, distance);
}

// The hexagon at a position, given in bricks
fn hexagon_brick(bricks: Bricks, sides: HexagonSides, at: Position2d) -> Brick {
    let cell = hexagon_at(bricks, split_of(at.x), split_of(at.y));
    let rise = brick_rise(bricks, hexagon_depth(bricks, sides, cell));
    let u = brick_part(cell.x, sides.words[0]);
    let v = brick_part(cell.y, sides.words[1]);
    return Brick(brick_wrapped(bricks, cell.id), false, u, v, rise);
}

// Signed distance to the nearest border of a hexagon
fn hexagon_edge_distance(bricks: Bricks, sides: HexagonSides, at: Position2d) -> f32 {
    var known = sides.words;
    let cell = hexagon_at(bricks, split_of(at.x), split_of(at.y));
    var depth = hexagon_depth(bricks, sides, cell);
    if !double_is_negative(depth) { return double_to_float(depth); }
    for (var i = 0; i < 8; i++) {
        // Left, right, then in the courses above and below, and two courses away
        let courses = select(select(select(2, -2, i == 6), select(1, -1, i < 4), i < 6), 0, i < 2);
        let columns = select(select(0, -1, (i & 1) == 0), select(1, -1, i == 0), i < 2);
        let shift = select(0, cell.id.y & 1, (courses & 1) == 1);
        let near = HexagonCell(
            cell.id + vec2(select(columns, 0, i >= 6) + shift, courses),
            double_sub(cell.x, known[3 + 5 * i]),
            double_sub(cell.y, known[4 + 5 * i]));
        depth = double_max(depth, hexagon_depth(bricks, sides, near));
    }
    return double_to_float(depth);
}
