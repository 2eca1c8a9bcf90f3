// Draws the random words of terrain heights and stores them, to measure the arithmetic that generation cannot avoid.
import package::wgsl::hash::threefry2x32;

// Parameters of the kernel `baseline/words`.
struct WordsParams {
    // Key of the random words.
    key: vec2<u32>,
    // Number of vectors of four words.
    vectors: u32,
    // Number of vectors per row (one y).
    vectors_per_row: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: WordsParams;
// Out: random words, row by row.
@group(0) @binding(1) var<storage, read_write> words: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index < params.vectors {
        let x = vec4<u32>(4u * (index % params.vectors_per_row)) + vec4<u32>(0u, 1u, 2u, 3u);
        words[index] = threefry2x32(params.key, x, vec4<u32>(index / params.vectors_per_row)).first;
    }
}
