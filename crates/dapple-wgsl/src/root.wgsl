// Square roots with the bits of the CPU: WGSL allows an error of several units in the last place.

// Root of 0 or of a normal number, rounded to nearest
fn exact_root(x: f32) -> f32 {
    return corrected_root(x, sqrt(x));
}

// The same, from an approximation that is wrong by less than 32 units in the last place
fn corrected_root(x: f32, approximation: f32) -> f32 {
    let bits = bitcast<u32>(x);
    if bits == 0u { return 0.0; }
    // Work with integers of 24 bits: `square` is r * r + rest, computed modulo 2^32, where r is the root
    let base = (((bits >> 23u) + 127u) >> 1u) << 23u;
    let square = ((bits & 0x7fffffu) | 0x800000u) << (24u - ((bits >> 23u) & 1u));
    var r = bitcast<u32>(approximation) - base + 0x800000u;
    var rest = i32(square - r * r);
    for (var steps = 0u; steps < 32u; steps++) {
        // r is the nearest integer if -r < rest <= r
        if rest > i32(r) {
            rest -= i32(2u * r + 1u);
            r++;
        } else if rest <= -i32(r) {
            rest += i32(2u * r - 1u);
            r--;
        } else {
            break;
        }
    }
    return bitcast<f32>(base + r - 0x800000u);
}
