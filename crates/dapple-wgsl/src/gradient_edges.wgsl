// Gradients in three and four dimensions: from the center of a (hyper)cube to the middles of its edges.

// Component along `axis` of gradients, which are numbered `pick`; their edges are parallel to the axis `along`
fn edge_component(pick: vec4<u32>, along: vec4<u32>, axis: u32) -> vec4<f32> {
    let shift = select(vec4(max(axis, 1u) - 1u), vec4(axis), along > vec4(axis));
    let component = ((pick >> shift) << vec4(31u)) | vec4(0x3f800000u);
    return bitcast<vec4<f32>>(select(component, vec4(0u), along == vec4(axis)));
}
