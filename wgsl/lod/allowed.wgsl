// Allowed displacement: the largest distance between the drawn and the exact surface that a view permits. It is computed from
// the allowed error in pixels. The limits of levels, gates and influences are all derived from it. `src/lod/allowed.rs` is the
// reference.
import package::wgsl::lod::view::{LodCamera, POSITION_SLACK};

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
