// Where instances stand in their clips: for each instance and timeline of its clip the key before, and the way to the
// next. A thread finds one of them. With COMPACTED, only for instances of a list, all their layers included, and where
// the base will stand when bones are sampled ahead.
import package::wgsl::animation::clip::ClipEntry;
import package::wgsl::animation::clock::inside_clip;
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::timeline::keyframe_cursor;

override COMPACTED: bool = false;

struct KeyframeCursorParams {
    // Of all layers; and of one.
    entries: u32,
    instances: u32,
    // Room of an instance for its places.
    timelines: u32,
    // Seconds since the instances' starts.
    elapsed: f32,
}

@group(0) @binding(0) var<uniform> params: KeyframeCursorParams;
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
@group(0) @binding(2) var<storage, read> clips: array<ClipEntry>;
// First time and number of keys.
@group(0) @binding(3) var<storage, read> timelines: array<vec2<u32>>;
// Binding 4: the times.
// Key and, as bits, fraction; behind all layers those of the base ahead.
@group(0) @binding(5) var<storage, read_write> cursors: array<vec2<u32>>;
@group(0) @binding(6) var<storage, read> updated_instances: array<u32>;
// Of the first, w: how many instances are listed.
@group(0) @binding(7) var<storage, read> dispatches: array<vec4<u32>>;
// Of each instance of the base what gates saw; z: its time inside the clip, as bits; w: that ahead.
@group(0) @binding(8) var<storage, read> history: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    let at = index / params.timelines;
    var entry = at;
    if COMPACTED {
        // Layer by layer of one instance after another; last, the base ahead.
        let layers = params.entries / params.instances + 1u;
        let listed = at / layers;
        if listed >= dispatches[0].w {
            return;
        }
        entry = updated_instances[listed] + (at - listed * layers) * params.instances;
    }
    let is_ahead = entry >= params.entries;
    if is_ahead && !COMPACTED {
        return;
    }
    let playing = select(entry, entry - params.entries, is_ahead);
    let instance = instances[playing];
    let clip = clips[instance.clip];
    let timeline_index = index - at * params.timelines;
    if timeline_index >= clip.timelines {
        return;
    }
    let timeline = timelines[clip.first_timeline + timeline_index];
    var time = inside_clip(instance.wrap_code, clip.duration, instance.start + instance.rate * params.elapsed);
    if COMPACTED && (is_ahead || entry < params.instances) {
        // To the bit what the gate decided by: a key is passed for both or for neither.
        let seen = history[playing];
        if is_ahead && seen.w == seen.z {
            return;
        }
        time = bitcast<f32>(select(seen.z, seen.w, is_ahead));
    }
    cursors[entry * params.timelines + timeline_index] = keyframe_cursor(timeline.x, timeline.y, time);
}
