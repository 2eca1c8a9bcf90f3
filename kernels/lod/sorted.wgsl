// Sorted draws, for objects that are drawn instance by instance. A thread writes the draw of one part of one instance, and the
// draw's list entry. The level of detail comes from the view's decision word for the instance.
import package::wgsl::lod::object::{LodObject, SceneDraw};
import package::wgsl::lod::transition::sorted_entry;

// A draw of one part of one instance.
struct SortedDraw {
    // Index of the instance in the scene.
    instance: u32,
    // Index in `arguments` of the part's first draw.
    first_draw: u32,
    // Index of the instance in its object.
    slot: u32,
    // Index of the object.
    object: u32,
}

// Parameters of the kernel `lod/sorted`.
struct SortedParams {
    // Number of sorted draws.
    count: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: SortedParams;
// The parts to draw. Their instances, first draws and objects must be valid indices of `decisions`, `arguments` and `objects`.
// length: sorted
@group(0) @binding(1) var<storage, read> sorted: array<SortedDraw>;
// Decision word of each instance of the scene.
@group(0) @binding(2) var<storage, read> decisions: array<u32>;
// Arguments of draws: one draw per list, for each part of each object.
@group(0) @binding(3) var<storage, read> arguments: array<SceneDraw>;
// Out: one draw per entry of `sorted`.
// length: sorted
@group(0) @binding(4) var<storage, read_write> draws: array<SceneDraw>;
// Out: the single list entry of each draw.
// length: sorted
@group(0) @binding(5) var<storage, read_write> entries: array<u32>;
// The objects of the scene.
// length: 1
@group(0) @binding(6) var<storage, read> objects: array<LodObject>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= params.count {
        return;
    }
    let single = sorted[index];
    let decision = decisions[single.instance];
    if decision == 0u {
        entries[index] = single.slot;
        draws[index] = SceneDraw(0u, 0u, 0u, 0u, 0u);
        return;
    }
    let entry = sorted_entry(objects[single.object], decision, single.slot);
    entries[index] = entry.word;
    let draw = arguments[single.first_draw + entry.list];
    draws[index] = SceneDraw(draw.index_count, 1u, draw.first_index, draw.base_vertex, 0u);
}
