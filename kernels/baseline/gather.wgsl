// Moves what sampling moves and computes nothing: a thread reads the two keys around a place of three tracks of a bone,
// shared by instances as a clip's are, and writes a local transform's words, each the exclusive or of its two.

struct GatherParams {
    // Bones of all instances.
    pairs: u32,
    bones: u32,
    // Of each track.
    keys: u32,
}

@group(0) @binding(0) var<uniform> params: GatherParams;
// One an instance: key and, as bits, fraction.
@group(0) @binding(1) var<storage, read> places: array<vec2<u32>>;
// Three tracks a bone.
@group(0) @binding(2) var<storage, read> values: array<vec4<u32>>;
// Three a pair.
@group(0) @binding(3) var<storage, read_write> gathered: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let pair = (group.y * groups.x + group.x) * 64u + lane;
    if pair >= params.pairs {
        return;
    }
    let instance = pair / params.bones;
    let first = 3u * (pair - instance * params.bones) * params.keys + places[instance].x;
    let second = first + params.keys;
    let third = second + params.keys;
    let moved = values[first].xyz ^ values[first + 1u].xyz;
    let turned = values[second] ^ values[second + 1u];
    let scaled = values[third].xyz ^ values[third + 1u].xyz;
    gathered[3u * pair] = vec4<u32>(moved, scaled.x);
    gathered[3u * pair + 1u] = turned;
    gathered[3u * pair + 2u] = vec4<u32>(scaled.yz, 0u, 0u);
}
