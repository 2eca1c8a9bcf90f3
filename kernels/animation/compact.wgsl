// Turns bits into lists: the active pairs of instance and bone, the slots that must be updated because a bone
// at or above them is active, the instances that have any, and the arguments of the indirect dispatches. Lists
// keep the order of instances and, within an instance, of its slots, on every device. There are three stages,
// one dispatch each, or all in one.

import package::wgsl::animation::compact::{WIDTH, compact_params, instances_of, list_instance, scan, scatter, spread};

// One of the constants below.
override STAGE: u32 = 0;

// A thread spreads the active bits of one instance to all slots below them, and counts the active ones.
const SPREAD = 0u;
// One workgroup sums the counts, lists the instances and writes the arguments.
const SCAN = 1u;
// A thread lists the pairs of one word.
const SCATTER = 2u;
// One workgroup does everything, for small crowds where a dispatch costs more than further processors gain.
const ALL = 3u;

@compute @workgroup_size(WIDTH)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * WIDTH + lane;
    if STAGE == SPREAD {
        if index < compact_params.instances {
            spread(index);
        }
    } else if STAGE == SCAN {
        scan(lane, WIDTH);
    } else if STAGE == ALL {
        let own = instances_of(lane, WIDTH);
        for (var instance = own.x; instance < own.y; instance++) {
            spread(instance);
        }
        scan(lane, WIDTH);
        for (var instance = own.x; instance < own.y; instance++) {
            list_instance(instance);
        }
    } else {
        scatter(index);
    }
}
