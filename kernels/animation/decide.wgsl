// Phases, gate and lists of a small crowd in one dispatch, where a dispatch costs more than other processors gain. A
// thread decides on whole instances, one after another.
import package::wgsl::animation::compact::{instances_of, list_instance, scan, spread};
import package::wgsl::animation::gate::gate_instance;
import package::wgsl::animation::gated::phases::phases;
import package::wgsl::animation::phase::phase_of;

// As many as lavapipe runs at once: where there are more, they wait for each other at the barrier.
const LANES = 8u;

@compute @workgroup_size(8)
fn main(@builtin(local_invocation_index) lane: u32) {
    let own = instances_of(lane, LANES);
    for (var instance = own.x; instance < own.y; instance++) {
        let phase = phase_of(instance);
        phases[instance] = phase;
        gate_instance(instance, phase);
        spread(instance);
    }
    scan(lane, LANES);
    for (var instance = own.x; instance < own.y; instance++) {
        list_instance(instance);
    }
}
