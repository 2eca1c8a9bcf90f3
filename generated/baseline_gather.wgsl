// relievo baseline/gather: generated from kernels/baseline/gather.wgsl

struct ClipEntry {
    first_timeline: u32,
    timelines: u32,
    duration: f32,
    first_row: u32
}

struct Timeline {
    first_time: u32,
    keys: u32
}

struct KeyframeCursor {
    key: u32,
    fraction: f32
}

fn cursor_of_words(words: vec2<u32>) -> KeyframeCursor {
    return KeyframeCursor(words.x, bitcast<f32>(words.y));
}

struct SetTrack {
    words: vec2<u32>
}

const CONSTANT: u32 = 1073741823u;

fn timeline_of(track: SetTrack) -> u32 {
    return track_timeline(track.words.x);
}

fn interpolation_of(track: SetTrack) -> u32 {
    return track_interpolation(track.words.x);
}

fn first_value_of(track: SetTrack) -> u32 {
    return track.words.y;
}

fn track_word(timeline: u32, interpolation: u32) -> u32 {
    return timeline | (interpolation << 30u);
}

fn track_timeline(word: u32) -> u32 {
    return word & 1073741823u;
}

fn track_interpolation(word: u32) -> u32 {
    return word >> 30u;
}

struct AnimationInstance {
    clip: u32,
    wrap_code: u32,
    start: f32,
    rate: f32
}

override TABLES: bool = true;

struct GatherParams {
    pairs: u32,
    bones: u32,
    keys: u32
}

@group(0) @binding(0)
var<uniform> params: GatherParams;

@group(0) @binding(1)
var<storage, read> instances: array<AnimationInstance>;

@group(0) @binding(2)
var<storage, read> tracks: array<SetTrack>;

@group(0) @binding(3)
var<storage, read> cursors: array<vec2<u32>>;

@group(0) @binding(4)
var<storage, read> values: array<vec4<u32>>;

@group(0) @binding(5)
var<storage, read_write> gathered: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let pair = (group.y * groups.x + group.x) * 64u + lane;
    if pair >= params.pairs {
        return;
    }
    let instance = pair / params.bones;
    let bone = pair - instance * params.bones;
    let cursor = cursors[instance];
    var first = vec3<u32>(0u, 1u, 2u) + 3u * bone;
    var unused = 0u;
    if TABLES {
        let track = 3u * (instances[instance].clip * params.bones + bone);
        let found = array(tracks[track], tracks[track + 1u], tracks[track + 2u]);
        first = vec3<u32>(first_value_of(found[0]), first_value_of(found[1]), first_value_of(found[2]));
        unused = found[0].words.x ^ found[1].words.x ^ found[2].words.x ^ cursor.y;
    }
    else {
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
