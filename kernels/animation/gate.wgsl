// Decides which bones of which instances are sampled this frame. A thread decides for up to 32 bones of one
// instance; with BOUNDED, for all of them, because parents pass what they leave of the error budget to their
// children.
import package::wgsl::animation::gate::{BOUNDED, MODE, gate_params, gate_word, store_word};
import package::wgsl::animation::gated::lods::lods;
import package::wgsl::animation::gated::clip_clocks::clip_clocks;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    let each = select(1u, gate_params.words, MODE == BOUNDED);
    let threads = gate_params.words / each;
    let instance = index / threads;
    if instance >= gate_params.instances {
        return;
    }
    let lod = lods[instance];
    let clip_clock = clip_clocks[instance];
    let first = (index - instance * threads) * each;
    var left = 0u;
    for (var word = first; word < first + each; word++) {
        store_word(instance, word, gate_word(instance, word, lod, clip_clock, &left));
    }
}
