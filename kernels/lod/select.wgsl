// Decides for each instance of a scene whether a view sees it, and at which level of detail. A workgroup handles a block of
// instances, a thread one instance.
import package::wgsl::lod::allowed::{MAX_ALLOWED, allowed_in_model, camera_allows};
import package::wgsl::lod::criterion::criterion_metric;
import package::wgsl::lod::instance::{CELL_SIZE, INSTANCE_ALIVE, INSTANCE_CASTS, Axes, SceneInstance, instance_axes, instance_flags_mask, instance_position};
import package::wgsl::lod::object::{BLOCK, LodObject, NO_OBJECT, OBJECT_LISTS, decision_list, object_flags_shown};
import package::wgsl::lod::transition::transition_decision;
import package::wgsl::lod::view::{POSITION_SLACK, SelectView, VIEW_CAMERAS};

// Allowed displacement of an instance that no view of the frame has seen.
const UNSEEN_ALLOWED: f32 = -1.0;
// Upper bound of all metrics.
const MAX_METRIC: f32 = 3e38;

// The view. Its `blocks` may be fewer than `block_objects` has.
@group(0) @binding(0) var<uniform> view: SelectView;
// The objects.
// length: 1
@group(0) @binding(1) var<storage, read> objects: array<LodObject>;
// Object index of each block of instances. The instances of a block with `NO_OBJECT` are left unchanged.
@group(0) @binding(2) var<storage, read> block_objects: array<u32>;
// The instances of all blocks.
// length: BLOCK * blocks
@group(0) @binding(3) var<storage, read> instances: array<SceneInstance>;
// Out, per instance: the smallest displacement, in model units, that is allowed by the frame's views that see it;
// `UNSEEN_ALLOWED` if none sees it.
// length: BLOCK * blocks
@group(0) @binding(4) var<storage, read_write> allowed: array<f32>;
// Out, per instance: 0 if the view does not see it, else the decision word with list 2 · level + mirrored. In: the decisions of
// the last frame, if `SelectView::is_next` is 1.
// length: BLOCK * blocks
@group(0) @binding(5) var<storage, read_write> decisions: array<u32>;
// Out, per visible instance: three rows of the transform from model space to positions relative to the corner of the view's
// cell.
// length: BLOCK * blocks
@group(0) @binding(6) var<storage, read_write> placements: array<array<vec4<f32>, 3>>;
// Out, per block: the number of its instances in each of `OBJECT_LISTS` lists.
// length: OBJECT_LISTS * blocks
@group(0) @binding(7) var<storage, read_write> counts: array<u32>;
// Out, per instance: the decision of the last frame; 0 if the view was not in it.
// length: BLOCK * blocks
@group(0) @binding(8) var<storage, read_write> last_decisions: array<u32>;

var<workgroup> tally: array<atomic<u32>, 16>;

// Whether the view may see the instance at all, regardless of its position.
fn is_shown(instance: SceneInstance, object: LodObject) -> bool {
    let is_alive = object_flags_shown(object.flags) != 0u && (instance.flags & INSTANCE_ALIVE) != 0u;
    let casts = view.casters == 0u || (instance.flags & INSTANCE_CASTS) != 0u;
    return is_alive && casts && (instance_flags_mask(instance.flags) & view.mask) != 0u;
}

// Whether a sphere reaches into the view volume.
fn is_inside(center: vec3<f32>, radius: f32) -> bool {
    let lengths = length(center) + radius;
    var least = MAX_ALLOWED;
    for (var plane = 0u; plane < 6u; plane++) {
        let side = view.planes[plane];
        least = min(least, dot(side.xyz, center) + side.w + radius + POSITION_SLACK * (lengths + abs(side.w)));
    }
    return least >= 0.0;
}

// A view's result for a visible sphere.
struct Seen {
    // Smallest displacement that the view's cameras allow, in model units.
    allowed: f32,
    // Smallest metric of the view's cameras. It decides the level.
    metric: f32,
}

// Driver workaround: where uniforms alone decide loops and branches, lavapipe compiles the kernel again in each submission. The
// loop therefore also depends on `seen`.
fn seen_by(object: LodObject, center: vec3<f32>, radius: f32, scale: f32) -> Seen {
    let cameras = min(view.camera_count, VIEW_CAMERAS);
    var seen = Seen(MAX_ALLOWED, MAX_METRIC);
    for (var index = 0u; index < select(0u, cameras, seen.allowed >= 0.0); index++) {
        let camera = view.cameras[index];
        let allowed = allowed_in_model(camera_allows(camera, center, radius), scale);
        seen.allowed = min(seen.allowed, allowed);
        seen.metric = min(seen.metric, criterion_metric(object, camera, center, allowed));
    }
    return seen;
}

// The decision word of an instance. Writes its placement and its allowed displacement.
fn decide(index: u32, object: LodObject) -> u32 {
    let instance = instances[index];
    let before = select(allowed[index], UNSEEN_ALLOWED, view.is_first != 0u);
    if is_shown(instance, object) {
        let axes = instance_axes(instance);
        let at = instance_position(instance, view.cell);
        let sphere = instance.bounding_sphere;
        let center = axes.x * sphere.x + axes.y * sphere.y + axes.z * sphere.z + at;
        let scale = max(max(abs(instance.scale.x), abs(instance.scale.y)), abs(instance.scale.z));
        // Grows by the rounding error of the center, so that the sphere still contains the instance.
        let radius = sphere.w * scale + POSITION_SLACK * (length(at) + scale * length(sphere.xyz));
        if is_inside(center, radius) {
            placements[index] = array<vec4<f32>, 3>(
                vec4<f32>(axes.x.x, axes.y.x, axes.z.x, at.x),
                vec4<f32>(axes.x.y, axes.y.y, axes.z.y, at.y),
                vec4<f32>(axes.x.z, axes.y.z, axes.z.z, at.z));
            let seen = seen_by(object, center, radius, scale);
            allowed[index] = select(seen.allowed, min(before, seen.allowed), before >= 0.0);
            let s = instance.scale;
            let is_mirrored = ((s.x < 0.0) != (s.y < 0.0)) != (s.z < 0.0);
            return transition_decision(object, is_mirrored, seen.metric);
        }
    }
    allowed[index] = before;
    return 0u;
}

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
    let decision = decide(index, objects[owner]);
    // Written without motion history too: a branch over uniforms alone would let lavapipe compile the kernel anew.
    last_decisions[index] = select(0u, decisions[index], view.is_next != 0u);
    decisions[index] = decision;
    if decision > 0u {
        atomicAdd(&tally[decision_list(decision) - 1u], 1u);
    }
    workgroupBarrier();
    if lane < OBJECT_LISTS {
        counts[OBJECT_LISTS * block + lane] = atomicLoad(&tally[lane]);
    }
}
