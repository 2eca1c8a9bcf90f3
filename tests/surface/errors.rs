//! Measures the error and the cost of each method on the built-in maps, against what the method promises. The relief
//! is 0.1 tiles deep, and addresses wrap.

use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::{Address, HeightMap, March, ReliefMethod, ReliefRay};
use relievo_lab::measure::relief::{Measured, SquareView};
use relievo_samples::BuiltInMap;

fn rays(angle: f64) -> Vec<ReliefRay> {
    let view = SquareView { angle, azimuth: 25.0, tiles: 1.0, size: [120, 120] };
    view.rays(0.1, 1.0).into_iter().flatten().collect()
}

fn measured(surface: &ReliefSurface<'_>, method: ReliefMethod, angle: f64, steps: u32) -> Measured {
    let rays = rays(angle);
    let march = March { steps: [steps, steps], ..March::default() };
    Measured::of(surface.map, Address::Wrap, &rays, &surface.trace_all(method, &rays, &march))
}

fn each_map(check: impl Fn(BuiltInMap, &HeightMap)) {
    for kind in BuiltInMap::ALL {
        check(kind, &kind.height_map(256).expect("a map"));
    }
}

#[test]
fn quadtree_is_exact_at_every_angle() {
    each_map(|kind, map| {
        let surface = ReliefSurface::new(map, ReliefMethod::Quadtree, Address::Wrap);
        for angle in [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0] {
            let measured = measured(&surface, ReliefMethod::Quadtree, angle, 1);
            assert!(measured.rays > 1000 && measured.misses == 0, "{kind:?} {angle}: {measured:?}");
            assert!(measured.p99_error_texels <= 0.05, "{kind:?} {angle}: {measured:?}");
        }
    });
}

/// For a mean error of a quarter texel, cone maps need at most half of the loads that relief mapping needs.
#[test]
fn cone_costs_half_of_relief_for_the_same_error() {
    each_map(|kind, map| {
        let surface = ReliefSurface::new(map, ReliefMethod::Cone, Address::Wrap);
        let cone = measured(&surface, ReliefMethod::Cone, 60.0, 1);
        assert!(cone.mean_error_texels <= 0.25 && cone.misses == 0, "{kind:?}: {cone:?}");
        let relief = (0..=10)
            .map(|power| measured(&surface, ReliefMethod::Relief, 60.0, 1 << power))
            .filter(|relief| relief.mean_error_texels <= 0.25)
            .min_by(|a, b| a.mean_samples.total_cmp(&b.mean_samples));
        let needed = relief.expect("enough steps are exact").mean_samples;
        assert!(2.0 * cone.mean_samples <= needed, "{kind:?}: {} against {needed} loads", cone.mean_samples);
    });
}

#[test]
fn errors_of_linear_search_fall_as_steps_rise() {
    each_map(|kind, map| {
        for method in [ReliefMethod::Relief, ReliefMethod::Occlusion] {
            let surface = ReliefSurface::new(map, method, Address::Wrap);
            for angle in [30.0, 60.0, 80.0] {
                let errors = [4, 8, 16, 32, 64, 128, 256]
                    .map(|steps| measured(&surface, method, angle, steps).mean_error_texels);
                // Errors fall with the number of steps, wherever the first step lies.
                let falls = errors.windows(2).all(|pair| pair[1] <= pair[0] * 1.02 + 1e-6);
                assert!(falls && errors[6] * 4.0 <= errors[0], "{kind:?} {method:?} {angle}: {errors:?}");
            }
        }
    });
}

/// Linear steps pass thin posts (B figure 3.6); cones and the quadtree do not.
#[test]
fn posts_are_lost_by_steps_alone() {
    let map = BuiltInMap::Posts.height_map(256).expect("a map");
    let surface = ReliefSurface::new(&map, ReliefMethod::Cone, Address::Wrap);
    let relief = measured(&surface, ReliefMethod::Relief, 60.0, 10);
    assert!(relief.p99_error_texels > 10.0, "B's ten steps: {relief:?}");
    let surface = ReliefSurface { pyramid: surface.pyramid.clone(), ..surface };
    for method in [ReliefMethod::Cone, ReliefMethod::Quadtree] {
        let safe = measured(&surface, method, 60.0, 10);
        assert!(safe.p99_error_texels < 0.05, "{method:?}: {safe:?}");
    }
}

#[test]
fn straight_down_nothing_is_displaced() {
    each_map(|kind, map| {
        for method in ReliefMethod::ALL {
            let measured = measured(&ReliefSurface::new(map, method, Address::Wrap), method, 0.0, 16);
            assert!(measured.max_error_texels < 1e-3, "{kind:?} {method:?}: {measured:?}");
        }
    });
}
