// Finds the instances of a scene that a view sees, with their metric, placement and allowed displacement. A thread handles one
// instance. `lod/decide` then chooses their levels of detail.
import package::wgsl::dispatch::nonuniform;
import package::wgsl::lod::allowed::{Allowed, MAX_ALLOWED, UNSEEN_ALLOWED, allowed_in_model, camera_allows};
import package::wgsl::lod::criterion::{MAX_METRIC, Placed, criterion_metric};
import package::wgsl::lod::instance::{CELL_SIZE, INSTANCE_ALIVE, INSTANCE_CASTS, Axes, SceneInstance, instance_axes, instance_flags_mask, instance_position};
import package::wgsl::lod::object::{BLOCK, LodObject, NO_OBJECT, UNSEEN_METRIC, decision_seen, metric_word, object_flags_never_culled, object_flags_shown};
import package::wgsl::lod::view::{POSITION_SLACK, SelectView, VIEW_CAMERAS};

// Largest speed in the picture that counts, in picture heights per second.
const MAX_MOTION: f32 = 4.0;

// The view. `SelectView::blocks` may be less than the length of `block_objects`.
@group(0) @binding(0) var<uniform> view: SelectView;
// The objects of the scene.
// length: 1
@group(0) @binding(1) var<storage, read> objects: array<LodObject>;
// Object index of each block of instances. The instances of a block with `NO_OBJECT` are left unchanged.
@group(0) @binding(2) var<storage, read> block_objects: array<u32>;
// The instances of all blocks.
// length: BLOCK * blocks
@group(0) @binding(3) var<storage, read> instances: array<SceneInstance>;
// Out, per instance: the displacement that all views of the frame allow, and the distance of the nearest eye. Only views that
// see the instance count.
// length: BLOCK * blocks
@group(0) @binding(4) var<storage, read_write> allowed: array<Allowed>;
// Out, per instance: the metric word; `UNSEEN_METRIC` if the view does not see the instance.
// length: BLOCK * blocks
@group(0) @binding(5) var<storage, read_write> metrics: array<u32>;
// Three rows per visible instance: the transform from model space to positions relative to the corner of the view's cell. In:
// the rows of the last frame, if `SelectView::is_next` is 1. Out: the rows of this frame.
// length: BLOCK * blocks
@group(0) @binding(6) var<storage, read_write> placements: array<array<vec4<f32>, 3>>;
// Decision word of each instance in the last frame; valid if `SelectView::is_next` is 1.
// length: BLOCK * blocks
@group(0) @binding(7) var<storage, read> decisions: array<u32>;
// One bit per instance: whether its object is drawn in this view with this instance. Objects whose views draw different instances,
// such as endless terrain, clear bits.
// length: 2 * blocks
@group(0) @binding(8) var<storage, read> shown: array<u32>;

// Whether the view may see the instance, regardless of the instance's position.
fn is_shown(index: u32, instance: SceneInstance, object: LodObject) -> bool {
    let is_in_view = ((shown[index / 32u] >> (index % 32u)) & 1u) != 0u;
    let is_alive = object_flags_shown(object.flags) != 0u && (instance.flags & INSTANCE_ALIVE) != 0u;
    let casts = (view.casters == 0u) | ((instance.flags & INSTANCE_CASTS) != 0u);
    return is_in_view && is_alive && casts && (instance_flags_mask(instance.flags) & view.mask) != 0u;
}

// Whether a sphere reaches into the view volume. The center is relative to the corner of the view's cell.
fn is_inside(center: vec3<f32>, radius: f32) -> bool {
    let lengths = length(center) + radius;
    var least = MAX_ALLOWED;
    for (var plane = 0u; plane < 6u; plane++) {
        let side = view.planes[plane];
        least = min(least, dot(side.xyz, center) + side.w + radius + POSITION_SLACK * (lengths + abs(side.w)));
    }
    return least >= 0.0;
}

// Position of a point in the picture, from the picture's middle, in units of half the picture's height. A point behind the eye
// gets a position far outside.
fn in_picture(rows: array<vec4<f32>, 3>, point: vec3<f32>) -> vec2<f32> {
    let at = vec4<f32>(point, 1.0);
    let w = dot(rows[2], at);
    return select(vec2<f32>(1e4), vec2<f32>(dot(rows[0], at), dot(rows[1], at)) / w, w > 0.0);
}

