// relievo lod/select: generated from kernels/lod/select.wgsl

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

const ALLOWED_MARGIN: f32 = 0.9999;

const MAX_ALLOWED: f32 = 1000000000.0;

const LEAST_SCALE: f32 = 1e-9;

struct Allowed {
    displacement: f32,
    distance: f32
}

const UNSEEN_ALLOWED: f32 = -1.0;

fn camera_allows(camera: LodCamera, center: vec3<f32>, radius: f32) -> f32 {
    if camera.perspective == 0.0 {
        return ALLOWED_MARGIN * (camera.pixels / camera.focal);
    }
    let towards = center - camera.eye;
    let ahead = dot(camera.ahead, towards);
    let aside = length(towards - ahead * camera.ahead);
    let around = radius + POSITION_SLACK * (length(center) + length(camera.eye) + radius);
    let is_behind = ahead + around < 0.0;
    let depth = select(ahead, length(towards), is_behind) - around;
    let across = select(aside + around, 0.0, is_behind);
    if depth <= camera.near {
        return 0.0;
    }
    let cosine = depth / sqrt(depth * depth + across * across);
    let allowed = ALLOWED_MARGIN * (camera.pixels * cosine * depth / (camera.focal + camera.pixels * cosine));
    return select(allowed, 0.0, depth - allowed <= camera.near);
}

fn allowed_in_model(allowed: f32, scale: f32) -> f32 {
    return min(allowed / max(scale, LEAST_SCALE), MAX_ALLOWED);
}

const CRITERION_ERROR = 0u;

const CRITERION_DISTANCE = 1u;

const CRITERION_POINT = 2u;

const CRITERION_NEAREST = 3u;

const CRITERION_BOX = 4u;

const CRITERION_SPHERE = 5u;

const CRITERION_MAGNIFICATION = 6u;

const MAX_METRIC: f32 = 3e38;

struct Placed {
    axes: Axes,
    at: vec3<f32>,
    center: vec3<f32>,
    radius: f32
}

fn placed_point(placed: Placed, point: vec3<f32>) -> vec3<f32> {
    return placed.axes.x * point.x + placed.axes.y * point.y + placed.axes.z * point.z + placed.at;
}

fn distance_to_box(object: LodObject, placed: Placed, eye: vec3<f32>) -> f32 {
    let towards = eye - placed_point(placed, object.point);
    var nearest = vec3<f32>(0.0);
    for (var axis = 0u; axis < 3u; axis++) {
        let along = axis_of(placed.axes, axis);
        let coordinate = dot(along, towards) / max(dot(along, along), 1e-30);
        nearest += along * clamp(coordinate, -object.half_size[axis], object.half_size[axis]);
    }
    return length(towards - nearest);
}

fn axis_of(axes: Axes, axis: u32) -> vec3<f32> {
    if axis == 0u {
        return axes.x;
    }
    return select(axes.y, axes.z, axis == 2u);
}

fn box_area(object: LodObject, placed: Placed, camera: LodCamera) -> f32 {
    let middle = placed_point(placed, object.point);
    var area = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let half = object.half_size[axis] * axis_of(placed.axes, axis);
        let one = (axis + 1u) % 3u;
        let two = (axis + 2u) % 3u;
        let across = object.half_size[one] * axis_of(placed.axes, one);
        let along = object.half_size[two] * axis_of(placed.axes, two);
        let normal = cross(across, along);
        var offset = dot(normal, camera.eye - middle);
        if camera.perspective == 0.0 {
            offset = -dot(normal, camera.ahead) * MAX_METRIC;
        }
        let reach = dot(normal, half);
        if abs(offset) > abs(reach) {
            let side = select(-1.0, 1.0, (offset > 0.0) == (reach > 0.0));
            area += face_area(camera, middle + side * half, across, along);
        }
    }
    return area;
}

fn face_area(camera: LodCamera, middle: vec3<f32>, across: vec3<f32>, along: vec3<f32>) -> f32 {
    let a = on_screen(camera, middle - across - along);
    let b = on_screen(camera, middle + across - along);
    let c = on_screen(camera, middle + across + along);
    let d = on_screen(camera, middle - across + along);
    return 0.5 * length(cross(c - a, d - b));
}

