// The integer position of each instance on the common timeline of its clip, and the reason, other than time, to
// update its pose. Gates decide by these. A thread handles one instance.
import package::wgsl::animation::gated::lods::lods;
import package::wgsl::animation::gated::clip_clocks::clip_clocks;
import package::wgsl::animation::clip_clock::{clip_clock_of, clip_clock_params};

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index < clip_clock_params.instances {
        clip_clocks[index] = clip_clock_of(index, lods[index].flags);
    }
}
