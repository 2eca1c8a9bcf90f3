// Clip clocks, gate and lists of a small crowd in one dispatch, for adapters on which a dispatch costs more
// than further processors gain. A thread decides for whole instances, one after another.
import package::wgsl::animation::compact::{Spread, counts, instances_of, list_instance, scan, spread_word};
import package::wgsl::animation::gate::{gate_params, gate_word, store_word};
import package::wgsl::animation::gated::lods::lods;
import package::wgsl::animation::gated::clip_clocks::clip_clocks;
import package::wgsl::animation::clip_clock::clip_clock_of;

// As many lanes as lavapipe runs at once: more would wait for each other at the barrier.
const LANES = 8u;

// Decides for an instance; returns the number of its active bones.
fn decide_instance(instance: u32) -> u32 {
    let lod = lods[instance];
    let clip_clock = clip_clock_of(instance, lod.flags);
    clip_clocks[instance] = clip_clock;
    var so_far = Spread(0u, 0u);
    var left = 0u;
    // The second condition is always true; see `spread` in `compact`.
    for (var word = 0u; word < gate_params.words && so_far.end <= gate_params.bones; word++) {
        let chosen = gate_word(instance, word, lod, clip_clock, &left);
        store_word(instance, word, chosen);
        so_far = spread_word(instance, word, chosen.bits, so_far);
    }
    counts[instance] = so_far.count;
    return so_far.count;
}

@compute @workgroup_size(LANES)
fn main(@builtin(local_invocation_index) lane: u32) {
    let own = instances_of(lane, LANES);
    var found = 0u;
    for (var instance = own.x; instance < own.y; instance++) {
        found += decide_instance(instance);
    }
    scan(lane, LANES);
    if found > 0u {
        for (var instance = own.x; instance < own.y; instance++) {
            list_instance(instance);
        }
    }
}
