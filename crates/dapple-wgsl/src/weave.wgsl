// Woven cloth with the values of `Weave` of the crate dapple-pattern.

// The cloth: the words of `Weave::shader_words`
struct Weave {
    seed: vec2<u32>,
    period: vec2<u32>,
    // Threads in a repeat of the draft, 0 for groups; crossings over, or threads in a group
    draft: vec2<u32>,
    // Shift of the draft between neighboring weft threads; not used
    step: vec2<u32>,
    width: vec2<u32>,
    roundness: vec2<u32>,
    jitter: vec2<u32>,
}

// A thread and a position on it: its set (0 for warp, 1 for weft) and index
struct Thread { id: vec2<i32>, across: vec2<u32>, along: vec2<u32>, height: vec2<u32> }

// Whether the warp thread lies above the weft thread at a crossing
fn is_warp_above(weave: Weave, warp: i32, weft: i32) -> bool {
    let threads = i32(weave.draft.x);
    let over = i32(weave.draft.y);
    if threads == 0 {
        let group = (vec2(warp, weft) - vec2(floor_remainder(warp, over), floor_remainder(weft, over))) / over;
        return ((group.x + group.y) & 1) == 0;
    }
    let shift = i32(weave.step.x) * floor_remainder(weft, threads);
    return floor_remainder(floor_remainder(warp, threads) - shift, threads) < over;
}

// 1 if a thread of a set lies above at a crossing, and 0 if it lies below
fn thread_level(weave: Weave, axis: i32, thread: i32, crossing: i32) -> vec2<u32> {
    let is_weft = axis == 1;
    let warp = select(thread, crossing, is_weft);
    let weft = select(crossing, thread, is_weft);
    return select(vec2(0u), vec2(0x3ff00000u, 0u), is_warp_above(weave, warp, weft) != is_weft);
}

// The thread of one set at a position
fn thread_of(weave: Weave, axis: i32, own: Split, along: Split) -> Thread {
    let one = vec2(0x3ff00000u, 0u);
    let half = vec2(0x3fe00000u, 0u);
    let period = select(weave.period.x, weave.period.y, axis == 1);
    let id = vec2(axis, i32(wrapped(vec2(own.cell), vec2(period)).x));
    // Narrow the thread and displace it within its part of the plane
    let state = cell_state(weave.seed, id);
    let loss = double_mul(double_mul(half, weave.jitter), state_double(state, 2u));
    let width = double_mul(weave.width, double_sub(one, loss));
    let room = double_mul(weave.jitter, double_sub(one, width));
    let center = double_add(half, double_mul(room, double_sub(state_double(state, 3u), half)));
    let across = double_div(double_sub(own.offset, center), double_mul(half, width));
    if !double_is_less(double_abs(across), one) { return Thread(id, across, along.offset, vec2(0u)); }
    // Interpolate between the crossings before and after the position
    let before = split_shifted(along, double_negated(half));
    let start = thread_level(weave, axis, own.cell, before.cell);
    let end = thread_level(weave, axis, own.cell, before.cell + 1);
    let level = double_add(start, double_mul(double_sub(end, start), double_smooth(before.offset)));
    let circle = double_root(double_sub(one, double_mul(across, across)));
    let profile = double_sub(one, double_mul(weave.roundness, double_sub(one, circle)));
    return Thread(id, across, along.offset, double_add(double_mul(half, level), double_mul(half, profile)));
}

// The visible thread at a position, given in threads
fn weave_thread(weave: Weave, at: Position2d) -> Thread {
    var places = array(split_of(at.x), split_of(at.y));
    var threads: array<Thread, 2>;
    for (var axis = 0; axis < 2; axis++) { threads[axis] = thread_of(weave, axis, places[axis], places[1 - axis]); }
    let warp = threads[0];
    let weft = threads[1];
    if double_is_less(weft.height, warp.height) { return warp; }
    if double_is_less(warp.height, weft.height) { return weft; }
    // In a hole, the nearer thread
    if double_is_less(double_abs(weft.across), double_abs(warp.across)) { return weft; }
    return warp;
}

// Position across a thread, from 0 to 1
fn thread_part(across: vec2<u32>) -> f32 {
    let half = vec2(0x3fe00000u, 0u);
    return double_to_float(double_unit(double_add(half, double_mul(half, across))));
}
