// Draws of single instances, for objects that are drawn instance by instance: a thread writes the draw of a part of an
// instance, of the level of detail at which the view sees it, and the list of that draw.
import package::wgsl::lod::object::{SceneDraw, decision_list, decision_morph, list_entry_word};

// A part of an instance.
struct SortedDraw {
    // The index of the instance.
    instance: u32,
    // The index of the part's first draw.
    first_draw: u32,
    // The index of the instance in its object.
    slot: u32,
}

struct SortedParams {
    // Number of draws.
    count: u32,
}

@group(0) @binding(0) var<uniform> params: SortedParams;
// The parts of instances. Their instances and draws must lie inside `decisions` and `arguments`.
// length: sorted
@group(0) @binding(1) var<storage, read> sorted: array<SortedDraw>;
// The decision word of each instance of the scene.
@group(0) @binding(2) var<storage, read> decisions: array<u32>;
// For each part of each object a draw for each list.
@group(0) @binding(3) var<storage, read> arguments: array<SceneDraw>;
// Written: one for each of `sorted`.
// length: sorted
@group(0) @binding(4) var<storage, read_write> draws: array<SceneDraw>;
// Written, for each draw the one entry of its list.
// length: sorted
@group(0) @binding(5) var<storage, read_write> entries: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= params.count {
        return;
    }
    let single = sorted[index];
    let decision = decisions[single.instance];
    entries[index] = list_entry_word(single.slot, decision_morph(decision));
    if decision == 0u {
        draws[index] = SceneDraw(0u, 0u, 0u, 0u, 0u);
        return;
    }
    let draw = arguments[single.first_draw + decision_list(decision) - 1u];
    draws[index] = SceneDraw(draw.index_count, 1u, draw.first_index, draw.base_vertex, 0u);
}
