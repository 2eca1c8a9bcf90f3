// Which bones of which instances are sampled this frame. A thread decides on up to 32 bones of one instance.
import package::wgsl::animation::gate::{gate_params, gate_word};
import package::wgsl::animation::gated::bits::bits;
import package::wgsl::animation::gated::lods::lods;
import package::wgsl::animation::gated::phases::phases;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    let instance = index / gate_params.words;
    if instance < gate_params.instances {
        bits[index] = gate_word(instance, index - instance * gate_params.words, lods[instance], phases[instance]);
    }
}
