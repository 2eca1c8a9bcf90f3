// Where instances stand on the timeline that all bones of their clip share, in whole numbers, and whether anything but
// the time asks for a new pose: what gates decide by. A thread looks at one instance.
import package::wgsl::animation::clip::ClipEntry;
import package::wgsl::animation::clock::clock;
import package::wgsl::animation::instance::AnimationInstance;
import package::wgsl::animation::gating::{Lod, Phase, LOD_HIDDEN, LOD_REFRESH, PHASE_BLENDED, PHASE_FORCED, PHASE_FREE, PHASE_HIDDEN};

struct PhaseParams {
    instances: u32,
    // Room of an instance for its places.
    timelines: u32,
    // Seconds since the instances' starts.
    elapsed: f32,
    // Layers above the base.
    layers: u32,
}

@group(0) @binding(0) var<uniform> params: PhaseParams;
@group(0) @binding(1) var<storage, read> instances: array<AnimationInstance>;
@group(0) @binding(2) var<storage, read> clips: array<ClipEntry>;
// Key and, as bits, fraction.
@group(0) @binding(3) var<storage, read> places: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read> lods: array<Lod>;
// Weights of the layers above the base, layer by layer.
@group(0) @binding(5) var<storage, read> shares: array<f32>;
// The last clip + 1, with BLENDED where layers lay above it, or 0 where no pose is stored; its turns.
@group(0) @binding(6) var<storage, read_write> history: array<vec2<u32>>;
@group(0) @binding(7) var<storage, read_write> phases: array<Phase>;

// After as many turns every bone is sampled again: sums of motion would overflow.
const TURNS_SHIFT = 4u;
const BLENDED = 0x80000000u;

fn is_blended(instance: u32) -> bool {
    var sum = 0.0;
    for (var layer = 0u; layer < params.layers; layer++) {
        sum += shares[layer * params.instances + instance];
    }
    return sum > 0.0;
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index >= params.instances {
        return;
    }
    let instance = instances[index];
    let clip = clips[instance.clip];
    let now = clock(instance.wrap, clip.duration, instance.start + instance.rate * params.elapsed);
    let place = places[index * params.timelines];
    let flags = lods[index].flags;
    let blended = is_blended(index);
    let known = vec2<u32>((instance.clip + 1u) | select(0u, BLENDED, blended), bitcast<u32>(now.turns >> TURNS_SHIFT));
    let last = history[index];
    var verdict = PHASE_FREE;
    if (flags & LOD_HIDDEN) != 0u {
        verdict = PHASE_HIDDEN;
        history[index] = vec2<u32>(0u);
    } else {
        if (flags & LOD_REFRESH) != 0u || last.x != known.x || last.y != known.y {
            verdict = PHASE_FORCED;
        } else if blended {
            verdict = PHASE_BLENDED;
        }
        history[index] = known;
    }
    let fraction = u32(clamp(bitcast<f32>(place.y), 0.0, 1.0) * 65536.0);
    phases[index] = Phase(clip.first_row + place.x, (verdict << 20u) | fraction, now.turns, instance.clip);
}
