// Decides the levels of detail of the instances that a view sees, from their metrics and the decisions of the last frame. A
// workgroup handles a block of instances, a thread one instance.
import package::wgsl::lod::budget_state::BudgetState;
import package::wgsl::lod::object::{BLOCK, LodObject, NO_OBJECT, OBJECT_LISTS, RANKS, UNSEEN_METRIC, metric_bits, metric_mirrored};
import package::wgsl::lod::transition::{NO_LIST, decision_finest, transition_decision, transition_entries};
import package::wgsl::lod::view::SelectView;

// Value of `finest` for an instance that no view of the frame has seen.
const UNSEEN_LEVEL = 0xffffffffu;

// The view. `SelectView::blocks` may be less than the length of `block_objects`.
@group(0) @binding(0) var<uniform> view: SelectView;
// The objects of the scene.
// length: 1
@group(0) @binding(1) var<storage, read> objects: array<LodObject>;
// Object index of each block of instances. The instances of a block with `NO_OBJECT` are left unchanged.
@group(0) @binding(2) var<storage, read> block_objects: array<u32>;
// Metric word of each instance in the view.
// length: BLOCK * blocks
@group(0) @binding(3) var<storage, read> metrics: array<u32>;
// Decision word of each instance. In: the decisions of the last frame, if `SelectView::is_next` is 1. Out: the decisions of
// this frame; 0 if the view does not see the instance.
// length: BLOCK * blocks
@group(0) @binding(4) var<storage, read_write> decisions: array<u32>;
// Out, per instance: the decision word of the last frame; 0 if the view was not in that frame.
// length: BLOCK * blocks
@group(0) @binding(5) var<storage, read_write> last_decisions: array<u32>;
// Out, per block: the number of the block's instances in each of `OBJECT_LISTS` lists.
// length: OBJECT_LISTS * blocks
@group(0) @binding(6) var<storage, read_write> counts: array<u32>;
// Out, per instance: the finest level that the frame's views draw; `UNSEEN_LEVEL` if no view sees the instance.
// length: BLOCK * blocks
@group(0) @binding(7) var<storage, read_write> finest: array<u32>;
// State of the view's triangle budget, with the factors that coarsen levels.
// length: 1
@group(0) @binding(8) var<storage, read> budget: array<BudgetState>;

// Number of the block's instances in each list.
var<workgroup> tally: array<atomic<u32>, 32>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let block = group.y * groups.x + group.x;
    if block >= view.blocks {
        return;
    }
    let owner = block_objects[block];
    if owner == NO_OBJECT {
        return;
    }
    if lane < OBJECT_LISTS {
        atomicStore(&tally[lane], 0u);
    }
    workgroupBarrier();
    let index = BLOCK * block + lane;
    let object = objects[owner];
    let metric = metrics[index];
    let last = select(0u, decisions[index], view.is_next != 0u);
    var decision = 0u;
    if metric != UNSEEN_METRIC {
        let factor = budget[0].factors[object.rank >> 2u][object.rank & 3u];
        let value = bitcast<f32>(metric_bits(metric));
        let ends = budget[0].ends_fades != 0u;
        decision = transition_decision(object, value, factor, metric_mirrored(metric), last, view.seconds, ends);
    }
    last_decisions[index] = last;
    decisions[index] = decision;
    let before = select(finest[index], UNSEEN_LEVEL, view.is_first != 0u);
    finest[index] = before;
    if decision > 0u {
        finest[index] = min(before, decision_finest(decision));
        let entries = transition_entries(object, decision, 0u);
        atomicAdd(&tally[entries.first], 1u);
        if entries.second != NO_LIST {
            atomicAdd(&tally[entries.second], 1u);
        }
    }
    workgroupBarrier();
    if lane < OBJECT_LISTS {
        counts[OBJECT_LISTS * block + lane] = atomicLoad(&tally[lane]);
    }
}
