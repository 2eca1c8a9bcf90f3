// Views of a scene, by which instances are selected.

// The largest number of cameras that decide levels of detail.
const VIEW_CAMERAS = 4u;

// A camera that decides levels of detail.
struct LodCamera {
    // Its position, relative to the corner of the view's cell.
    eye: vec3<f32>,
    // The number of pixels that a world unit takes at a distance of one unit on the axis; in a parallel view, anywhere.
    focal: f32,
    // The unit vector ahead.
    ahead: vec3<f32>,
    // The largest number of pixels by which anything may be off.
    pixels: f32,
    // The distance of the near plane.
    near: f32,
    // 1 for a perspective view, 0 for a parallel one.
    perspective: f32,
    unused_a: f32,
    unused_b: f32,
}

// A view: what it sees, and which cameras decide how fine.
struct SelectView {
    // Planes of the view volume, relative to the corner of the view's cell: unit normals that point inwards, and
    // distances. A plane that excludes nothing is (0, 0, 0, 1).
    planes: array<vec4<f32>, 6>,
    cameras: array<LodCamera, 4>,
    // The cell to whose corner positions are relative.
    cell: vec3<i32>,
    // Instances are seen if their visibility mask shares a bit with this one, 16 bits.
    mask: u32,
    // Number of cameras, 1 to `VIEW_CAMERAS`.
    camera_count: u32,
    // 1 if this is the first view of the frame, which starts the allowed displacements anew.
    is_first: u32,
    // 1 if only instances that cast shadows are seen.
    casters: u32,
    // Number of blocks of instances.
    blocks: u32,
    // The element of the placements' rows from which on each instance has its level of detail of the last frame; 0 if that is
    // not kept.
    last_levels: u32,
    // 1 if the view was in the last frame too, so that the decisions before this one are that frame's.
    is_next: u32,
    unused_a: u32,
    unused_b: u32,
}

// How far rounding may move what is computed from positions relative to the corner of the view's cell, as a fraction of
// all their lengths.
const POSITION_SLACK: f32 = 3e-6;

// What `camera_allows` keeps back, so that no rounding, its own or that of what is computed from its result, permits more
// than `pixels`.
const ALLOWED_MARGIN: f32 = 0.9999;

// The largest distance, in world units, by which every point inside a sphere may be off while a camera draws none more
// than its `pixels` from its place; 0 if a part of the sphere may reach the near plane. A sphere behind the camera counts
// as if it were as far ahead. `docs/pixel-bounds.md` has the derivation.
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
