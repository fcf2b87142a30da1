// Hashes of lattice coordinates, four at once, as `LatticeHash` of the crate dapple-hash computes them.

// Bijection in which every input bit flips every output bit about half of the time
fn mix_bits(bits: vec4<u32>) -> vec4<u32> {
    let once = (bits ^ (bits >> vec4(16u))) * 0x7feb352du;
    let twice = (once ^ (once >> vec4(15u))) * 0x846ca68bu;
    return twice ^ (twice >> vec4(16u));
}

// Random bits of corners, given the exclusive or of the hash parts of their coordinates
fn corner_bits(parts: vec4<u32>) -> vec4<u32> {
    let bits = parts * 0xc2b2ae35u;
    return (bits ^ (bits >> vec4(15u))) * 0x85ebca6bu;
}

// Coordinates along two axes, wrapped by their periods; 0 for no period
fn wrapped(cell: vec2<i32>, period: vec2<u32>) -> vec2<u32> {
    let below = period - 1u - vec2<u32>(~cell) % period;
    let inside = select(vec2<u32>(cell) % period, below, cell < vec2(0));
    return select(vec2<u32>(cell), inside, period > vec2(0u));
}
