// Views of a scene: the input of instance selection.

// The largest number of cameras that decide levels of detail.
const VIEW_CAMERAS = 4u;

// A camera that decides levels of detail.
struct LodCamera {
    // Its position, relative to the corner of the view's cell.
    eye: vec3<f32>,
    // Pixels per world unit at a distance of one unit on the axis; in a parallel view, at any distance.
    focal: f32,
    // Unit vector of the view direction; also in a parallel view.
    ahead: vec3<f32>,
    // Allowed error on screen, in pixels.
    pixels: f32,
    // The distance of the near plane.
    near: f32,
    // 1 for a perspective view, 0 for a parallel one.
    perspective: f32,
    // Number of pixels of the viewport.
    pixel_count: f32,
    unused: f32,
}

// A view: its volume, and the cameras that decide levels of detail.
struct SelectView {
    // Planes of the view volume, relative to the corner of the view's cell: unit normals that point inwards, and distances. The
    // plane (0, 0, 0, 1) excludes nothing.
    planes: array<vec4<f32>, 6>,
    cameras: array<LodCamera, 4>,
    // The cell of the origin: positions are relative to its corner.
    cell: vec3<i32>,
    // Visibility mask, 16 bits: the view sees instances whose mask shares a bit with it.
    mask: u32,
    // Number of cameras, 1 to `VIEW_CAMERAS`.
    camera_count: u32,
    // 1 if this is the first view of the frame. It resets the allowed displacements.
    is_first: u32,
    // 1 if the view sees only instances that cast shadows.
    casters: u32,
    // Number of blocks of instances.
    blocks: u32,
    // 1 if the view was in the last frame too: the decisions and the placements in the buffers are then that frame's.
    is_next: u32,
    // Seconds since the view's last frame.
    seconds: f32,
    unused_a: u32,
    unused_b: u32,
    // Rows x, y and w of the transform from positions relative to the corner of the view's cell to clip space, in units of half
    // the picture's height.
    clip_rows: array<vec4<f32>, 3>,
    // The same rows in the view's last frame, for placements of that frame.
    last_clip_rows: array<vec4<f32>, 3>,
}

// Bound of the rounding error of results that are computed from positions relative to the corner of the view's cell. Unit: the
// sum of the positions' lengths.
const POSITION_SLACK: f32 = 3e-6;
