//! Allowed displacement: the largest displacement of a surface that a view's limit in pixels permits. One formula computes it for
//! levels of detail, bone gates and influences. CPU reference of `wgsl/lod/allowed.wgsl`. `docs/pixel-bounds.md` derives the
//! formula.

use glam::Vec3;

use super::LodCamera;
use crate::shared::lod::allowed::{ALLOWED_MARGIN, LEAST_SCALE, MAX_ALLOWED};
use crate::shared::lod::view::POSITION_SLACK;

impl LodCamera {
    /// Allowed displacement of a sphere, in world units. If every point inside moves by at most this distance, the camera draws
    /// each point at most `self.pixels` pixels from its original position. CPU reference of `camera_allows`.
    pub fn allows(&self, center: Vec3, radius: f32) -> f32 {
        if self.perspective == 0.0 {
            return ALLOWED_MARGIN * (self.pixels / self.focal);
        }
        let [depth, across] = self.nearest(center, radius);
        if depth <= self.near {
            return 0.0;
        }
        let cosine = depth / (depth * depth + across * across).sqrt();
        let allowed = ALLOWED_MARGIN * (self.pixels * cosine * depth / (self.focal + self.pixels * cosine));
        if depth - allowed <= self.near { 0.0 } else { allowed }
    }

    /// Upper bound, in pixels, of the movement on the screen of a point in a sphere that moves by `displacement`, in world units.
    /// It is large if the sphere reaches the near plane, and infinite if points may come nearer than that plane's depth.
    #[cfg(feature = "gpu")]
    pub(crate) fn pixels_of(&self, displacement: f32, center: Vec3, radius: f32) -> f32 {
        if self.perspective == 0.0 {
            return self.focal * displacement;
        }
        let [depth, across] = self.nearest(center, radius);
        let depth = depth.max(self.near);
        let cosine = depth / (depth * depth + across * across).sqrt();
        let left = depth - displacement;
        if left > 0.0 { self.focal * displacement / (cosine * left) } else { f32::INFINITY }
    }

    /// The smallest depth of a point in a sphere, and the largest distance of a point from the view axis. A sphere behind the camera
    /// counts as if it were at the same distance in front.
    fn nearest(&self, center: Vec3, radius: f32) -> [f32; 2] {
        let towards = center - self.eye;
        let ahead = self.ahead.dot(towards);
        let aside = (towards - ahead * self.ahead).length();
        let around = radius + POSITION_SLACK * (center.length() + self.eye.length() + radius);
        match ahead + around < 0.0 {
            true => [towards.length() - around, 0.0],
            false => [ahead - around, aside + around],
        }
    }
}

/// Smallest displacement that any of the cameras allows a sphere, in model units. `scale` is the largest scale factor from model
/// units to world units.
pub fn allowed_by(cameras: &[LodCamera], center: Vec3, radius: f32, scale: f32) -> f32 {
    let least = cameras.iter().map(|camera| camera.allows(center, radius)).fold(MAX_ALLOWED, f32::min);
    (least / scale.max(LEAST_SCALE)).min(MAX_ALLOWED)
}
