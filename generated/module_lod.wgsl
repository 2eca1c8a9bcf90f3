// From relievo's wgsl/lod/module.wgsl.
// Level of detail in scenes: instances, objects and views in a scene's buffers, the allowed displacement, and the choice of
// levels. `build.rs` joins this file and its imports into one text, for shaders that are not composed with WESL. Prepend that
// text to your own code.

// From relievo's wgsl/lod/instance.wgsl.
// Instances as a scene stores them on the device.

// Edge length of a cell, in world units. A position consists of a cell index and an offset, so that it stays precise far from
// the origin.
const CELL_SIZE: f32 = 256.0;

// Instance flag: the instance exists.
const INSTANCE_ALIVE = 1u;
// Instance flag: the instance casts shadows.
const INSTANCE_CASTS = 2u;
// Instance flag: the instance is a character with an attached mesh. No displacement is allowed to its bones, so the gate that
// bounds errors samples them in every frame in which a view sees the character.
const INSTANCE_CARRIES = 4u;
// Instance flag: the instance is a mesh that is attached to a bone. Its placement is stored only per view, as rows of a matrix.
const INSTANCE_FOLLOWS = 8u;
// Instance flag: the instance is a character that needs all bones of its skeleton, because the host drives bones or layers are
// blended. It keeps skeleton tier 0.
const INSTANCE_WHOLE = 16u;
// Word of `SceneInstance.flags`: the instance flags, and the visibility mask.
// packed InstanceFlags: bits 16, mask 16

// An instance of an object: its placement, flags and tint.
struct SceneInstance {
    // Cell that contains the instance's position.
    cell: vec3<i32>,
    // Instance flags (`INSTANCE_ALIVE`, `INSTANCE_CASTS`, `INSTANCE_CARRIES`, `INSTANCE_FOLLOWS`, `INSTANCE_WHOLE`) in the lower
    // 16 bits. The upper 16 bits are the visibility mask.
    flags: u32,
    // Position of the instance relative to the cell's corner, in world units.
    offset: vec3<f32>,
    // User data: a word that the caller's shading function reads.
    user_data: u32,
    // Rotation: a unit quaternion (x, y, z, w).
    rotation: vec4<f32>,
    // Scale factors along the model's axes, applied before the rotation. Negative factors mirror.
    scale: vec3<f32>,
    // Tint that multiplies the instance's colours: red, green, blue and alpha, 8 bits each, red in the lowest byte.
    tint: u32,
    // Sphere around everything that the instance may draw, in model space: center (xyz) and radius (w).
    bounding_sphere: vec4<f32>,
}

// Linear part of a transform from model to world space, as columns.
struct Axes {
    // Image of the model's x axis.
    x: vec3<f32>,
    // Image of the model's y axis.
    y: vec3<f32>,
    // Image of the model's z axis.
    z: vec3<f32>,
}

