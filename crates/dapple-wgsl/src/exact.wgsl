// Arithmetic with the bits of the CPU, on four numbers at once. Shader compilers fuse a product and a sum, and reorder
// sums, but not across `exact`, because they do not know that `zero` is 0. Read `zero` from a buffer; a constant has no
// effect.
fn exact(x: vec4<f32>, zero: u32) -> vec4<f32> { return bitcast<vec4<f32>>(bitcast<vec4<u32>>(x) ^ vec4(zero)); }
fn exact_add(a: vec4<f32>, b: vec4<f32>, zero: u32) -> vec4<f32> { return exact(a + b, zero); }
fn exact_sub(a: vec4<f32>, b: vec4<f32>, zero: u32) -> vec4<f32> { return exact(a - b, zero); }
fn exact_mul(a: vec4<f32>, b: vec4<f32>, zero: u32) -> vec4<f32> { return exact(a * b, zero); }
