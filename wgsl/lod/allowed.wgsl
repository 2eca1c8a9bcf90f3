// What a view allows: the displacement by which a surface may be off. This is the one formula from pixels to levels, gates and
// influences; `src/lod/allowed.rs` is its reference.
import package::wgsl::lod::view::{LodCamera, POSITION_SLACK};

// What `camera_allows` keeps back, so that no rounding, its own or that of what is computed from its result, permits more
// than `pixels`.
const ALLOWED_MARGIN: f32 = 0.9999;
// The largest displacement that is allowed, in the model's units: it keeps quotients of it finite.
const MAX_ALLOWED: f32 = 1e9;
// The least scale by which a displacement is divided.
const LEAST_SCALE: f32 = 1e-9;

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

// A displacement in world units, in units of a model with this largest scale.
fn allowed_in_model(allowed: f32, scale: f32) -> f32 {
    return min(allowed / max(scale, LEAST_SCALE), MAX_ALLOWED);
}
