// Rectangular bricks, as `Bricks` of the crate dapple-pattern places them.

// The cell of a brick: column and course, the position relative to its center, and half of its sides
struct BrickCell {
    id: vec2<i32>,
    is_upright: bool,
    x: vec2<u32>,
    y: vec2<u32>,
    half_width: vec2<u32>,
    half_height: vec2<u32>,
}

// Signed distance to the border of a face, positive inside, and the position across it along both axes
struct BrickDepth { depth: vec2<u32>, u: vec2<u32>, v: vec2<u32> }

// Displacement of the border to the left of a plank, in planks
fn plank_border(bricks: Bricks, column: i32, course: i32) -> vec2<u32> {
    let at = vec2(brick_wrapped(bricks, vec2(column, 0)).x, course);
    let random = double_sub(state_double(cell_state(bricks.ends, at), 0u), vec2(0x3fe00000u, 0u));
    return double_mul(bricks.variation, random);
}

fn plank_cell(bricks: Bricks, first: Split, y: Split) -> BrickCell {
    let one = vec2(0x3ff00000u, 0u);
    let half = vec2(0x3fe00000u, 0u);
    let course = brick_wrapped(bricks, vec2(0, y.cell)).y;
    let x = split_shifted(first, state_double(axis_state(seed_state(bricks.courses), course), 0u));
    var column = x.cell;
    var left = plank_border(bricks, column, course);
    var right = double_add(one, plank_border(bricks, column + 1, course));
    if double_is_less(x.offset, left) {
        column -= 1;
        right = left;
        left = double_sub(plank_border(bricks, column, course), one);
    } else if !double_is_less(x.offset, right) {
        column += 1;
        left = right;
        right = double_add(vec2(0x40000000u, 0u), plank_border(bricks, column + 1, course));
    }
    let middle = double_mul(half, double_add(left, right));
    return BrickCell(vec2(column, y.cell), false,
        double_mul(double_sub(x.offset, middle), bricks.width),
        double_mul(double_sub(y.offset, half), bricks.height),
        double_mul(double_mul(half, double_sub(right, left)), bricks.width),
        double_mul(half, bricks.height));
}

// The cell of a brick of several squares. The position is in the square number `along` of the brick.
fn squares_cell(bricks: Bricks, x: Split, y: Split, is_upright: bool, along: i32) -> BrickCell {
    let half = vec2(0x3fe00000u, 0u);
    let half_length = double_mul(half, double_from_int(i32(bricks.bond.y)));
    var long = x.offset;
    var short = y.offset;
    var sides = array(bricks.width, bricks.height);
    var id = vec2(x.cell - along, y.cell);
    if is_upright {
        long = y.offset;
        short = x.offset;
        sides = array(bricks.height, bricks.width);
        id = vec2(x.cell, y.cell - along);
    }
    let at_long = double_mul(double_sub(double_add(long, double_from_int(along)), half_length), sides[0]);
    let at_short = double_mul(double_sub(short, half), sides[1]);
    let half_long = double_mul(half_length, sides[0]);
    let half_short = double_mul(half, sides[1]);
    if is_upright { return BrickCell(id, true, at_short, at_long, half_short, half_long); }
    return BrickCell(id, false, at_long, at_short, half_long, half_short);
}

fn flemish_cell(bricks: Bricks, first: Split, y: Split) -> BrickCell {
    let half = vec2(0x3fe00000u, 0u);
    let x = split_shifted(first, double_from_int(y.cell & 1));
    let along = double_add(x.offset, double_from_int(x.cell & 1));
    // A stretcher of 4/3 columns, and a header of 2/3
    var column = x.cell & ~1;
    var center = vec2(0x3fe55555u, 0x55555555u);
    var half_width = center;
    if !double_is_less(along, vec2(0x3ff55555u, 0x55555555u)) {
        column += 1;
        center = vec2(0x3ffaaaaau, 0xaaaaaaabu);
        half_width = vec2(0x3fd55555u, 0x55555555u);
    }
    return BrickCell(vec2(column, y.cell), false,
        double_mul(double_sub(along, center), bricks.width),
        double_mul(double_sub(y.offset, half), bricks.height),
        double_mul(half_width, bricks.width),
        double_mul(half, bricks.height));
}

