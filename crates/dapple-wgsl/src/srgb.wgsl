// Codes of 16 bits of sRGB colors, by tables in the data.

// Code of a linear value. The table has, for each code, the smallest number with a larger code.
fn srgb_code(data: texture_2d<u32>, first: u32, linear: f32) -> u32 {
    var code = 0u;
    for (var step = 32768u; step > 0u; step >>= 1u) {
        let border = bitcast<f32>(data_word(data, 4u * first + code + step - 1u));
        code += select(0u, step, linear >= border);
    }
    return code;
}

// The sRGB components of a linear color, from 0 to 1
fn srgb_components(data: texture_2d<u32>, first: u32, color: vec4<f32>, zero: u32) -> vec3<f32> {
    return vec3(
        number_div(f32(srgb_code(data, first, color.x)), 65535.0, zero),
        number_div(f32(srgb_code(data, first, color.y)), 65535.0, zero),
        number_div(f32(srgb_code(data, first, color.z)), 65535.0, zero));
}

// Linear value of a code, from a table of all
fn srgb_linear(data: texture_2d<u32>, first: u32, code: u32) -> f32 {
    return bitcast<f32>(data_word(data, 4u * first + code));
}
