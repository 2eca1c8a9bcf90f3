// Clip clock of each instance: its integer position on the common timeline of its clip, and the update reason. Gates decide by
// this clock. A thread handles one instance.
import package::wgsl::animation::clip::{ClipEntry, KeyframeCursor, Timeline};
import package::wgsl::animation::clock::inside_clip;
import package::wgsl::animation::gate_state::{FRACTION_ONE, LOD_FORCED, LOD_HIDDEN, Lod, lod_flags_tier, UPDATE_REASON_BLENDED, UPDATE_REASON_FORCED, UPDATE_REASON_FREE, UPDATE_REASON_HIDDEN, ClipClock, progress_word};
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::timeline::keyframe_cursor;
import package::wgsl::dispatch::nonuniform;

// Parameters of the kernel `animation/clip_clock`.
struct ClipClockParams {
    // Number of instances.
    instances: u32,
    // Elapsed time in seconds, the same for all instances. At elapsed time 0, the clip time of an instance is its `start`.
    elapsed: f32,
    // Number of layers above the base layer.
    layers: u32,
    // Look-ahead in seconds: the time by which bones may be sampled ahead; 0 for none.
    ahead: f32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: ClipClockParams;
// Clip and playback of each instance, layer by layer.
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
// Location of each clip's data in the set.
@group(0) @binding(2) var<storage, read> clips: array<ClipEntry>;
// Timelines of all clips.
@group(0) @binding(3) var<storage, read> timelines: array<Timeline>;
// Binding 4 holds the key times: `times` in wgsl/animation/timeline.wgsl.
// Level of detail of each instance.
@group(0) @binding(5) var<storage, read> lods: array<Lod>;
// Weights of the layers above the base layer, layer by layer, one per instance.
@group(0) @binding(6) var<storage, read> layer_weights: array<f32>;
// State of each instance in the last frame. x: clip + 1, with the skeleton tier from bit TIER_SHIFT on, and with BLENDED if layers
// were above the clip; 0 if no pose is stored. y: hash of the clips of these layers. z: time inside the clip. w: look-ahead time inside the clip. Times are f32 as bits.
@group(0) @binding(7) var<storage, read_write> history: array<vec4<u32>>;
// Out: clip clock of each instance.
@group(0) @binding(8) var<storage, read_write> clip_clocks: array<ClipClock>;

// Flag in the first word of `history`: layers were blended over the clip.
const BLENDED: u32 = 0x80000000u;
// Lowest bit of the skeleton tier in the first word of `history`.
const TIER_SHIFT: u32 = 24u;
// Factor in the hash of the clips above the base layer (`clips_above`).
const CLIP_HASH_FACTOR: u32 = 31u;

// Hash of the clips that play above the base layer; 0 if there are none.
fn clips_above(instance: u32) -> u32 {
    var clips = 0u;
    let layers = nonuniform(params.layers, instance);
    for (var layer = 0u; layer < layers; layer++) {
        let is_heard = layer_weights[layer * params.instances + instance] > 0.0;
        let clip = instances[(layer + 1u) * params.instances + instance].clip;
        clips = CLIP_HASH_FACTOR * clips + select(0u, clip + 1u, is_heard);
    }
    return clips;
}

// Fraction of a cursor in fixed point, in units of 1/FRACTION_ONE.
fn whole_fraction(cursor: KeyframeCursor) -> u32 {
    return u32(clamp(cursor.fraction, 0.0, 1.0) * f32(FRACTION_ONE));
}

// Clip clock of an instance. `flags` are the flags of its `Lod`. Also updates the instance's history.
fn clip_clock_of(index: u32, flags: u32) -> ClipClock {
    let instance = instances[index];
    let clip = clips[instance.clip];
    let time = inside_clip(instance.wrap_code, clip.duration, instance.start + instance.rate * params.elapsed);
    let timeline = timelines[clip.first_timeline];
    let found = keyframe_cursor(timeline, time);
    let seconds = params.elapsed + params.ahead;
    let then = inside_clip(instance.wrap_code, clip.duration, instance.start + instance.rate * seconds);
    let later = select(time, then, params.ahead != 0.0);
    let ahead = keyframe_cursor(timeline, later);
    let above = clips_above(index);
    let tier = lod_flags_tier(flags) << TIER_SHIFT;
    let base = (instance.clip + 1u) | tier | select(0u, BLENDED, above != 0u);
    let known = vec4<u32>(base, above, bitcast<u32>(time), bitcast<u32>(later));
    let last = history[index];
    var reason = UPDATE_REASON_FREE;
    if (flags & LOD_HIDDEN) != 0u {
        reason = UPDATE_REASON_HIDDEN;
        history[index] = vec4<u32>(0u);
    } else {
        if (flags & LOD_FORCED) != 0u || last.x != known.x || last.y != known.y {
            reason = UPDATE_REASON_FORCED;
        } else if above != 0u {
            reason = UPDATE_REASON_BLENDED;
        }
        history[index] = known;
    }
    let own = progress_word(whole_fraction(found), reason);
    return ClipClock(clip.first_row + found.key, own, instance.clip, clip.first_row + ahead.key, whole_fraction(ahead));
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index < params.instances {
        clip_clocks[index] = clip_clock_of(index, lods[index].flags);
    }
}
