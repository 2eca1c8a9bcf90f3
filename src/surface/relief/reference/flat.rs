//! Methods that do not search: the CPU reference of `wgsl/surface/flat.wgsl`.

use super::height::{BILINEAR, height};
use crate::surface::map::HeightMap;
use crate::surface::relief::{Hit, March, Outcome, Ray};

/// The polygon's own texture coordinates.
pub fn plain(ray: &Ray) -> Hit {
    Hit::of(ray, ray.polygon, 0, Outcome::Hit)
}

/// Kaneko's parallax mapping.
pub fn parallax(map: &HeightMap, ray: &Ray, march: &March) -> Hit {
    shifted(map, ray, march, 1.0)
}

/// Parallax mapping with Welsh's offset limiting.
pub fn parallax_limited(map: &HeightMap, ray: &Ray, march: &March) -> Hit {
    shifted(map, ray, march, ray.cosine)
}

fn shifted(map: &HeightMap, ray: &Ray, march: &March, limit: f32) -> Hit {
    let height = height(map, ray.at(ray.polygon), march.address);
    let parameter = ray.polygon - (height - (1.0 - ray.polygon)) * limit;
    Hit { height, ..Hit::of(ray, parameter, BILINEAR, Outcome::Hit) }
}
