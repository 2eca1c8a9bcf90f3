// Draws of single instances, for objects that are drawn instance by instance: a thread writes the draw of a part of an
// instance, of the level of detail at which the view sees it, and the list of that draw.
import package::wgsl::lod::object::{DECISION_LIST, DECISION_MORPH_SHIFT, LIST_MORPH_SHIFT, SceneDraw};

// A part of an instance.
struct Single {
    // The index of the instance.
    instance: u32,
    // The index of the part's first draw.
    first_draw: u32,
    // The index of the instance in its object.
    slot: u32,
}

struct SingleParams {
    // Number of draws.
    count: u32,
}

@group(0) @binding(0) var<uniform> params: SingleParams;
@group(0) @binding(1) var<storage, read> singles: array<Single>;
// For each instance 0 if it is not seen, else 1 + its list in the bits of `DECISION_LIST`, and above how far its level has
// moved to the next one.
@group(0) @binding(2) var<storage, read> decisions: array<u32>;
// For each part of each object a draw for each list.
@group(0) @binding(3) var<storage, read> arguments: array<SceneDraw>;
// One for each of `singles`.
@group(0) @binding(4) var<storage, read_write> draws: array<SceneDraw>;
// The list of each draw, with one entry: the slot, and from bit `LIST_MORPH_SHIFT` on how far the level has moved.
@group(0) @binding(5) var<storage, read_write> entries: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= params.count {
        return;
    }
    let single = singles[index];
    let decision = decisions[single.instance];
    entries[index] = single.slot | ((decision >> DECISION_MORPH_SHIFT) << LIST_MORPH_SHIFT);
    if decision == 0u {
        draws[index] = SceneDraw(0u, 0u, 0u, 0u, 0u);
        return;
    }
    let draw = arguments[single.first_draw + (decision & DECISION_LIST) - 1u];
    draws[index] = SceneDraw(draw.indices, 1u, draw.first_index, draw.base_vertex, 0u);
}