// Linear part of an instance's transform: first the scale, then the rotation.
fn instance_axes(instance: SceneInstance) -> Axes {
    let q = instance.rotation;
    let s = instance.scale;
    let x = vec3<f32>(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3<f32>(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let z = vec3<f32>(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return Axes(s.x * x, s.y * y, s.z * z);
}

// Position of an instance relative to the corner of `cell`, in world units.
fn instance_position(instance: SceneInstance, cell: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(instance.cell - cell) * CELL_SIZE + instance.offset;
}

// Packs a word: InstanceFlags: bits 16, mask 16.
fn instance_flags_word(bits: u32, mask: u32) -> u32 {
    return bits | (mask << 16u);
}

// The 16 bits of a instance_flags word from bit 0 on.
fn instance_flags_bits(word: u32) -> u32 {
    return word & 65535u;
}

// The 16 bits of a instance_flags word from bit 16 on.
fn instance_flags_mask(word: u32) -> u32 {
    return word >> 16u;
}

// From relievo's wgsl/lod/object.wgsl.
// Objects of a scene. All instances of one model share an object.
//
// Flags word of an object. `shown`: the object is visible. `never_culled`: its instances are also drawn outside the view
// volume. `timed`: its transition advances with time, not with the metric. `transition` is a constant of
// `wgsl/lod/transition.wgsl`, `criterion` a constant of `wgsl/lod/criterion.wgsl`.
// packed ObjectFlags: shown 1, never_culled 1, timed 1, transition 4, criterion 4
// Metric word of an instance in a view: the bits of its metric without the sign bit, and whether its placement mirrors.
// `UNSEEN_METRIC` means that the view does not see the instance.
// packed Metric: bits 31, mirrored 1
// Decision word of an instance in a view: its level, the level to which it changes (`next`), and the steps of the change. A
// geomorph takes up to `MORPH_STEPS` steps, a fade up to `FADE_PROGRESS`; 0 steps mean no change. The word is 0 if the instance
// is not visible.
// packed Decision: seen 1, mirrored 1, level 3, next 3, steps 16
// Entry of a list: the instance's index in its object, its level, and its steps. The steps are the progress of a geomorph, or a
// fade word.
// packed ListEntry: instance 20, level 3, steps 9
// Fade word: the weight of the instance, up to `FADE_STEPS`. If `rest` is 1, the instance covers the pixels that this weight
// leaves uncovered.
// packed Fade: weight 7, rest 1

// Largest number of levels of detail of an object, the finest included.
const OBJECT_LEVELS = 8u;
// Largest number of lists of an object in a view. Each level has four lists: unmirrored and mirrored instances, each without a
// fade (`solid_list`) and with a fade (`fading_list`).
const OBJECT_LISTS = 32u;
// Number of instances in a block. The instances of each object occupy whole blocks.
const BLOCK = 64u;
// Object index of a block that belongs to no object.
const NO_OBJECT = 0xffffffffu;

// Number of steps of a geomorph from one level to the next.
const MORPH_STEPS = 511u;
// Number of steps of a fade's weight in a list entry.
const FADE_STEPS = 127u;
// Number of steps of a fade in a decision word.
const FADE_PROGRESS = 65535u;

// Number of ranks, the importance classes of a triangle budget.
const RANKS = 8u;
// Rank of an object that a triangle budget never coarsens.
const NO_RANK = 8u;

// Metric word of an instance that the view does not see.
const UNSEEN_METRIC = 0xffffffffu;

// Level-of-detail settings of an object, and the location of its instances, lists and draws.
struct LodObject {
    // Index of the object's first instance in the scene, a multiple of `BLOCK`.
    first: u32,
    // Number of instances of the object, a multiple of `BLOCK`.
    instances: u32,
    // Number of levels of detail, 1 to `OBJECT_LEVELS`.
    levels: u32,
    // Index of the word at which the object's first list begins in a view's lists. Each list takes `instances` words.
    first_list: u32,
    // Index of the object's first draw in a view's draws. Each part of the object has `OBJECT_LISTS` draws.
    first_draw: u32,
    // Number of parts of the object, each with draws of its own.
    parts: u32,
    // Factor of the metric, above 0: the LOD bias. If the metric is the allowed displacement, the factor includes the fraction of
    // the displacement that levels may use.
    metric_scale: f32,
    // Flags word of the object, see `object_flags_word`.
    flags: u32,
    // Threshold per level, ascending: the smallest metric at which the level is drawn. Without a geomorph, the first threshold
    // is 0. With a geomorph, a level begins to move towards the next one at its threshold, so the first threshold is above 0.
    thresholds: array<vec4<f32>, 2>,
    // Factor for the thresholds of the last frame's level and of finer levels. While the metric is between a threshold times
    // `finer` and this threshold times `coarser`, an instance keeps its level (hysteresis), or fades from one level to the
    // next.
    finer: f32,
    // Factor for the thresholds of levels that are coarser than the last frame's level.
    coarser: f32,
    // Steps per second of a fade that runs in time; a whole fade has `FADE_PROGRESS` steps.
    rate: f32,
    // Relative growth of the metric with an instance's speed on screen, per picture height per second; 0 for none.
    motion: f32,
    // Middle of the model's box, or the point to which distances are measured, in model space.
    point: vec3<f32>,
    // Relative growth of the metric with an instance's distance from the picture's middle, per half picture height; 0 for none.
    periphery: f32,
    // Half the size of the model's box along the model's axes.
    half_size: vec3<f32>,
    // Rank of the object in a triangle budget: objects of rank 0 are coarsened first. `NO_RANK` if the budget spares the
    // object.
    rank: u32,
    // Metric at which instances begin to fade out, with `TRANSITION_ALPHA`.
    fade_begin: f32,
    // Metric at which instances have faded out, with `TRANSITION_ALPHA`.
    fade_end: f32,
    // Factor of a term that is added to the metric: `metric_floor` times (a budget's factor minus 1). With this term, the
    // largest factor reaches every level even from a metric of 0.
    metric_floor: f32,
    // Padding, not read.
    unused: u32,
    // Number of triangles per level, in units of the triangle budget.
    triangles: array<vec4<u32>, 2>,
}

// Index of the list of visible instances that are drawn at a level without a fade. `mirrored` is 1 for mirrored instances,
// else 0.
fn solid_list(level: u32, mirrored: u32) -> u32 {
    return 2u * level + mirrored;
}

// Index of the list of visible instances that fade in or out at a level. `mirrored` is 1 for mirrored instances, else 0.
fn fading_list(object: LodObject, level: u32, mirrored: u32) -> u32 {
    return 2u * (object.levels + level) + mirrored;
}

// The arguments of an indexed indirect draw.
struct SceneDraw {
    // Number of indices to draw.
    index_count: u32,
    // Number of instances to draw.
    instance_count: u32,
    // Index in the index buffer of the first index to draw.
    first_index: u32,
    // Number that is added to each index.
    base_vertex: u32,
    // Number of the first instance.
    first_instance: u32,
}

// Packs a word: ObjectFlags: shown 1, never_culled 1, timed 1, transition 4, criterion 4.
fn object_flags_word(shown: u32, never_culled: u32, timed: u32, transition: u32, criterion: u32) -> u32 {
    return shown | (never_culled << 1u) | (timed << 2u) | (transition << 3u) | (criterion << 7u);
}

// The 1 bits of a object_flags word from bit 0 on.
fn object_flags_shown(word: u32) -> u32 {
    return word & 1u;
}

// The 1 bits of a object_flags word from bit 1 on.
fn object_flags_never_culled(word: u32) -> u32 {
    return (word >> 1u) & 1u;
}

// The 1 bits of a object_flags word from bit 2 on.
fn object_flags_timed(word: u32) -> u32 {
    return (word >> 2u) & 1u;
}

// The 4 bits of a object_flags word from bit 3 on.
fn object_flags_transition(word: u32) -> u32 {
    return (word >> 3u) & 15u;
}

// The 4 bits of a object_flags word from bit 7 on.
fn object_flags_criterion(word: u32) -> u32 {
    return (word >> 7u) & 15u;
}

// Packs a word: Metric: bits 31, mirrored 1.
fn metric_word(bits: u32, mirrored: u32) -> u32 {
    return bits | (mirrored << 31u);
}

// The 31 bits of a metric word from bit 0 on.
fn metric_bits(word: u32) -> u32 {
    return word & 2147483647u;
}

// The 1 bits of a metric word from bit 31 on.
fn metric_mirrored(word: u32) -> u32 {
    return word >> 31u;
}

// Packs a word: Decision: seen 1, mirrored 1, level 3, next 3, steps 16.
fn decision_word(seen: u32, mirrored: u32, level: u32, next: u32, steps: u32) -> u32 {
    return seen | (mirrored << 1u) | (level << 2u) | (next << 5u) | (steps << 8u);
}

// The 1 bits of a decision word from bit 0 on.
fn decision_seen(word: u32) -> u32 {
    return word & 1u;
}

// The 1 bits of a decision word from bit 1 on.
fn decision_mirrored(word: u32) -> u32 {
    return (word >> 1u) & 1u;
}

// The 3 bits of a decision word from bit 2 on.
fn decision_level(word: u32) -> u32 {
    return (word >> 2u) & 7u;
}

// The 3 bits of a decision word from bit 5 on.
fn decision_next(word: u32) -> u32 {
    return (word >> 5u) & 7u;
}

// The 16 bits of a decision word from bit 8 on.
fn decision_steps(word: u32) -> u32 {
    return (word >> 8u) & 65535u;
}

// Packs a word: ListEntry: instance 20, level 3, steps 9.
fn list_entry_word(instance: u32, level: u32, steps: u32) -> u32 {
    return instance | (level << 20u) | (steps << 23u);
}

// The 20 bits of a list_entry word from bit 0 on.
fn list_entry_instance(word: u32) -> u32 {
    return word & 1048575u;
}

// The 3 bits of a list_entry word from bit 20 on.
fn list_entry_level(word: u32) -> u32 {
    return (word >> 20u) & 7u;
}

// The 9 bits of a list_entry word from bit 23 on.
fn list_entry_steps(word: u32) -> u32 {
    return word >> 23u;
}

// Packs a word: Fade: weight 7, rest 1.
fn fade_word(weight: u32, rest: u32) -> u32 {
    return weight | (rest << 7u);
}

// The 7 bits of a fade word from bit 0 on.
fn fade_weight(word: u32) -> u32 {
    return word & 127u;
}

// The 1 bits of a fade word from bit 7 on.
fn fade_rest(word: u32) -> u32 {
    return (word >> 7u) & 1u;
}

// From relievo's wgsl/lod/allowed.wgsl.
// Allowed displacement: the largest distance between the drawn and the exact surface that a view permits. It is computed from
// the allowed error in pixels. The limits of levels, gates and influences are all derived from it. `src/lod/allowed.rs` is the
// reference.

// Safety factor for floating-point error in `camera_allows` and in all values computed from its result. With this factor,
// rounding never permits an error above `pixels`.
const ALLOWED_MARGIN: f32 = 0.9999;
// Upper bound of the allowed displacement, in model units. It keeps divisions by a displacement finite.
const MAX_ALLOWED: f32 = 1e9;
// Smallest model scale by which an allowed displacement is divided. Smaller scales count as this one.
const LEAST_SCALE: f32 = 1e-9;

// Largest error and nearest eye of an instance, over all views of a frame that see it.
struct Allowed {
    // Displacement that these views allow, in model units; UNSEEN_ALLOWED if no view sees the instance.
    displacement: f32,
    // Distance from the nearest eye to the middle of the bounding sphere, in world units; 0 in a parallel view.
    distance: f32,
}

// Displacement that is allowed to an instance that no view of the frame has seen.
const UNSEEN_ALLOWED: f32 = -1.0;

// Allowed displacement of a sphere in a camera, in world units. If every point inside the sphere is off by at most this
// distance, no point moves by more than `pixels` on screen. The result is 0 if a part of the sphere may reach the near plane. A
// sphere behind the camera counts as if it were at the same distance in front. `docs/pixel-bounds.md` has the derivation.
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

// Converts an allowed displacement from world units to model units. `scale` is the model's largest scale factor.
fn allowed_in_model(allowed: f32, scale: f32) -> f32 {
    return min(allowed / max(scale, LEAST_SCALE), MAX_ALLOWED);
}

// From relievo's wgsl/lod/budget_state.wgsl.
// State of a triangle budget: how much the budget coarsens the levels of detail of its objects.
struct BudgetState {
    // Factor per rank, 1 or more. It multiplies the metric by which levels are chosen. Elements from `NO_RANK` on are 1.
    factors: array<vec4<f32>, 3>,
    // 1 if all fades end in this frame, because the budget cannot hold both levels of every fade; else 0.
    ends_fades: u32,
    // 1 if even the coarsest levels exceed the budget, else 0.
    is_missed: u32,
    // Number of triangles drawn, in units of the budget. An instance that fades counts with both levels.
    triangles: u32,
    // Degree of coarsening: an integer position on a scale. The scale has one section per rank, in the order of ranks. Within a
    // section, the position is proportional to the logarithm of the rank's factor.
    pressure: u32,
}

// From relievo's wgsl/lod/view.wgsl.
// Views of a scene, as the selection of instances reads them.

// Largest number of cameras in a view that decide levels of detail.
const VIEW_CAMERAS = 4u;

// A camera that decides levels of detail.
struct LodCamera {
    // Position of the camera in world units, relative to the corner of the view's cell.
    eye: vec3<f32>,
    // Pixels per world unit at distance 1 along the axis. In a parallel view, pixels per world unit at any distance.
    focal: f32,
    // Unit vector of the view direction, for perspective and parallel views.
    ahead: vec3<f32>,
    // Allowed error on screen, in pixels.
    pixels: f32,
    // Distance of the near plane, in world units.
    near: f32,
    // 1 for a perspective view, 0 for a parallel one.
    perspective: f32,
    // Number of pixels in the viewport.
    pixel_count: f32,
    // Padding, not read.
    unused: f32,
}

// A view: its volume, and the cameras that decide levels of detail.
struct SelectView {
    // Planes of the view volume, relative to the corner of the view's cell: unit normals that point inwards (xyz), and
    // distances (w). The plane (0, 0, 0, 1) excludes nothing.
    planes: array<vec4<f32>, 6>,
    // Cameras that decide levels of detail; the first `camera_count` are valid.
    cameras: array<LodCamera, 4>,
    // Cell of the view. Its corner is the origin of all positions in the view.
    cell: vec3<i32>,
    // Visibility mask, 16 bits: the view sees instances whose mask has a bit in common with this one.
    mask: u32,
    // Number of valid cameras, 1 to `VIEW_CAMERAS`.
    camera_count: u32,
    // 1 if this is the first view of the frame, which resets the allowed displacements; else 0.
    is_first: u32,
    // 1 if the view sees only instances that cast shadows, else 0.
    casters: u32,
    // Number of blocks of instances.
    blocks: u32,
    // 1 if the view was in the last frame too, else 0. If 1, the decisions and placements in the buffers come from the last
    // frame.
    is_next: u32,
    // Seconds since the view's last frame.
    seconds: f32,
    // Padding, not read.
    unused_a: u32,
    // Padding, not read.
    unused_b: u32,
    // Rows x, y and w of the transform to clip space, scaled to units of half the picture's height. Input positions are
    // relative to the corner of the view's cell.
    clip_rows: array<vec4<f32>, 3>,
    // Rows x, y and w of the last frame's transform to clip space, scaled like `clip_rows`. They apply to placements of that
    // frame.
    last_clip_rows: array<vec4<f32>, 3>,
}

// Bound of the relative rounding error of a computation from positions in a view. The error is relative to the sum of these
// positions' lengths.
const POSITION_SLACK: f32 = 3e-6;

// From relievo's wgsl/lod/criterion.wgsl.
// Criteria for the level of detail of an instance. A criterion yields a metric of the instance in a camera; larger metrics give
// coarser levels. The level drawn is the coarsest one whose threshold is at most the metric. `src/lod/criterion.rs` is the
// reference.

// Criterion: the metric is the displacement that the camera allows, in model units. The CRITERION constants are values of the
// criterion in an object's flags word.
const CRITERION_ERROR = 0u;
// Criterion: the metric is the distance from the eye to the middle of the bounding sphere, in world units.
const CRITERION_DISTANCE = 1u;
// Criterion: the metric is the distance from the eye to a chosen point of the model, in world units.
const CRITERION_POINT = 2u;
// Criterion: the metric is the distance from the eye to the nearest point of the model's box, in world units.
const CRITERION_NEAREST = 3u;
// Criterion: the metric is the square root of the ratio of the viewport's area to the projected area of the model's box.
const CRITERION_BOX = 4u;
// Criterion: the metric is the square root of the ratio of the viewport's area to the projected area of the bounding sphere.
const CRITERION_SPHERE = 5u;
// Criterion: the metric is the number of world units per pixel at the middle of the bounding sphere (thesis B equation 3.3).
const CRITERION_MAGNIFICATION = 6u;

// Upper bound of the metric, for every criterion.
const MAX_METRIC: f32 = 3e38;

// Transform and bounding sphere of an instance, relative to the corner of the view's cell.
struct Placed {
    // Columns of the linear part of the transform.
    axes: Axes,
    // Position of the model's origin, in world units.
    at: vec3<f32>,
    // Center of the bounding sphere, in world units.
    center: vec3<f32>,
    // Radius of the bounding sphere, in world units.
    radius: f32,
}

// Position of a point of the model relative to the corner of the view's cell. `point` is in model space.
fn placed_point(placed: Placed, point: vec3<f32>) -> vec3<f32> {
    return placed.axes.x * point.x + placed.axes.y * point.y + placed.axes.z * point.z + placed.at;
}

// Distance from the eye to the nearest point of the model's box, in world units.
fn distance_to_box(object: LodObject, placed: Placed, eye: vec3<f32>) -> f32 {
    let towards = eye - placed_point(placed, object.point);
    var nearest = vec3<f32>(0.0);
    for (var axis = 0u; axis < 3u; axis++) {
        let along = axis_of(placed.axes, axis);
        // Coordinate in model space. An axis of length 0 contributes nothing.
        let coordinate = dot(along, towards) / max(dot(along, along), 1e-30);
        nearest += along * clamp(coordinate, -object.half_size[axis], object.half_size[axis]);
    }
    return length(towards - nearest);
}

// Column `axis`, 0 to 2, of the model's linear transform.
fn axis_of(axes: Axes, axis: u32) -> vec3<f32> {
    if axis == 0u {
        return axes.x;
    }
    return select(axes.y, axes.z, axis == 2u);
}

// Area of the model's box on screen, in pixels: the sum over its visible faces, at most three.
fn box_area(object: LodObject, placed: Placed, camera: LodCamera) -> f32 {
    let middle = placed_point(placed, object.point);
    var area = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let half = object.half_size[axis] * axis_of(placed.axes, axis);
        let one = (axis + 1u) % 3u;
        let two = (axis + 2u) % 3u;
        let across = object.half_size[one] * axis_of(placed.axes, one);
        let along = object.half_size[two] * axis_of(placed.axes, two);
        // Only one of two opposite faces counts: the face turned towards the eye. If the eye lies between their planes, neither
        // face counts.
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

// Area on screen, in pixels, of the parallelogram with the corners `middle` ± `across` ± `along`.
fn face_area(camera: LodCamera, middle: vec3<f32>, across: vec3<f32>, along: vec3<f32>) -> f32 {
    let a = on_screen(camera, middle - across - along);
    let b = on_screen(camera, middle + across - along);
    let c = on_screen(camera, middle + across + along);
    let d = on_screen(camera, middle - across + along);
    // Half the length of the cross product of the diagonals.
    return 0.5 * length(cross(c - a, d - b));
}

// Projection of a point onto the plane at distance 1 from the eye, in pixels. Points nearer than the near plane are projected
// with the near plane's depth.
fn on_screen(camera: LodCamera, point: vec3<f32>) -> vec3<f32> {
    let towards = point - camera.eye;
    if camera.perspective == 0.0 {
        return camera.focal * (towards - dot(towards, camera.ahead) * camera.ahead);
    }
    let depth = dot(towards, camera.ahead);
    return camera.focal * (towards - depth * camera.ahead) / max(depth, max(camera.near, 1e-9));
}

// Depth of the middle of the bounding sphere in world units, at least the near plane's distance. In a parallel view it is 1.
fn depth_of(camera: LodCamera, center: vec3<f32>) -> f32 {
    if camera.perspective == 0.0 {
        return 1.0;
    }
    return max(dot(camera.ahead, center - camera.eye), max(camera.near, 1e-9));
}

// Metric of an instance in a camera, by the object's criterion. `allowed` is the displacement that the camera allows, in model
// units. A parallel view has no eye, so all distances in it are 0.
fn criterion_metric(object: LodObject, camera: LodCamera, placed: Placed, allowed: f32) -> f32 {
    switch object_flags_criterion(object.flags) {
        case CRITERION_DISTANCE: {
            return camera.perspective * distance(placed.center, camera.eye);
        }
        case CRITERION_POINT: {
            return camera.perspective * distance(placed_point(placed, object.point), camera.eye);
        }
        case CRITERION_NEAREST: {
            return camera.perspective * distance_to_box(object, placed, camera.eye);
        }
        case CRITERION_BOX: {
            return metric_of_area(camera, box_area(object, placed, camera));
        }
        case CRITERION_SPHERE: {
            let radius = camera.focal * placed.radius / depth_of(camera, placed.center);
            return metric_of_area(camera, 3.14159274 * radius * radius);
        }
        case CRITERION_MAGNIFICATION: {
            return depth_of(camera, placed.center) / camera.focal;
        }
        default: {
            return allowed;
        }
    }
}

// Metric of an area on screen: the square root of the ratio of the viewport's area to `area`, both in pixels.
fn metric_of_area(camera: LodCamera, area: f32) -> f32 {
    return min(sqrt(camera.pixel_count / max(area, 1e-30)), MAX_METRIC);
}

// From relievo's wgsl/lod/transition.wgsl.
// Transitions between the levels of an object: from an instance's metric to a view's decision, and from the decision to list
// entries. `src/lod/transition.rs` is the reference.

// Transition: levels change at once. The TRANSITION constants are values of the transition in an object's flags word.
const TRANSITION_HARD = 0u;
// Transition: vertices move to their partners in the next coarser level.
const TRANSITION_GEOMORPH = 1u;
// Transition: both levels are drawn, each in its own pixels of a pattern.
const TRANSITION_DITHER = 2u;
// Transition: both levels are blended (thesis A section 7.3.1).
const TRANSITION_CROSS_FADE = 3u;
// Transition: the current level is opaque, and the next level is blended over it (thesis A section 7.3.2).
const TRANSITION_FADE_IN = 4u;
// Transition in two phases (thesis A section 7.3.3). First the next level fades in over the opaque current level. Then the next
// level is opaque while the current level fades out.
const TRANSITION_TWO_PHASE = 5u;
// Transition: levels change at once, and instances fade out between two metrics (thesis A section 7.4).
const TRANSITION_ALPHA = 6u;

// Level of an instance that had no level in the last frame.
const NO_LEVEL = 0xffffffffu;
// List index of an entry that does not exist.
const NO_LIST = 0xffffffffu;

// Smallest metric at which a level is drawn. `last` is the instance's level in the last frame, or `NO_LEVEL`.
fn threshold_of(object: LodObject, level: u32, last: u32) -> f32 {
    let threshold = object.thresholds[level >> 2u][level & 3u];
    if last == NO_LEVEL {
        return threshold;
    }
    return threshold * select(object.coarser, object.finer, level <= last);
}

// Coarsest level whose threshold is at most `metric`. `last` is the instance's level in the last frame, or `NO_LEVEL`.
fn level_within(object: LodObject, metric: f32, last: u32) -> u32 {
    var level = 0u;
    for (var coarser = 1u; coarser < min(object.levels, OBJECT_LEVELS); coarser++) {
        if threshold_of(object, coarser, last) <= metric {
            level = coarser;
        }
    }
    return level;
}

// Progress of a metric from `begin` to `end`, in steps from 0 to `most`. `end` must be above `begin`.
fn steps_between(metric: f32, begin: f32, end: f32, most: u32) -> u32 {
    return u32(f32(most) * clamp((metric - begin) / (end - begin), 0.0, 1.0) + 0.5);
}

// Level of an instance in the last frame, or `NO_LEVEL`. `last` is the decision word of that frame. A fade in time counts as
// the level to which it leads.
fn last_level(object: LodObject, last: u32) -> u32 {
    if decision_seen(last) == 0u {
        return NO_LEVEL;
    }
    return select(decision_level(last), decision_next(last), decision_steps(last) > 0u && object_flags_timed(object.flags) != 0u);
}

// Decision word for a level that does not change.
fn settled(level: u32, mirrored: u32) -> u32 {
    return decision_word(1u, mirrored, level, level, 0u);
}

// Decision word with a geomorph: the level, and the steps towards the next coarser level.
fn morphing(object: LodObject, metric: f32, mirrored: u32) -> u32 {
    let level = level_within(object, metric, NO_LEVEL);
    if level + 1u >= min(object.levels, OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let begin = threshold_of(object, level, NO_LEVEL);
    let steps = steps_between(metric, begin, threshold_of(object, level + 1u, NO_LEVEL), MORPH_STEPS);
    return decision_word(1u, mirrored, level, level, steps);
}

// Decision word for a fade to the next coarser level while the metric passes the band around the threshold.
fn fading_in_band(object: LodObject, metric: f32, mirrored: u32) -> u32 {
    // The coarsest level whose band the metric has passed. With 0 as the last level, `level_within` uses the upper ends of the
    // bands as thresholds.
    let level = level_within(object, metric, 0u);
    if level + 1u >= min(object.levels, OBJECT_LEVELS) {
        return settled(level, mirrored);
    }
    let next = level + 1u;
    let begin = threshold_of(object, next, next);
    let steps = steps_between(metric, begin, threshold_of(object, next, 0u), FADE_PROGRESS);
    if steps == FADE_PROGRESS {
        return settled(next, mirrored);
    }
    return decision_word(1u, mirrored, level, select(level, next, steps > 0u), steps);
}

// Decision word for a fade that runs in time. `last` is the decision word of the last frame, `level` the level for this frame.
// If `level` is the level that the fade left, the fade turns back. Any other new level waits until the fade has ended.
fn fading_in_time(object: LodObject, level: u32, mirrored: u32, last: u32, seconds: f32) -> u32 {
    if decision_seen(last) == 0u {
        return settled(level, mirrored);
    }
    var left = decision_level(last);
    var to = decision_next(last);
    var done = decision_steps(last);
    if done == 0u {
        to = level;
    } else if level == left {
        to = left;
        left = decision_next(last);
        done = FADE_PROGRESS - done;
    }
    if left == to {
        return settled(left, mirrored);
    }
    let steps = done + max(u32(min(object.rate * seconds, f32(FADE_PROGRESS)) + 0.5), 1u);
    if steps >= FADE_PROGRESS {
        return settled(to, mirrored);
    }
    return decision_word(1u, mirrored, left, to, steps);
}

// Metric after a budget's factor, 1 or more, has been applied.
fn coarsened(object: LodObject, metric: f32, factor: f32) -> f32 {
    return factor * metric + (factor - 1.0) * object.metric_floor;
}

// Level that hysteresis holds: the instance's level in the last frame. The result is `NO_LEVEL` for geomorphs and for fades in
// a band, because these depend only on this frame.
fn held_level(object: LodObject, last: u32) -> u32 {
    let transition = object_flags_transition(object.flags);
    let is_fading = transition >= TRANSITION_DITHER && transition <= TRANSITION_TWO_PHASE;
    let is_momentary = transition == TRANSITION_GEOMORPH || (is_fading && object_flags_timed(object.flags) == 0u);
    return select(last_level(object, last), NO_LEVEL, is_momentary);
}

// Whether an instance has faded out completely (`TRANSITION_ALPHA`).
fn is_faded_out(object: LodObject, metric: f32) -> bool {
    return object_flags_transition(object.flags) == TRANSITION_ALPHA
        && steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS) == FADE_PROGRESS;
}

// Decision word for a visible instance. `factor` is a budget's factor, which coarsens the levels. `last` is the view's decision
// word in the last frame, 0 if there is none. If `ends` is true, all fades end in this frame.
fn transition_decision(object: LodObject, metric: f32, factor: f32, mirrored: u32, last: u32, seconds: f32, ends: bool) -> u32 {
    let transition = object_flags_transition(object.flags);
    let within = coarsened(object, metric, factor);
    if transition == TRANSITION_GEOMORPH {
        return morphing(object, within, mirrored);
    }
    let is_fading = transition >= TRANSITION_DITHER && transition <= TRANSITION_TWO_PHASE && !ends;
    let is_timed = object_flags_timed(object.flags) != 0u;
    if is_fading && !is_timed {
        return fading_in_band(object, within, mirrored);
    }
    let level = level_within(object, within, held_level(object, last));
    if is_fading {
        return fading_in_time(object, level, mirrored, last, seconds);
    }
    if transition != TRANSITION_ALPHA {
        return settled(level, mirrored);
    }
    let steps = steps_between(metric, object.fade_begin, object.fade_end, FADE_PROGRESS);
    return select(decision_word(1u, mirrored, level, level, steps), 0u, steps == FADE_PROGRESS);
}

// Finest level that a decision draws.
fn decision_finest(decision: u32) -> u32 {
    return min(decision_level(decision), decision_next(decision));
}

// Up to two list entries of an instance, each with the index of its list.
struct Entries {
    // Index of the first entry's list, or `NO_LIST`.
    first: u32,
    // First list entry.
    first_entry: u32,
    // Index of the second entry's list, or `NO_LIST`.
    second: u32,
    // Second list entry.
    second_entry: u32,
}

// List entries for a decision word. `index` is the instance's index in its object.
fn transition_entries(object: LodObject, decision: u32, index: u32) -> Entries {
    if decision_seen(decision) == 0u {
        return Entries(NO_LIST, 0u, NO_LIST, 0u);
    }
    let level = decision_level(decision);
    let next = decision_next(decision);
    let mirrored = decision_mirrored(decision);
    let steps = decision_steps(decision);
    let transition = object_flags_transition(object.flags);
    let solid = solid_list(level, mirrored);
    if steps == 0u {
        return Entries(solid, list_entry_word(index, level, 0u), NO_LIST, 0u);
    }
    // Remaining weight of the current level, and weight of the next level.
    let left = left_of(steps);
    let gained = FADE_STEPS - left;
    let fading = fading_list(object, level, mirrored);
    let next_fading = fading_list(object, next, mirrored);
    switch transition {
        case TRANSITION_DITHER: {
            return Entries(
                fading, list_entry_word(index, level, fade_word(left, 0u)),
                next_fading, list_entry_word(index, next, fade_word(left, 1u)));
        }
        case TRANSITION_CROSS_FADE: {
            return Entries(
                fading, list_entry_word(index, level, fade_word(left, 0u)),
                next_fading, list_entry_word(index, next, fade_word(gained, 0u)));
        }
        case TRANSITION_FADE_IN: {
            return Entries(
                solid, list_entry_word(index, level, 0u),
                next_fading, list_entry_word(index, next, fade_word(gained, 0u)));
        }
        case TRANSITION_TWO_PHASE: {
            if left > gained {
                return Entries(
                    solid, list_entry_word(index, level, 0u),
                    next_fading, list_entry_word(index, next, fade_word(2u * gained, 0u)));
            }
            return Entries(
                solid_list(next, mirrored), list_entry_word(index, next, 0u),
                fading, list_entry_word(index, level, fade_word(2u * left, 0u)));
        }
        case TRANSITION_ALPHA: {
            return Entries(fading, list_entry_word(index, level, fade_word(left, 0u)), NO_LIST, 0u);
        }
        default: {
            return Entries(solid, list_entry_word(index, level, steps), NO_LIST, 0u);
        }
    }
}

// Single list entry of an instance that has a draw of its own.
struct SortedEntry {
    // Index of the list.
    list: u32,
    // The list entry.
    word: u32,
}

// List entry of a visible instance that has a draw of its own. The instance may morph or fade out. A fade between two levels is
// replaced by an abrupt change halfway through the fade.
fn sorted_entry(object: LodObject, decision: u32, index: u32) -> SortedEntry {
    let steps = decision_steps(decision);
    let transition = object_flags_transition(object.flags);
    var level = decision_level(decision);
    var word = 0u;
    if transition == TRANSITION_GEOMORPH {
        word = steps;
    } else if transition == TRANSITION_ALPHA {
        word = fade_word(left_of(steps), 0u);
    } else if 2u * steps > FADE_PROGRESS {
        level = decision_next(decision);
    }
    return SortedEntry(solid_list(level, decision_mirrored(decision)), list_entry_word(index, level, word));
}

// Weight that remains to a level after `steps` steps of a fade, from `FADE_STEPS` down to 0.
fn left_of(steps: u32) -> u32 {
    return FADE_STEPS - (steps * FADE_STEPS + FADE_PROGRESS / 2u) / FADE_PROGRESS;
}
