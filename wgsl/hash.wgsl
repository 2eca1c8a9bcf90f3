// Counter-based random words: Threefry-2x32 with 20 rounds (Salmon, Moraes, Dror and Shaw, "Parallel
// random numbers: as easy as 1, 2, 3", SC 2011). Any point can be drawn on its own, in any order.

// Four draws at once, for counters (x[i], y[i]). The lanes are independent.
struct Words {
    first: vec4<u32>,
    second: vec4<u32>,
}

fn rotate_left(value: vec4<u32>, bits: u32) -> vec4<u32> {
    return (value << vec4<u32>(bits)) | (value >> vec4<u32>(32u - bits));
}

fn mix_round(words: Words, bits: u32) -> Words {
    let first = words.first + words.second;
    return Words(first, rotate_left(words.second, bits) ^ first);
}

fn even_rounds(words: Words) -> Words {
    return mix_round(mix_round(mix_round(mix_round(words, 13u), 15u), 26u), 6u);
}

fn odd_rounds(words: Words) -> Words {
    return mix_round(mix_round(mix_round(mix_round(words, 17u), 29u), 16u), 24u);
}

fn inject_key(words: Words, first: u32, second: u32) -> Words {
    return Words(words.first + vec4<u32>(first), words.second + vec4<u32>(second));
}

fn threefry2x32(key: vec2<u32>, x: vec4<u32>, y: vec4<u32>) -> Words {
    let parity = 0x1bd11bdau ^ key.x ^ key.y;
    var words = inject_key(Words(x, y), key.x, key.y);
    words = inject_key(even_rounds(words), key.y, parity + 1u);
    words = inject_key(odd_rounds(words), parity, key.x + 2u);
    words = inject_key(even_rounds(words), key.x, key.y + 3u);
    words = inject_key(odd_rounds(words), key.y, parity + 4u);
    return inject_key(even_rounds(words), parity, key.x + 5u);
}
