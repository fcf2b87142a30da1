// Ids of feature points, as `CellHash` of the crate dapple-hash computes them.

// Absorbs one word into a state
fn absorbed(state: vec2<u32>, word: u32) -> vec2<u32> {
    let a = (state.x ^ word) * 0x9e3779b1u;
    let b = (state.y ^ a ^ (a >> 15u)) * 0x85ebca6bu;
    let c = b ^ (b >> 13u);
    return vec2((a ^ (a >> 15u)) + ((c << 11u) | (c >> 21u)), c);
}

// 64 random bits of a state and a counter: the upper word, then the lower word
fn cell_bits(state: vec2<u32>, counter: u32) -> vec2<u32> {
    let s = absorbed(state, counter);
    let a = (s.x ^ (s.x >> 16u)) * 0xc2b2ae35u;
    let b = (s.y + (a ^ (a >> 15u))) * 0x27d4eb2fu;
    let c = b ^ (b >> 15u);
    let d = (a + c) * 0x85ebca6bu;
    let e = d ^ (d >> 13u);
    let f = (c ^ e) * 0x9e3779b1u;
    let g = f ^ (f >> 16u);
    return vec2(e ^ ((g << 7u) | (g >> 25u)), g);
}
