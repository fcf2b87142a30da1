// Signed distances to simple shapes with the values of `Shape` of the crate dapple-pattern.

// The shape: the words of `Shape::shader_words`
struct Shape {
    // Number of the kind, and of corners
    kind: vec2<u32>,
    // Texel of the first corner, and whether the shape is repeated along x, along y, and whether it is a shell
    corners: vec2<u32>,
    cos: vec2<u32>,
    sin: vec2<u32>,
    // Radius of corners, and of a circle that contains the shape
    rounding: vec2<u32>,
    bound: vec2<u32>,
    // Half of the width of a shell, and the width of the edge of a mask
    shell: vec2<u32>,
    edge: vec2<u32>,
    // Lengths of the outline
    first: vec2<u32>,
    second: vec2<u32>,
    // Center in units of the plane, and its offset in a cell of copies
    center_x: vec2<u32>,
    center_y: vec2<u32>,
    offset_x: vec2<u32>,
    offset_y: vec2<u32>,
    frequency_x: vec2<u32>,
    frequency_y: vec2<u32>,
    spacing_x: vec2<u32>,
    spacing_y: vec2<u32>,
}

fn polygon_distance(data: texture_2d<u32>, shape: Shape, at: Position2d) -> vec2<u32> {
    var least = vec2(0u);
    var inside = false;
    let count = shape.kind.y;
    var start = data_words(data, shape.corners.x + count - 1u);
    for (var i = 0u; i < count; i++) {
        let end = data_words(data, shape.corners.x + i);
        let side_x = double_sub(end.xy, start.xy);
        let side_y = double_sub(end.zw, start.zw);
        let x = double_sub(at.x, start.xy);
        let y = double_sub(at.y, start.zw);
        let dot = double_add(double_mul(x, side_x), double_mul(y, side_y));
        let square = double_add(double_mul(side_x, side_x), double_mul(side_y, side_y));
        let along = double_unit(double_div(dot, square));
        let foot_x = double_sub(x, double_mul(along, side_x));
        let foot_y = double_sub(y, double_mul(along, side_y));
        let found = double_add(double_mul(foot_x, foot_x), double_mul(foot_y, foot_y));
        least = select(double_min(least, found), found, i == 0u);
        // Count the sides that a ray to the right crosses
        if double_is_less(at.y, start.zw) != double_is_less(at.y, end.zw) {
            let cross = double_sub(double_mul(side_x, y), double_mul(side_y, x));
            if double_is_negative(cross) == double_is_less(vec2(0u), side_y) { inside = !inside; }
        }
        start = end;
    }
    let distance = double_root(least);
    return select(distance, double_negated(distance), inside);
}

// Distance to a disk without an equal disk, displaced to the right
fn moon_distance(radius: vec2<u32>, displacement: vec2<u32>, at: Position2d) -> vec2<u32> {
    let x = at.x;
    let y = double_abs(at.y);
    // The circles meet at (a, ±b)
    let a = double_mul(vec2(0x3fe00000u, 0u), displacement);
    let square = double_sub(double_mul(radius, radius), double_mul(a, a));
    let b = double_root(double_max(square, vec2(0u)));
    let cross = double_sub(double_mul(x, b), double_mul(y, a));
    let past = double_max(double_sub(b, y), vec2(0u));
    if double_is_less(double_mul(displacement, past), cross) { return double_length(double_sub(x, a), double_sub(y, b)); }
    let outer = double_sub(double_length(x, y), radius);
    return double_max(outer, double_sub(radius, double_length(double_sub(x, displacement), y)));
}

// Distance to a heart with its tip at the origin; y points up
fn heart_distance(at: Position2d) -> vec2<u32> {
    let one = vec2(0x3ff00000u, 0u);
    let x = double_abs(at.x);
    let sum = double_add(x, at.y);
    if double_is_less(one, sum) {
        let y = double_sub(at.y, vec2(0x3fe80000u, 0u));
        let distance = double_length(double_sub(x, vec2(0x3fd00000u, 0u)), y);
        // A quarter of the root of 2
        return double_sub(distance, vec2(0x3fd6a09eu, 0x667f3bcdu));
    }
    let foot = double_mul(vec2(0x3fe00000u, 0u), double_max(sum, vec2(0u)));
    let top = double_length(x, double_sub(at.y, one));
    let distance = double_min(top, double_length(double_sub(x, foot), double_sub(at.y, foot)));
    return select(distance, double_negated(distance), double_is_less(x, at.y));
}

