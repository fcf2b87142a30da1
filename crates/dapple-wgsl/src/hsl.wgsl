// Hue, saturation and lightness of sRGB components, as A. R. Smith defines them (1978).

// The smallest and the largest component
fn color_ends(rgb: vec3<f32>, zero: u32) -> vec2<f32> {
    return vec2(
        number_min(number_min(rgb.x, rgb.y, zero), rgb.z, zero),
        number_max(number_max(rgb.x, rgb.y, zero), rgb.z, zero));
}

// Hue in turns, from 0 to below 1; 0 for a gray
fn color_hue(rgb: vec3<f32>, zero: u32) -> f32 {
    let ends = color_ends(rgb, zero);
    let chroma = number_sub(ends.y, ends.x, zero);
    if chroma <= 0.0 { return 0.0; }
    var sextants = 0.0;
    if ends.y == rgb.x {
        sextants = number_div(number_sub(rgb.y, rgb.z, zero), chroma, zero);
    } else if ends.y == rgb.y {
        sextants = number_add(2.0, number_div(number_sub(rgb.z, rgb.x, zero), chroma, zero), zero);
    } else {
        sextants = number_add(4.0, number_div(number_sub(rgb.x, rgb.y, zero), chroma, zero), zero);
    }
    let turns = number_div(sextants, 6.0, zero);
    return number_sub(turns, floor(turns), zero);
}

// Saturation relative to the largest component (HSV)
fn color_saturation(rgb: vec3<f32>, zero: u32) -> f32 {
    let ends = color_ends(rgb, zero);
    if ends.y <= 0.0 { return 0.0; }
    return number_div(number_sub(ends.y, ends.x, zero), ends.y, zero);
}

// `1 - |2 lightness - 1|`: the largest difference of components
fn chroma_room(lightness: f32, zero: u32) -> f32 {
    let twice = number_mul(2.0, lightness, zero);
    return number_sub(1.0, abs(number_sub(twice, 1.0, zero)), zero);
}

// Color with turns added to the hue, and factors of the saturation and the lightness. The tables are those of `srgb`.
fn changed_color(
    data: texture_2d<u32>, tables: vec2<u32>, color: vec4<f32>, turns: f32, more: f32, lighter: f32, zero: u32,
) -> vec4<f32> {
    if turns == 0.0 && more == 1.0 && lighter == 1.0 { return color; }
    let rgb = srgb_components(data, tables.x, color, zero);
    let ends = color_ends(rgb, zero);
    let middle = number_mul(0.5, number_add(ends.x, ends.y, zero), zero);
    let room = chroma_room(middle, zero);
    var part = 0.0;
    if room > 0.0 { part = number_div(number_sub(ends.y, ends.x, zero), room, zero); }
    let lightness = number_clamp(number_mul(middle, lighter, zero), 0.0, 1.0, zero);
    let saturation = number_clamp(number_mul(part, more, zero), 0.0, 1.0, zero);
    let chroma = number_mul(saturation, chroma_room(lightness, zero), zero);
    let hue = number_add(color_hue(rgb, zero), turns, zero);
    // Each component is a trapezoid wave of the hue
    var phases = array(0.0, -0.33333334, -0.6666667);
    var changed: array<f32, 3>;
    for (var i = 0u; i < 3u; i++) {
        let phase = number_add(hue, phases[i], zero);
        let t = number_mul(6.0, number_sub(phase, floor(phase), zero), zero);
        let distance = abs(number_sub(t, 3.0, zero));
        let wave = number_clamp(number_sub(distance, 1.0, zero), 0.0, 1.0, zero);
        let offset = number_mul(chroma, number_sub(wave, 0.5, zero), zero);
        let component = number_mul(number_add(lightness, offset, zero), 65535.0, zero);
        let code = u32(clamp(number_add(component, 0.5, zero), 0.0, 65535.0));
        changed[i] = srgb_linear(data, tables.y, code);
    }
    return vec4(changed[0], changed[1], changed[2], 0.0);
}