fn on_screen(camera: LodCamera, point: vec3<f32>) -> vec3<f32> {
    let towards = point - camera.eye;
    if camera.perspective == 0.0 {
        return camera.focal * (towards - dot(towards, camera.ahead) * camera.ahead);
    }
    let depth = dot(towards, camera.ahead);
    return camera.focal * (towards - depth * camera.ahead) / max(depth, max(camera.near, 1e-9));
}

fn depth_of(camera: LodCamera, center: vec3<f32>) -> f32 {
    if camera.perspective == 0.0 {
        return 1.0;
    }
    return max(dot(camera.ahead, center - camera.eye), max(camera.near, 1e-9));
}

fn criterion_metric(object: LodObject, camera: LodCamera, placed: Placed, allowed: f32) -> f32 {
    switch object_flags_criterion(object.flags) {
        case CRITERION_DISTANCE {
            return camera.perspective * distance(placed.center, camera.eye);
        }
        case CRITERION_POINT {
            return camera.perspective * distance(placed_point(placed, object.point), camera.eye);
        }
        case CRITERION_NEAREST {
            return camera.perspective * distance_to_box(object, placed, camera.eye);
        }
        case CRITERION_BOX {
            return metric_of_area(camera, box_area(object, placed, camera));
        }
        case CRITERION_SPHERE {
            let radius = camera.focal * placed.radius / depth_of(camera, placed.center);
            return metric_of_area(camera, 3.14159274 * radius * radius);
        }
        case CRITERION_MAGNIFICATION {
            return depth_of(camera, placed.center) / camera.focal;
        }
        case default {
            return allowed;
        }
    }
}

fn metric_of_area(camera: LodCamera, area: f32) -> f32 {
    return min(sqrt(camera.pixel_count / max(area, 1e-30)), MAX_METRIC);
}

const CELL_SIZE: f32 = 256.0;

const INSTANCE_ALIVE = 1u;

const INSTANCE_CASTS = 2u;

const INSTANCE_CARRIES = 4u;

const INSTANCE_FOLLOWS = 8u;

const INSTANCE_WHOLE = 16u;

struct SceneInstance {
    cell: vec3<i32>,
    flags: u32,
    offset: vec3<f32>,
    user_data: u32,
    rotation: vec4<f32>,
    scale: vec3<f32>,
    tint: u32,
    bounding_sphere: vec4<f32>
}

struct Axes {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>
}

