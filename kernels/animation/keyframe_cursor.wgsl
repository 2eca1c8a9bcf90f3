// Keyframe cursors of instances: for each timeline of an instance's clip, the key before the current time and the fraction of
// the interval to the next key. A thread finds one cursor. With COMPACTED, the kernel handles only listed instances, with all
// their layers. It also finds the base layer's cursors at the look-ahead time.
import package::wgsl::animation::clip::{ClipEntry, KeyframeCursor, Timeline};
import package::wgsl::animation::clock::inside_clip;
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::timeline::keyframe_cursor;

// Whether only listed instances are handled.
override COMPACTED: bool = false;

// Parameters of the kernel `animation/keyframe_cursor`.
struct KeyframeCursorParams {
    // Number of entries in `instances`: layers times instances.
    entries: u32,
    // Number of instances.
    instances: u32,
    // Number of cursors allocated per instance and layer.
    timelines: u32,
    // Elapsed time in seconds, the same for all instances. At elapsed time 0, the clip time of an instance is its `start`.
    elapsed: f32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: KeyframeCursorParams;
// Clip and playback of each instance, layer by layer.
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
// Location of each clip's data in the set.
@group(0) @binding(2) var<storage, read> clips: array<ClipEntry>;
// Timelines of all clips.
@group(0) @binding(3) var<storage, read> timelines: array<Timeline>;
// Binding 4 holds the key times: `times` in wgsl/animation/timeline.wgsl.
// Out: the cursors of all layers, then the base layer's cursors at the look-ahead time.
@group(0) @binding(5) var<storage, read_write> cursors: array<KeyframeCursor>;
// Indices of the listed instances.
@group(0) @binding(6) var<storage, read> updated_instances: array<u32>;
// Arguments of dispatches. In the first vector, w is the number of listed instances.
@group(0) @binding(7) var<storage, read> dispatches: array<vec4<u32>>;
// State of the gate's clip clocks, per instance: z is the time inside the base layer's clip, w the look-ahead time, both as
// bits.
@group(0) @binding(8) var<storage, read> history: array<vec4<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    let at = index / params.timelines;
    var entry = at;
    if COMPACTED {
        // Threads are in the order of instances and, within an instance, of layers. The base layer at the look-ahead time comes
        // last.
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
        // This is the exact time that the gate used, because cursors and gate must agree on the keys that have passed.
        let seen = history[playing];
        if is_ahead && seen.w == seen.z {
            return;
        }
        time = bitcast<f32>(select(seen.z, seen.w, is_ahead));
    }
    cursors[entry * params.timelines + timeline_index] = keyframe_cursor(timeline, time);
}
