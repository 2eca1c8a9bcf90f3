//! The bounds that parity cases give each ray hold for other roundings than the reference's, and they are narrow.

use relievo::ops::hash::threefry2x32;
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::{Address, HeightMap, March, ReliefMethod, ReliefRay};
use relievo_lab::cases::surface::bounds::{Judged, Source, judge};
use relievo_lab::cases::surface::{Shape, random_map, random_rays};
use relievo_lab::measure::relief::exact::exact;

use crate::height;

/// A map, rays on it, and the bounds of each ray.
struct Scene {
    map: HeightMap,
    march: March,
    rays: Vec<ReliefRay>,
    judged: Vec<Judged>,
}

fn scenes(method: ReliefMethod) -> Vec<Scene> {
    let sizes = [[5, 4], [64, 64], [33, 100], [129, 127]];
    let all = sizes.into_iter().zip(Shape::ALL).zip(0..);
    let both =
        all.flat_map(|(scene, case)| [Address::Wrap, Address::Clamp].map(|address| (scene, case, address)));
    let scenes = both.map(|((size, shape), case, address)| {
        let map = random_map(case, size, shape).expect("a map");
        let march = March { address, steps: [6, 24 + case], binary_steps: 14 };
        let rays = random_rays(case, 1000);
        let judged = judge(&map, method, &march, &rays, Source::Given).expect("judged");
        Scene { map, march, rays, judged }
    });
    scenes.collect()
}

fn travel(ray: &ReliefRay, map: &HeightMap) -> f64 {
    let [x, y] = [f64::from(map.width()), f64::from(map.height())];
    (f64::from(ray.slope[0]) * x).hypot(f64::from(ray.slope[1]) * y)
}

/// The hit that a method finds in f64; `None` for rays from behind the polygon.
fn in_f64(map: &HeightMap, method: ReliefMethod, ray: &ReliefRay, march: &March) -> Option<f64> {
    let above = |parameter: f64| 1.0 - parameter - height(map, ray, parameter, march.address);
    let (polygon, cosine) = (f64::from(ray.polygon), f64::from(ray.cosine));
    if cosine <= 0.0 {
        return None;
    }
    Some(match method {
        ReliefMethod::Plain => polygon,
        ReliefMethod::Parallax => polygon + above(polygon),
        ReliefMethod::ParallaxLimited => polygon + cosine * above(polygon),
        ReliefMethod::Cone | ReliefMethod::Quadtree => exact(map, ray, march.address)?.parameter,
        ReliefMethod::Relief | ReliefMethod::Occlusion => {
            let [low, high] = march.steps.map(f64::from);
            let steps = (low + (high - low) * (1.0 - cosine.min(1.0))).ceil();
            let stop = (1..).map(f64::from).find(|step| *step >= steps || above(step / steps) <= 0.0)?;
            let (mut start, mut end) = ((stop - 1.0) / steps, stop / steps);
            if method == ReliefMethod::Occlusion {
                let (over, below) = (above(start).max(0.0), (-above(end)).max(0.0));
                let fraction = if over + below > 1e-12 { over / (over + below) } else { 1.0 };
                return Some(start + fraction * (end - start));
            }
            for _ in 0..march.binary_steps {
                let middle = 0.5 * (start + end);
                if above(middle) <= 0.0 { end = middle } else { start = middle }
            }
            0.5 * (start + end)
        }
    })
}

/// Arithmetic in f64 rounds differently from f32 at every step; the hits of both lie within the bounds.
#[test]
fn what_methods_find_in_f64_lies_within_each_rays_bound() {
    for method in ReliefMethod::ALL {
        let mut largest = 0.0_f64;
        for Scene { map, march, rays, judged } in scenes(method) {
            for (ray, judged) in rays.iter().zip(&judged) {
                let Some(parameter) = in_f64(&map, method, ray, &march) else { continue };
                let off = (parameter - f64::from(judged.expected.parameter)).abs();
                let ratio = (off / judged.parameter).max(off * travel(ray, &map) / judged.texels);
                assert!(ratio <= 1.0, "{method:?} {march:?}: {ray:?}: {parameter} beside {judged:?}");
                largest = largest.max(ratio);
            }
        }
        assert!(
            method == ReliefMethod::Plain || largest > 0.02,
            "{method:?}: rounding comes to {largest} of the bounds"
        );
    }
}