fn instance_axes(instance: SceneInstance) -> Axes {
    let q = instance.rotation;
    let s = instance.scale;
    let x = vec3<f32>(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3<f32>(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let z = vec3<f32>(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return Axes(s.x * x, s.y * y, s.z * z);
}

fn instance_position(instance: SceneInstance, cell: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(instance.cell - cell) * CELL_SIZE + instance.offset;
}

fn instance_flags_word(bits: u32, mask: u32) -> u32 {
    return bits | (mask << 16u);
}

fn instance_flags_bits(word: u32) -> u32 {
    return word & 65535u;
}

fn instance_flags_mask(word: u32) -> u32 {
    return word >> 16u;
}

const OBJECT_LEVELS = 8u;

const OBJECT_LISTS = 32u;

const BLOCK = 64u;

const NO_OBJECT = 4294967295u;

const MORPH_STEPS = 511u;

const FADE_STEPS = 127u;

const FADE_PROGRESS = 65535u;

const RANKS = 8u;

const NO_RANK = 8u;

const UNSEEN_METRIC = 4294967295u;

struct LodObject {
    first: u32,
    instances: u32,
    levels: u32,
    first_list: u32,
    first_draw: u32,
    parts: u32,
    metric_scale: f32,
    flags: u32,
    thresholds: array<vec4<f32>, 2>,
    finer: f32,
    coarser: f32,
    rate: f32,
    motion: f32,
    point: vec3<f32>,
    periphery: f32,
    half_size: vec3<f32>,
    rank: u32,
    fade_begin: f32,
    fade_end: f32,
    metric_floor: f32,
    unused: u32,
    triangles: array<vec4<u32>, 2>
}

fn solid_list(level: u32, mirrored: u32) -> u32 {
    return 2u * level + mirrored;
}

fn fading_list(object: LodObject, level: u32, mirrored: u32) -> u32 {
    return 2u * (object.levels + level) + mirrored;
}

struct SceneDraw {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32
}

fn object_flags_word(shown: u32, never_culled: u32, timed: u32, transition: u32, criterion: u32) -> u32 {
    return shown | (never_culled << 1u) | (timed << 2u) | (transition << 3u) | (criterion << 7u);
}

fn object_flags_shown(word: u32) -> u32 {
    return word & 1u;
}

fn object_flags_never_culled(word: u32) -> u32 {
    return (word >> 1u) & 1u;
}

fn object_flags_timed(word: u32) -> u32 {
    return (word >> 2u) & 1u;
}

fn object_flags_transition(word: u32) -> u32 {
    return (word >> 3u) & 15u;
}

fn object_flags_criterion(word: u32) -> u32 {
    return (word >> 7u) & 15u;
}

fn metric_word(bits: u32, mirrored: u32) -> u32 {
    return bits | (mirrored << 31u);
}

fn metric_bits(word: u32) -> u32 {
    return word & 2147483647u;
}

fn metric_mirrored(word: u32) -> u32 {
    return word >> 31u;
}

fn decision_word(seen: u32, mirrored: u32, level: u32, next: u32, steps: u32) -> u32 {
    return seen | (mirrored << 1u) | (level << 2u) | (next << 5u) | (steps << 8u);
}

fn decision_seen(word: u32) -> u32 {
    return word & 1u;
}

fn decision_mirrored(word: u32) -> u32 {
    return (word >> 1u) & 1u;
}

fn decision_level(word: u32) -> u32 {
    return (word >> 2u) & 7u;
}

fn decision_next(word: u32) -> u32 {
    return (word >> 5u) & 7u;
}

fn decision_steps(word: u32) -> u32 {
    return (word >> 8u) & 65535u;
}

fn list_entry_word(instance: u32, level: u32, steps: u32) -> u32 {
    return instance | (level << 20u) | (steps << 23u);
}

fn list_entry_instance(word: u32) -> u32 {
    return word & 1048575u;
}

fn list_entry_level(word: u32) -> u32 {
    return (word >> 20u) & 7u;
}

fn list_entry_steps(word: u32) -> u32 {
    return word >> 23u;
}

fn fade_word(weight: u32, rest: u32) -> u32 {
    return weight | (rest << 7u);
}

fn fade_weight(word: u32) -> u32 {
    return word & 127u;
}

fn fade_rest(word: u32) -> u32 {
    return (word >> 7u) & 1u;
}

const VIEW_CAMERAS = 4u;

struct LodCamera {
    eye: vec3<f32>,
    focal: f32,
    ahead: vec3<f32>,
    pixels: f32,
    near: f32,
    perspective: f32,
    pixel_count: f32,
    unused: f32
}

struct SelectView {
    planes: array<vec4<f32>, 6>,
    cameras: array<LodCamera, 4>,
    cell: vec3<i32>,
    mask: u32,
    camera_count: u32,
    is_first: u32,
    casters: u32,
    blocks: u32,
    is_next: u32,
    seconds: f32,
    unused_a: u32,
    unused_b: u32,
    clip_rows: array<vec4<f32>, 3>,
    last_clip_rows: array<vec4<f32>, 3>
}

const POSITION_SLACK: f32 = 3e-6;

const MAX_MOTION: f32 = 4.0;

@group(0) @binding(0)
var<uniform> view: SelectView;

@group(0) @binding(1)
var<storage, read> objects: array<LodObject>;

@group(0) @binding(2)
var<storage, read> block_objects: array<u32>;

@group(0) @binding(3)
var<storage, read> instances: array<SceneInstance>;

@group(0) @binding(4)
var<storage, read_write> allowed: array<Allowed>;

@group(0) @binding(5)
var<storage, read_write> metrics: array<u32>;

@group(0) @binding(6)
var<storage, read_write> placements: array<array<vec4<f32>, 3>>;

@group(0) @binding(7)
var<storage, read> decisions: array<u32>;

@group(0) @binding(8)
var<storage, read> shown: array<u32>;

fn is_shown(index: u32, instance: SceneInstance, object: LodObject) -> bool {
    let is_in_view = ((shown[index / 32u] >> (index % 32u)) & 1u) != 0u;
    let is_alive = object_flags_shown(object.flags) != 0u && (instance.flags & INSTANCE_ALIVE) != 0u;
    let casts = (view.casters == 0u) | ((instance.flags & INSTANCE_CASTS) != 0u);
    return is_in_view && is_alive && casts && (instance_flags_mask(instance.flags) & view.mask) != 0u;
}

fn is_inside(center: vec3<f32>, radius: f32) -> bool {
    let lengths = length(center) + radius;
    var least = MAX_ALLOWED;
    for (var plane = 0u; plane < 6u; plane++) {
        let side = view.planes[plane];
        least = min(least, dot(side.xyz, center) + side.w + radius + POSITION_SLACK * (lengths + abs(side.w)));
    }
    return least >= 0.0;
}

fn in_picture(rows: array<vec4<f32>, 3>, point: vec3<f32>) -> vec2<f32> {
    let at = vec4<f32>(point, 1.0);
    let w = dot(rows[2], at);
    return select(vec2<f32>(10000.0), vec2<f32>(dot(rows[0], at), dot(rows[1], at)) / w, w > 0.0);
}

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
        speed = 0.5 * distance(now, in_picture(view.last_clip_rows, last_center)) / view.seconds;
    }
    return 1.0 + object.motion * min(speed, MAX_MOTION) + object.periphery * min(length(now), 1.0);
}

struct Seen {
    allowed: f32,
    distance: f32,
    metric: f32
}

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

fn metric_of(index: u32, object: LodObject) -> u32 {
    let instance = instances[index];
    let is_first = view.is_first != 0u;
    let before = Allowed(select(allowed[index].displacement, UNSEEN_ALLOWED, is_first), select(allowed[index].distance, MAX_METRIC, is_first));
    if is_shown(index, instance, object) {
        let axes = instance_axes(instance);
        let at = instance_position(instance, view.cell);
        let sphere = instance.bounding_sphere;
        let center = axes.x * sphere.x + axes.y * sphere.y + axes.z * sphere.z + at;
        let scale = max(max(abs(instance.scale.x), abs(instance.scale.y)), abs(instance.scale.z));
        let radius = sphere.w * scale + POSITION_SLACK * (length(at) + scale * length(sphere.xyz));
        if object_flags_never_culled(object.flags) != 0u || is_inside(center, radius) {
            let seen = seen_by(index, object, Placed(axes, at, center, radius), scale);
            let factor = object.metric_scale * perceptual_factor(object, index, center);
            placements[index] = array<vec4<f32>, 3>(vec4<f32>(axes.x.x, axes.y.x, axes.z.x, at.x), vec4<f32>(axes.x.y, axes.y.y, axes.z.y, at.y), vec4<f32>(axes.x.z, axes.y.z, axes.z.z, at.z));
            let is_seen = before.displacement >= 0.0;
            allowed[index] = Allowed(select(seen.allowed, min(before.displacement, seen.allowed), is_seen), select(seen.distance, min(before.distance, seen.distance), is_seen));
            let s = instance.scale;
            let is_mirrored = ((s.x < 0.0) != (s.y < 0.0)) != (s.z < 0.0);
            return metric_word(bitcast<u32>(min(factor * seen.metric, MAX_METRIC)), u32(is_mirrored));
        }
    }
    allowed[index] = before;
    return UNSEEN_METRIC;
}

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
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
