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