// Distance to the outline about the origin
fn outline_distance(data: texture_2d<u32>, shape: Shape, at: Position2d) -> vec2<u32> {
    let none = vec2(0u);
    switch shape.kind.x {
        case 0u: { return double_sub(double_length(at.x, at.y), shape.first); }
        case 1u: {
            let x = double_sub(double_abs(at.x), shape.first);
            let y = double_sub(double_abs(at.y), shape.second);
            let outside = double_length(double_max(x, none), double_max(y, none));
            return double_add(outside, double_min(double_max(x, y), none));
        }
        case 2u, 3u: { return polygon_distance(data, shape, at); }
        case 4u: {
            let x = double_max(double_sub(double_abs(at.x), shape.first), none);
            return double_sub(double_length(x, at.y), shape.second);
        }
        case 5u: {
            let distance = double_sub(double_length(at.x, at.y), shape.first);
            return double_sub(double_abs(distance), shape.second);
        }
        case 6u: { return moon_distance(shape.first, shape.second, at); }
        default: {
            let y = double_sub(vec2(0x3fe1a827u, 0x999fcef3u), double_div(at.y, shape.first));
            return double_mul(shape.first, heart_distance(Position2d(double_div(at.x, shape.first), y)));
        }
    }
}

// Distance to a copy, from the offset of its center
fn copy_distance(data: texture_2d<u32>, shape: Shape, x: vec2<u32>, y: vec2<u32>) -> vec2<u32> {
    let at = rotated_2d(Position2d(x, y), shape.cos, shape.sin);
    let distance = double_sub(outline_distance(data, shape, at), shape.rounding);
    if (shape.corners.y & 4u) == 0u { return distance; }
    return double_sub(double_abs(distance), shape.shell);
}

// Offset from the nearest center along an axis along which the shape is repeated
fn copy_offset(at: vec2<u32>, frequency: vec2<u32>, center: vec2<u32>) -> vec2<u32> {
    let half = vec2(0x3fe00000u, 0u);
    let place = split_of(double_mul(at, frequency)).offset;
    let cells = split_of(double_add(double_sub(place, center), half)).offset;
    return double_div(double_sub(cells, half), frequency);
}

// Steps to the first and the last copy that can be nearest along an axis
fn copy_steps(offset: vec2<u32>, bound: vec2<u32>, spacing: vec2<u32>) -> vec2<i32> {
    let reach = double_add(bound, double_mul(vec2(0x3fe00000u, 0u), spacing));
    let first = double_negated(double_floor(double_negated(double_div(double_sub(offset, reach), spacing))));
    return vec2(double_to_int(first), double_to_int(double_floor(double_div(double_add(offset, reach), spacing))));
}

// Signed distance to the nearest copy
fn copies_distance(data: texture_2d<u32>, shape: Shape, at: Position2d) -> vec2<u32> {
    var x = double_sub(at.x, shape.center_x);
    var y = double_sub(at.y, shape.center_y);
    var columns = vec2(0);
    var rows = vec2(0);
    if (shape.corners.y & 1u) == 1u {
        x = copy_offset(at.x, shape.frequency_x, shape.offset_x);
        columns = copy_steps(x, shape.bound, shape.spacing_x);
    }
    if (shape.corners.y & 2u) == 2u {
        y = copy_offset(at.y, shape.frequency_y, shape.offset_y);
        rows = copy_steps(y, shape.bound, shape.spacing_y);
    }
    var nearest = vec2(0u);
    // The copy whose center is nearest comes first
    let width = columns.y - columns.x + 1;
    let count = width * (rows.y - rows.x + 1);
    for (var i = -1; i < count; i++) {
        let step = select(vec2(columns.x + i % width, rows.x + i / width), vec2(0), i < 0);
        if i >= 0 && all(step == vec2(0)) { continue; }
        var copy_x = x;
        var copy_y = y;
        if step.x != 0 { copy_x = double_sub(x, double_mul(double_from_int(step.x), shape.spacing_x)); }
        if step.y != 0 { copy_y = double_sub(y, double_mul(double_from_int(step.y), shape.spacing_y)); }
        // Skip copies whose bounding circle is not nearer
        if i >= 0 && !double_is_less(double_sub(double_length(copy_x, copy_y), shape.bound), nearest) { continue; }
        let found = copy_distance(data, shape, copy_x, copy_y);
        nearest = select(double_min(nearest, found), found, i < 0);
    }
    return nearest;
}

fn shape_distance(data: texture_2d<u32>, shape: Shape, at: Position2d) -> f32 {
    return double_to_float(copies_distance(data, shape, at));
}

// 1 inside and 0 outside, with a smooth transition
fn shape_mask(data: texture_2d<u32>, shape: Shape, at: Position2d) -> f32 {
    let half = vec2(0x3fe00000u, 0u);
    let distance = copies_distance(data, shape, at);
    let reach = double_mul(half, shape.edge);
    if !double_is_less(distance, reach) { return 0.0; }
    if !double_is_less(double_negated(reach), distance) { return 1.0; }
    return double_to_float(double_smooth(double_sub(half, double_div(distance, shape.edge))));
}
