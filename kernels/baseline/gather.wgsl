// Moves the bytes that the sampling of animations moves, but leaves out the arithmetic. For each bone, a thread reads the two
// keys around the current cursor on three tracks. The thread writes the words of a local transform, each the exclusive or of
// two keys. Instances that play the same clip share its tracks.
import package::wgsl::animation::clip::{SetTrack, first_value_of};
import package::wgsl::animation::instance::AnimationInstance;

// Whether tracks are looked up in tables, as sampling does. If false, tracks are evenly spaced, so that only keys are read.
override TABLES: bool = true;

// Parameters of the kernel `baseline/gather`.
struct GatherParams {
    // Number of bones of all instances together.
    pairs: u32,
    // Number of bones per instance.
    bones: u32,
    // Number of keys per track.
    keys: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: GatherParams;
// Clip and playback of each instance.
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
// Three tracks per bone and clip: translation, rotation and scale.
@group(0) @binding(2) var<storage, read> tracks: array<SetTrack>;
// One cursor per instance, in two words: the key, and the fraction as bits.
@group(0) @binding(3) var<storage, read> cursors: array<vec2<u32>>;
// Values of the keys of all tracks.
@group(0) @binding(4) var<storage, read> values: array<vec4<u32>>;
// Out: three vectors per pair of instance and bone.
@group(0) @binding(5) var<storage, read_write> gathered: array<vec4<u32>>;

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
    let bone = pair - instance * params.bones;
    let cursor = cursors[instance];
    var first = vec3<u32>(0u, 1u, 2u) + 3u * bone;
    // The loaded words are combined so that no load is optimized away.
    var unused = 0u;
    if TABLES {
        let track = 3u * (instances[instance].clip * params.bones + bone);
        let found = array(tracks[track], tracks[track + 1u], tracks[track + 2u]);
        first = vec3<u32>(first_value_of(found[0]), first_value_of(found[1]), first_value_of(found[2]));
        unused = found[0].words.x ^ found[1].words.x ^ found[2].words.x ^ cursor.y;
    } else {
        first *= params.keys;
    }
    first += cursor.x;
    let moved = values[first.x].xyz ^ values[first.x + 1u].xyz;
    let turned = values[first.y] ^ values[first.y + 1u];
    let scaled = values[first.z].xyz ^ values[first.z + 1u].xyz;
    gathered[3u * pair] = vec4<u32>(moved, scaled.x);
    gathered[3u * pair + 1u] = turned;
    gathered[3u * pair + 2u] = vec4<u32>(scaled.yz, unused, 0u);
}
