// relievo baseline/words: generated from kernels/baseline/words.wgsl

struct Words {
    first: vec4<u32>,
    second: vec4<u32>
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
    let parity = 466688986u ^ key.x ^ key.y;
    var words = inject_key(Words(x, y), key.x, key.y);
    words = inject_key(even_rounds(words), key.y, parity + 1u);
    words = inject_key(odd_rounds(words), parity, key.x + 2u);
    words = inject_key(even_rounds(words), key.x, key.y + 3u);
    words = inject_key(odd_rounds(words), key.y, parity + 4u);
    return inject_key(even_rounds(words), parity, key.x + 5u);
}

struct WordsParams {
    key: vec2<u32>,
    vectors: u32,
    vectors_per_row: u32
}

@group(0) @binding(0)
var<uniform> params: WordsParams;

@group(0) @binding(1)
var<storage, read_write> words: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index < params.vectors {
        let x = vec4<u32>(4u * (index % params.vectors_per_row)) + vec4<u32>(0u, 1u, 2u, 3u);
        words[index] = threefry2x32(params.key, x, vec4<u32>(index / params.vectors_per_row)).first;
    }
}