// The cell of the brick at a position
fn brick_cell(bricks: Bricks, x: Split, y: Split) -> BrickCell {
    let half = vec2(0x3fe00000u, 0u);
    let length = i32(bricks.bond.y);
    switch bricks.bond.x {
        case 2u: { return flemish_cell(bricks, x, y); }
        case 3u: {
            // Diagonals of squares: the first half belongs to horizontal bricks, the second half to vertical ones.
            let diagonal = floor_remainder(x.cell - y.cell, 2 * length);
            let is_upright = diagonal >= length;
            return squares_cell(bricks, x, y, is_upright, select(diagonal, 2 * length - 1 - diagonal, is_upright));
        }
        case 4u: {
            let along = vec2(floor_remainder(x.cell, length), floor_remainder(y.cell, length));
            let block = (vec2(x.cell, y.cell) - along) / length;
            let is_upright = ((block.x + block.y) & 1) == 1;
            return squares_cell(bricks, x, y, is_upright, select(along.x, along.y, is_upright));
        }
        case 6u: { return plank_cell(bricks, x, y); }
        default: {
            var at = x;
            if bricks.bond.x == 1u { at = split_shifted(x, double_negated(brick_shift(bricks, y.cell))); }
            return BrickCell(vec2(at.cell, y.cell), false,
                double_mul(double_sub(at.offset, half), bricks.width),
                double_mul(double_sub(y.offset, half), bricks.height),
                double_mul(half, bricks.width),
                double_mul(half, bricks.height));
        }
    }
}

fn brick_depth(bricks: Bricks, cell: BrickCell) -> BrickDepth {
    let half = vec2(0x3fe00000u, 0u);
    let state = cell_state(bricks.seed, brick_wrapped(bricks, cell.id));
    // Move the sides inward: left, right, top and bottom
    var sizes = array(cell.half_width, cell.half_height);
    var places = array(cell.x, cell.y);
    for (var axis = 0u; axis < 2u; axis++) {
        let first = brick_inset(bricks, state, 2u * axis);
        let last = brick_inset(bricks, state, 2u * axis + 1u);
        sizes[axis] = double_sub(sizes[axis], double_mul(half, double_add(first, last)));
        places[axis] = double_sub(places[axis], double_mul(half, double_sub(first, last)));
    }
    let radius = double_min(double_min(bricks.rounding, sizes[0]), sizes[1]);
    let past_x = double_sub(double_abs(places[0]), sizes[0]);
    let past_y = double_sub(double_abs(places[1]), sizes[1]);
    return BrickDepth(
        brick_corner(past_x, past_y, radius),
        brick_part(places[0], sizes[0]),
        brick_part(places[1], sizes[1]));
}

// The brick at a position, given in bricks
fn rectangle_brick(bricks: Bricks, at: Position2d) -> Brick {
    let cell = brick_cell(bricks, split_of(at.x), split_of(at.y));
    let found = brick_depth(bricks, cell);
    let u = select(found.u, found.v, cell.is_upright);
    let v = select(found.v, found.u, cell.is_upright);
    return Brick(brick_wrapped(bricks, cell.id), cell.is_upright, u, v, brick_rise(bricks, found.depth));
}

// Signed distance to the nearest border of a brick
fn rectangle_edge_distance(bricks: Bricks, at: Position2d) -> f32 {
    let x = split_of(at.x);
    let y = split_of(at.y);
    // The own brick, then those at the corners and the middles of the sides of a square
    var reach = vec2(0u);
    var nearest = vec2(0u);
    for (var i = 0; i < 9; i++) {
        let place = select(select(i, i - 1, i <= 4), 4, i == 0);
        let step_x = double_mul(double_from_int(place % 3 - 1), reach);
        let step_y = double_mul(double_from_int(place / 3 - 1), reach);
        var cell = brick_cell(bricks, split_shifted(x, double_mul(step_x, bricks.frequency_x)),
            split_shifted(y, double_mul(step_y, bricks.frequency_y)));
        cell.x = double_sub(cell.x, step_x);
        cell.y = double_sub(cell.y, step_y);
        let depth = brick_depth(bricks, cell).depth;
        if i == 0 {
            if !double_is_less(depth, vec2(0u)) { return double_to_float(depth); }
            reach = double_negated(depth);
            nearest = depth;
        }
        nearest = double_max(nearest, depth);
    }
    return double_to_float(nearest);
}
