//! No method loses the first crossing of a ray with the surface, for random rays and random maps of odd sizes, in both
//! address modes.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::{Address, HeightMap, March, Outcome, ReliefHit, ReliefMethod, ReliefRay};

use crate::height;

/// How much heights may differ: positions of up to 400 texels are rounded by up to 2⁻²³ · 400 < 5e-5 texels, heights
/// change by at most 1 a texel, and two positions are rounded.
const BOUND: f64 = 1e-4;

fn settings() -> ProptestConfig {
    ProptestConfig {
        cases: 600,
        rng_seed: RngSeed::Fixed(2008),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn maps() -> impl Strategy<Value = HeightMap> {
    let noise = 0.0..=1.0_f32;
    let steps = prop_oneof![Just(0.0_f32), Just(0.5), Just(1.0)];
    let posts = prop_oneof![9 => 0.0..0.05_f32, 1 => 0.9..=1.0_f32];
    let height = prop_oneof![Just(noise.boxed()), Just(steps.boxed()), Just(posts.boxed())];
    (1..24_u32, 1..24_u32, height).prop_flat_map(|(width, height, texel)| {
        let texels = proptest::collection::vec(texel, (width * height) as usize);
        texels.prop_map(move |heights| HeightMap::new(width, height, heights).expect("a map"))
    })
}

fn rays(map: &HeightMap) -> impl Strategy<Value = Vec<ReliefRay>> + use<> {
    // Random positions, and positions exactly above texel centers and edges, where cells meet.
    let place = |edge: u32| {
        prop_oneof![
            2 => (-1.0..2.0_f32).boxed(),
            1 => (0..4 * edge).prop_map(move |half| (half as f32 * 0.5 - edge as f32) / edge as f32).boxed(),
        ]
    };
    let turn = prop_oneof![4 => 0.0..std::f32::consts::TAU, 1 => (0..8).prop_map(|i| i as f32 * std::f32::consts::FRAC_PI_4)];
    let steepness = prop_oneof![6 => 0.03..=1.0_f32, 1 => Just(1.0_f32)];
    let scale = prop_oneof![6 => 0.0..0.3_f32, 1 => Just(0.0_f32)];
    let ray = (place(map.width()), place(map.height()), turn, steepness, scale);
    let ray = ray.prop_map(|(u, v, turn, cosine, scale)| {
        let sine = (1.0 - cosine * cosine).sqrt();
        // Rays at multiples of a quarter turn run exactly along an axis.
        let exact = |part: f32| if part.abs() < 1e-6 { 0.0 } else { part };
        let view = [sine * exact(libm::cosf(turn)), sine * exact(libm::sinf(turn)), cosine];
        ReliefRay::new([u, v], view, scale, 1.0)
    });
    proptest::collection::vec(ray, 40)
}

fn scenes() -> impl Strategy<Value = (HeightMap, Vec<ReliefRay>)> {
    maps().prop_flat_map(|map| (Just(map.clone()), rays(&map)))
}

/// A hit lies on the surface, and before the hit the ray is nowhere below the surface by more than the bound.
fn is_first(map: &HeightMap, ray: &ReliefRay, hit: &ReliefHit, address: Address) -> Result<(), String> {
    let found = f64::from(hit.parameter);
    let above = |parameter: f64| 1.0 - parameter - height(map, ray, parameter, address);
    if hit.outcome() != Outcome::Hit {
        return Err(format!("{:?} at {found}", hit.outcome()));
    }
    if above(found).abs() > 2.0 * BOUND {
        return Err(format!("{found} is {} above the surface", above(found)));
    }
    for step in 0..1500 {
        let parameter = found * f64::from(step) / 1500.0;
        if above(parameter) < -BOUND {
            return Err(format!("crosses at {parameter}, {} deep, before {found}", -above(parameter)));
        }
    }
    Ok(())
}

fn march(address: Address) -> March {
    March { address, binary_steps: 24, ..March::default() }
}

fn address() -> impl Strategy<Value = Address> {
    prop_oneof![Just(Address::Wrap), Just(Address::Clamp)]
}

proptest! {
    #![proptest_config(settings())]

    #[test]
    fn quadtree_and_cone_find_the_first_crossing((map, rays) in scenes(), address in address()) {
        for method in [ReliefMethod::Quadtree, ReliefMethod::Cone] {
            let surface = ReliefSurface::new(&map, method, address);
            for ray in &rays {
                let hit = surface.trace(method, ray, &march(address));
                let first = is_first(&map, ray, &hit, address);
                prop_assert!(first.is_ok(), "{method:?} {ray:?}: {first:?}");
            }
        }
    }

    /// Linear search may miss what is thinner than a step, but the hits that it returns lie on the surface.
    #[test]
    fn relief_ends_on_the_surface((map, rays) in scenes(), address in address()) {
        let surface = ReliefSurface::new(&map, ReliefMethod::Relief, address);
        for ray in &rays {
            let hit = surface.trace(ReliefMethod::Relief, ray, &march(address));
            let over = 1.0 - f64::from(hit.parameter) - height(&map, ray, f64::from(hit.parameter), address);
            prop_assert!(over.abs() <= 2.0 * BOUND, "{ray:?}: {hit:?} is {over} above");
        }
    }
}

/// Cones that are too wide lose crossings, and the check fails.
#[test]
fn wider_cones_are_found_out() {
    let map = relievo_samples::BuiltInMap::Posts.height_map(64).expect("a map");
    let mut surface = ReliefSurface::new(&map, ReliefMethod::Cone, Address::Wrap);
    let rays: Vec<ReliefRay> = (0..2000)
        .map(|i| ReliefRay::new([i as f32 * 0.017, i as f32 * 0.031], [0.6, 0.6, 0.53], 0.3, 1.0))
        .collect();
    let lost = |surface: &ReliefSurface<'_>| {
        let hit = |ray: &ReliefRay| surface.trace(ReliefMethod::Cone, ray, &march(Address::Wrap));
        rays.iter().filter(|ray| is_first(&map, ray, &hit(ray), Address::Wrap).is_err()).count()
    };
    assert_eq!(lost(&surface), 0);
    surface.cones.iter_mut().for_each(|cone| cone[1] *= 6.0);
    assert!(lost(&surface) > 20, "only {} of 2000 rays are found out", lost(&surface));
}

#[test]
fn rays_from_behind_miss() {
    let map = HeightMap::new(2, 2, vec![0.5; 4]).expect("a map");
    for method in ReliefMethod::ALL {
        let surface = ReliefSurface::new(&map, method, Address::Wrap);
        for cosine in [0.0, -0.5, f32::NAN] {
            let ray = ReliefRay::new([0.3, 0.4], [0.1, 0.1, cosine], 0.1, 1.0);
            let hit = surface.trace(method, &ray, &March::default());
            assert_eq!((hit.outcome(), hit.samples, hit.uv), (Outcome::Miss, 0, ray.origin), "{method:?}");
        }
    }
}

/// Rays that run along one axis, exactly above a line of texel centers, never leave their cell in the other direction.
#[test]
fn rays_along_an_axis_do_not_stall() {
    for (width, column) in [(11_u32, 6_u32), (97, 3), (23, 3), (81, 5), (13, 3)] {
        let height = |at: u32| ((at * 7919 + 13) % 97) as f32 / 96.0;
        let map = HeightMap::new(width, 8, (0..width * 8).map(height).collect()).expect("a map");
        let u = (column as f32 + 0.5) / width as f32;
        for address in [Address::Wrap, Address::Clamp] {
            for method in [ReliefMethod::Quadtree, ReliefMethod::Cone] {
                let surface = ReliefSurface::new(&map, method, address);
                for (number, slope) in
                    [[0.0, 0.0], [-1.5e-17, -0.24], [0.0, 0.17]].into_iter().cycle().take(600).enumerate()
                {
                    let ray =
                        ReliefRay { origin: [u, number as f32 * 0.0043], slope, cosine: 1.0, polygon: 0.0 };
                    let first = is_first(&map, &ray, &surface.trace(method, &ray, &march(address)), address);
                    assert!(first.is_ok(), "{method:?} {address:?} {width} {ray:?}: {first:?}");
                }
            }
        }
    }
}

#[test]
fn rays_of_nonsense_end() {
    let map = HeightMap::new(5, 3, vec![0.5; 15]).expect("a map");
    for method in ReliefMethod::ALL {
        let surface = ReliefSurface::new(&map, method, Address::Wrap);
        for odd in [f32::NAN, f32::INFINITY, -1e30] {
            for (origin, slope) in [([odd, 0.5], [0.1, 0.1]), ([0.5, 0.5], [odd, 0.1])] {
                let ray = ReliefRay { origin, slope, cosine: 1.0, polygon: 0.0 };
                surface.trace(method, &ray, &March::default());
            }
        }
    }
}
