//! Relief methods without a search: the CPU reference of `wgsl/surface/flat.wgsl`.

use super::height::{BILINEAR, height};
use crate::surface::map::HeightMap;
use crate::surface::relief::{March, Outcome, ReliefHit, ReliefRay};

/// Traces nothing: returns the polygon's own texture coordinates.
pub(crate) fn plain(ray: &ReliefRay) -> ReliefHit {
    ReliefHit::of(ray, ray.polygon, 0, Outcome::Hit)
}

/// Kaneko's parallax mapping: shifts the texture coordinates by one height sample.
pub(crate) fn parallax(map: &HeightMap, ray: &ReliefRay, march: &March) -> ReliefHit {
    shifted(map, ray, march, 1.0)
}

/// Parallax mapping with Welsh's offset limiting, which omits the division by the ray's cosine.
pub(crate) fn parallax_limited(map: &HeightMap, ray: &ReliefRay, march: &March) -> ReliefHit {
    shifted(map, ray, march, ray.cosine)
}

fn shifted(map: &HeightMap, ray: &ReliefRay, march: &March, limit: f32) -> ReliefHit {
    let height = height(map, ray.at(ray.polygon), march.address);
    let parameter = ray.polygon - (height - (1.0 - ray.polygon)) * limit;
    ReliefHit { height, ..ReliefHit::of(ray, parameter, BILINEAR, Outcome::Hit) }
}
