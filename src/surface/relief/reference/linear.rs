//! Linear search: the CPU reference of `wgsl/surface/linear.wgsl`.

use super::height::{BILINEAR, height};
use crate::shared::surface::linear::SURFACE_LEAST_SPAN as LEAST_SPAN;
use crate::surface::map::HeightMap;
use crate::surface::relief::{MAX_BINARY, MAX_STEPS, March, Outcome, ReliefHit, ReliefRay};

/// The two points between which a linear search stopped: the last point above the surface, and the first point on or below it.
struct Bracket {
    above: f32,
    under: f32,
    height_above: f32,
    height_under: f32,
    samples: u32,
}

fn steps(march: &March, cosine: f32) -> u32 {
    let [low, high] = march.steps.map(|steps| steps as f32);
    let steps = (low + (high - low) * (1.0 - cosine.min(1.0))).ceil();
    (steps as u32).clamp(1, MAX_STEPS)
}

fn search(map: &HeightMap, ray: &ReliefRay, march: &March) -> Bracket {
    let steps = steps(march, ray.cosine);
    let width = 1.0 / steps as f32;
    let mut bracket = Bracket { above: 0.0, under: 1.0, height_above: 0.0, height_under: 0.0, samples: 0 };
    for step in 1..=steps {
        let parameter = if step == steps { 1.0 } else { step as f32 * width };
        let height = height(map, ray.at(parameter), march.address);
        bracket.samples += BILINEAR;
        if 1.0 - parameter <= height || step == steps {
            bracket.under = parameter;
            bracket.height_under = height;
            break;
        }
        bracket.above = parameter;
        bracket.height_above = height;
    }
    bracket
}

/// Relief mapping: linear search, then binary search.
pub(crate) fn relief(map: &HeightMap, ray: &ReliefRay, march: &March) -> ReliefHit {
    let bracket = search(map, ray, march);
    narrowed(map, ray, march, [bracket.above, bracket.under], bracket.samples)
}

/// Binary search between a parameter above the surface and a parameter on or below it.
pub(crate) fn narrowed(
    map: &HeightMap,
    ray: &ReliefRay,
    march: &March,
    [mut above, mut under]: [f32; 2],
    mut samples: u32,
) -> ReliefHit {
    for _ in 0..march.binary_steps.min(MAX_BINARY) {
        let middle = 0.5 * (above + under);
        samples += BILINEAR;
        if 1.0 - middle <= height(map, ray.at(middle), march.address) {
            under = middle;
        } else {
            above = middle;
        }
    }
    ReliefHit::of(ray, 0.5 * (above + under), samples, Outcome::Hit)
}

/// Parallax occlusion mapping: linear search, then the intersection with the segment between the last two samples.
pub(crate) fn occlusion(map: &HeightMap, ray: &ReliefRay, march: &March) -> ReliefHit {
    let mut bracket = search(map, ray, march);
    if bracket.above == 0.0 {
        bracket.height_above = height(map, ray.origin, march.address);
        bracket.samples += BILINEAR;
    }
    let over = (1.0 - bracket.above - bracket.height_above).max(0.0);
    let below = (bracket.height_under - (1.0 - bracket.under)).max(0.0);
    let fraction = if over + below > LEAST_SPAN { over / (over + below).max(LEAST_SPAN) } else { 1.0 };
    let parameter = bracket.above + fraction * (bracket.under - bracket.above);
    ReliefHit::of(ray, parameter, bracket.samples, Outcome::Hit)
}
