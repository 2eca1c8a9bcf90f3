// Counter-based random words: Threefry-2x32 with 20 rounds (Salmon et al. 2011, docs/sources.md). The word of any counter can
// be computed on its own, in any order.

// Results of four random draws, one per lane, for the four counters of `threefry2x32`. The lanes are independent. All 64 bits
// of a lane are uniform.
struct Words {
    // First 32 random bits of each draw.
    first: vec4<u32>,
    // Further 32 random bits of each draw.
    second: vec4<u32>,
}

// Rotates each lane by 1 to 31 bits.
fn rotate_left(value: vec4<u32>, bits: u32) -> vec4<u32> {
    return (value << vec4<u32>(bits)) | (value >> vec4<u32>(32u - bits));
}

// One round of the cipher: adds, rotates by `bits` and combines by exclusive or.
fn mix_round(words: Words, bits: u32) -> Words {
    let first = words.first + words.second;
    return Words(first, rotate_left(words.second, bits) ^ first);
}

// Four rounds with the first set of rotations: rounds 1 to 4, 9 to 12 and 17 to 20 of the cipher.
fn even_rounds(words: Words) -> Words {
    return mix_round(mix_round(mix_round(mix_round(words, 13u), 15u), 26u), 6u);
}

// Four rounds with the second set of rotations: rounds 5 to 8 and 13 to 16 of the cipher.
fn odd_rounds(words: Words) -> Words {
    return mix_round(mix_round(mix_round(mix_round(words, 17u), 29u), 16u), 24u);
}

// Adds two words of the key to the state. The cipher does this between groups of four rounds.
fn inject_key(words: Words, first: u32, second: u32) -> Words {
    return Words(words.first + vec4<u32>(first), words.second + vec4<u32>(second));
}

// Random words for a key and the four counters (x[i], y[i]), which may have any values.
fn threefry2x32(key: vec2<u32>, x: vec4<u32>, y: vec4<u32>) -> Words {
    let parity = 0x1bd11bdau ^ key.x ^ key.y;
    var words = inject_key(Words(x, y), key.x, key.y);
    words = inject_key(even_rounds(words), key.y, parity + 1u);
    words = inject_key(odd_rounds(words), parity, key.x + 2u);
    words = inject_key(even_rounds(words), key.x, key.y + 3u);
    words = inject_key(odd_rounds(words), key.y, parity + 4u);
    return inject_key(even_rounds(words), parity, key.x + 5u);
}
