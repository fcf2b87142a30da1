// Roof tiles and slates, as `Bricks` of the crate dapple-pattern places them.

// A tile: column and course, the signed distance to its border, and the position on it
struct RoofTile { id: vec2<i32>, depth: vec2<u32>, across: vec2<u32>, down: vec2<u32> }

// A tile relative to the one at a position: `columns` to the right and `courses` below
fn roof_tile(bricks: Bricks, first: Split, y: Split, columns: i32, courses: i32) -> RoofTile {
    let half = vec2(0x3fe00000u, 0u);
    let course = y.cell + courses;
    let x = split_shifted(first, double_negated(brick_shift(bricks, course)));
    let id = brick_wrapped(bricks, vec2(x.cell + columns, course));
    let state = cell_state(bricks.seed, id);
    let left = brick_inset(bricks, state, 0u);
    let right = brick_inset(bricks, state, 1u);
    // The lower end is moved by jitter alone: courses overlap and have no joint.
    let bottom = double_sub(brick_inset(bricks, state, 3u), double_mul(bricks.inset, bricks.unit));
    let size = double_mul(half, double_sub(double_sub(bricks.width, left), right));
    let column = double_sub(double_sub(x.offset, half), double_from_int(columns));
    let at = double_sub(double_mul(column, bricks.width), double_mul(half, double_sub(left, right)));
    let down = double_sub(y.offset, double_from_int(courses));
    var radius = double_min(bricks.rounding, size);
    if bricks.bond.x == 7u { radius = double_min(size, double_mul(vec2(0x3fe80000u, 0u), bricks.height)); }
    let past_x = double_sub(double_abs(at), size);
    let past_y = double_add(double_mul(double_sub(down, vec2(0x3ff00000u, 0u)), bricks.height), bottom);
    return RoofTile(id, brick_corner(past_x, past_y, radius), brick_part(at, size), down);
}

// The visible tile at a position, given in bricks
fn roof_brick(bricks: Bricks, at: Position2d) -> Brick {
    let half = vec2(0x3fe00000u, 0u);
    let x = split_of(at.x);
    let y = split_of(at.y);
    // The tile of the course, or the tile of the next course, which lies below it
    var tile = roof_tile(bricks, x, y, 0, 0);
    if double_is_less(tile.depth, vec2(0u)) {
        let lower = roof_tile(bricks, x, y, 0, 1);
        if !double_is_less(lower.depth, vec2(0u)) { tile = lower; }
    }
    var height = vec2(0u);
    if !double_is_less(tile.depth, vec2(0u)) {
        let rise = double_mul(half, brick_rise(bricks, tile.depth));
        height = double_add(double_mul(half, tile.down), rise);
    }
    return Brick(tile.id, false, tile.across, double_unit(tile.down), height);
}

// Signed distance to the border of the visible part of a tile
fn roof_edge_distance(bricks: Bricks, at: Position2d) -> f32 {
    let x = split_of(at.x);
    let y = split_of(at.y);
    // Of three tiles each of the course above, the position's course, and the course below
    var depths = array(vec2(0u), vec2(0u), vec2(0u));
    for (var i = 0; i < 9; i++) {
        let depth = roof_tile(bricks, x, y, i % 3 - 1, i / 3 - 1).depth;
        depths[i / 3] = select(double_max(depths[i / 3], depth), depth, i % 3 == 0);
    }
    let above = double_negated(depths[0]);
    let own = depths[1];
    let lower = depths[2];
    if !double_is_less(own, vec2(0u)) { return double_to_float(double_min(own, above)); }
    if !double_is_less(lower, vec2(0u)) { return double_to_float(double_min(lower, double_negated(own))); }
    return double_to_float(double_max(own, lower));
}
