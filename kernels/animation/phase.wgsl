// Where instances stand on the common timeline of their clip, in whole numbers, and whether anything but
// the time asks for a new pose: what gates decide by. A thread looks at one instance.
import package::wgsl::animation::gated::lods::lods;
import package::wgsl::animation::gated::phases::phases;
import package::wgsl::animation::phase::{phase_of, phase_params};

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index < phase_params.instances {
        phases[index] = phase_of(index, lods[index].flags);
    }
}