/// Rays whose numbers are changed by one ulp, as rounding may change them, hit within the bounds. Rays that are marked
/// as steady also make the same loads.
#[test]
fn rays_an_ulp_off_stay_within_bounds_and_steady_ones_make_the_same_loads() {
    for method in ReliefMethod::ALL {
        let (mut steady, mut others) = (0, 0);
        for Scene { map, march, rays, judged } in scenes(method) {
            let surface = ReliefSurface::new(&map, method, march.address);
            for (index, (ray, judged)) in rays.iter().zip(&judged).enumerate() {
                for turn in 0..4 {
                    let words = threefry2x32([turn, 7], [index as u32; 8], [0, 1, 2, 3, 4, 5, 6, 7]).0;
                    let near = |value: f32, word: u32| match word % 3 {
                        0 => value.next_up(),
                        1 => value.next_down(),
                        _ => value,
                    };
                    let axes = |values: [f32; 2], at: usize| {
                        [near(values[0], words[at]), near(values[1], words[at + 1])]
                    };
                    let moved = ReliefRay { origin: axes(ray.origin, 0), slope: axes(ray.slope, 2), ..*ray };
                    let hit = surface.trace(method, &moved, &march);
                    let off = f64::from((hit.parameter - judged.expected.parameter).abs());
                    assert!(
                        off <= judged.parameter,
                        "{method:?} {march:?}: {moved:?}: {hit:?} beside {judged:?}"
                    );
                    let is_same = hit.samples == judged.expected.samples;
                    assert!(
                        is_same || !judged.is_steady,
                        "{method:?} {march:?}: {moved:?}: {hit:?} beside {judged:?}"
                    );
                    steady += usize::from(judged.is_steady);
                    others += usize::from(!is_same);
                }
            }
        }
        assert!(
            steady > 4 * 7000,
            "{method:?}: only {steady} of 32,000 are steady; {others} made other loads"
        );
    }
}

/// The bound of an ordinary ray is a few thousandths of a texel.
#[test]
fn most_bounds_are_narrow() {
    for method in ReliefMethod::ALL {
        let mut bounds: Vec<f64> =
            scenes(method).iter().flat_map(|scene| scene.judged.iter().map(|judged| judged.texels)).collect();
        bounds.sort_unstable_by(f64::total_cmp);
        let at = |fraction: f64| bounds[(fraction * bounds.len() as f64) as usize];
        assert!(
            at(0.5) < 1e-3 && at(0.85) < 0.02,
            "{method:?}: half below {}, 85 of 100 below {}",
            at(0.5),
            at(0.85)
        );
    }
}

/// Rounding decides whether a ray that grazes a post hits it, so the bound of this ray contains both results.
#[test]
fn a_ray_that_grazes_says_so() {
    let mut heights = vec![0.0; 64];
    heights[4 * 8 + 4] = 0.5;
    let map = HeightMap::new(8, 8, heights).expect("a map");
    let march = March { address: Address::Clamp, ..March::default() };
    // The ray passes the post's tip at height 1/2, above it by 1e-7 or by 1e-3.
    let ray = |by: f32| ReliefRay { origin: [0.0625, 0.5625], slope: [1.0, by], cosine: 0.5, polygon: 0.0 };
    let judged =
        |by: f32| judge(&map, ReliefMethod::Quadtree, &march, &[ray(by)], Source::Given).expect("judged")[0];
    assert!(judged(1e-7).touches() && judged(1e-7).texels > 3.0, "{:?}", judged(1e-7));
    assert!(judged(1e-3).texels < 0.5 * judged(1e-7).texels, "{:?}", judged(1e-3));
}
