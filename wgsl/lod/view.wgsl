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
    // 1 if the view was in the last frame too, so that the decisions before this one are that frame's.
    is_next: u32,
    unused_a: u32,
    unused_b: u32,
    unused_c: u32,
}

// How far rounding may move what is computed from positions relative to the corner of the view's cell, as a fraction of
// all their lengths.
const POSITION_SLACK: f32 = 3e-6;