// Factor of the metric for instances that are perceived poorly (thesis A section 6.4): instances that move across the picture,
// and instances away from the picture's middle.
fn perceptual_factor(object: LodObject, index: u32, center: vec3<f32>) -> f32 {
    if object.motion == 0.0 && object.periphery == 0.0 {
        return 1.0;
    }
    let now = in_picture(view.clip_rows, center);
    var speed = 0.0;
    if (decision_seen(decisions[index]) != 0u) & (view.is_next != 0u) & (view.seconds > 0.0) {
        let sphere = instances[index].bounding_sphere;
        let last = placements[index];
        let point = vec4<f32>(sphere.xyz, 1.0);
        let last_center = vec3<f32>(dot(last[0], point), dot(last[1], point), dot(last[2], point));
        // Speed in picture heights per second.
        speed = 0.5 * distance(now, in_picture(view.last_clip_rows, last_center)) / view.seconds;
    }
    return 1.0 + object.motion * min(speed, MAX_MOTION) + object.periphery * min(length(now), 1.0);
}

// Allowed displacement, distance and metric of a visible instance, over all cameras of a view.
struct Seen {
    // Smallest displacement that any of the view's cameras allows, in model units.
    allowed: f32,
    // Smallest distance of the middle of the bounding sphere from any of the view's eyes, in world units.
    distance: f32,
    // Smallest metric in any of the view's cameras, which decides the level.
    metric: f32,
}

// Allowed displacement, distance and metric of a visible instance, over all cameras of the view.
fn seen_by(index: u32, object: LodObject, placed: Placed, scale: f32) -> Seen {
    let cameras = nonuniform(min(view.camera_count, VIEW_CAMERAS), index);
    var seen = Seen(MAX_ALLOWED, MAX_METRIC, MAX_METRIC);
    for (var at = 0u; at < cameras; at++) {
        let camera = view.cameras[at];
        let allowed = allowed_in_model(camera_allows(camera, placed.center, placed.radius), scale);
        seen.allowed = min(seen.allowed, allowed);
        seen.distance = min(seen.distance, camera.perspective * length(placed.center - camera.eye));
        seen.metric = min(seen.metric, criterion_metric(object, camera, placed, allowed));
    }
    return seen;
}

// Metric word of an instance in the view. Also writes the instance's placement and its allowed displacement.
fn metric_of(index: u32, object: LodObject) -> u32 {
    let instance = instances[index];
    let is_first = view.is_first != 0u;
    let before = Allowed(
        select(allowed[index].displacement, UNSEEN_ALLOWED, is_first), select(allowed[index].distance, MAX_METRIC, is_first));
    if is_shown(index, instance, object) {
        let axes = instance_axes(instance);
        let at = instance_position(instance, view.cell);
        let sphere = instance.bounding_sphere;
        let center = axes.x * sphere.x + axes.y * sphere.y + axes.z * sphere.z + at;
        let scale = max(max(abs(instance.scale.x), abs(instance.scale.y)), abs(instance.scale.z));
        // The radius grows by the rounding error of the center, so that the sphere still contains the instance.
        let radius = sphere.w * scale + POSITION_SLACK * (length(at) + scale * length(sphere.xyz));
        if object_flags_never_culled(object.flags) != 0u || is_inside(center, radius) {
            let seen = seen_by(index, object, Placed(axes, at, center, radius), scale);
            let factor = object.metric_scale * perceptual_factor(object, index, center);
            placements[index] = array<vec4<f32>, 3>(
                vec4<f32>(axes.x.x, axes.y.x, axes.z.x, at.x),
                vec4<f32>(axes.x.y, axes.y.y, axes.z.y, at.y),
                vec4<f32>(axes.x.z, axes.y.z, axes.z.z, at.z));
            let is_seen = before.displacement >= 0.0;
            allowed[index] = Allowed(
                select(seen.allowed, min(before.displacement, seen.allowed), is_seen),
                select(seen.distance, min(before.distance, seen.distance), is_seen));
            let s = instance.scale;
            let is_mirrored = ((s.x < 0.0) != (s.y < 0.0)) != (s.z < 0.0);
            return metric_word(bitcast<u32>(min(factor * seen.metric, MAX_METRIC)), u32(is_mirrored));
        }
    }
    allowed[index] = before;
    return UNSEEN_METRIC;
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
    let index = BLOCK * block + lane;
    metrics[index] = metric_of(index, objects[owner]);
}
