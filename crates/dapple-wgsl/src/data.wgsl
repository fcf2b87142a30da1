// Words that a noise looks up, such as its tile or its control points: a texture of the format rgba32uint, 1024 texels
// wide.

// Four words, of which the first has this index times four
fn data_words(data: texture_2d<u32>, quad: u32) -> vec4<u32> {
    return textureLoad(data, vec2(quad & 1023u, quad >> 10u), 0);
}

fn data_word(data: texture_2d<u32>, index: u32) -> u32 { return data_words(data, index >> 2u)[index & 3u]; }
