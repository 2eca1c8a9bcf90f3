//! What is decided where thesis B contradicts itself on surface mapping (`docs/sources.md`).

use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::{Address, HeightMap, March, ReliefMaterial, ReliefMethod, ReliefRay};

/// Towards the eye: 3 across and 4 up.
const VIEW: [f32; 3] = [0.6, 0.0, 0.8];

const UV: [f32; 2] = [0.25, 0.5];

const SCALE: f32 = 0.1;

/// A surface of one height.
fn flat(height: f32) -> HeightMap {
    HeightMap::new(8, 8, vec![height; 64]).expect("valid")
}

/// How far a method moves u, in units of `SCALE` · V.x / V.z, where the polygon lies at height `plane`.
fn shift(method: ReliefMethod, plane: f32, height: f32) -> f32 {
    let map = flat(height);
    let surface = ReliefSurface::new(&map, method, Address::Wrap);
    let march = March { steps: [256, 256], binary_steps: 16, ..March::default() };
    let hit = surface.trace(method, &ReliefRay::new(UV, VIEW, SCALE, plane), &march);
    (hit.uv[0] - UV[0]) / (SCALE * VIEW[0] / VIEW[2])
}

/// With B's bias of +½ · scale, the middle height would move by a whole scale; with −½ it stays.
#[test]
fn the_bias_of_parallax_is_negative() {
    for (plane, height) in [(0.5, 0.0), (0.5, 0.5), (0.5, 0.75), (1.0, 0.25), (0.0, 0.25)] {
        let found = shift(ReliefMethod::Parallax, plane, height);
        assert!((found - (height - plane)).abs() < 1e-5, "{found} at {plane}, {height}");
        let limited = shift(ReliefMethod::ParallaxLimited, plane, height);
        assert!((limited - (height - plane) * VIEW[2]).abs() < 1e-5, "{limited} at {plane}, {height}");
    }
}

/// By default the highest points lie in the polygon and all others below it, for every method that shifts by the full depth.
#[test]
fn the_polygon_is_the_top_of_the_relief() {
    let top = ReliefMaterial::default().plane;
    assert_eq!(top, 1.0);
    for method in ReliefMethod::ALL {
        if [ReliefMethod::Plain, ReliefMethod::ParallaxLimited].contains(&method) {
            continue;
        }
        for height in [1.0, 0.75, 0.25] {
            let found = shift(method, top, height);
            assert!((found - (height - 1.0)).abs() < 1e-3, "{method:?}: {found} at {height}");
        }
        // Table 4.4 has it at the bottom.
        let bottom = shift(method, 0.0, 0.25);
        assert!((bottom - 0.25).abs() < 1e-3, "{method:?}: {bottom}");
    }
}

/// A surface at the bottom is found in the last step.
#[test]
fn linear_steps_grow_with_the_angle() {
    let map = flat(0.0);
    let march = March { steps: [8, 24], binary_steps: 0, ..March::default() };
    for method in [ReliefMethod::Relief, ReliefMethod::Occlusion] {
        let surface = ReliefSurface::new(&map, method, Address::Wrap);
        let loads = |cosine: f32| {
            let view = [(1.0 - cosine * cosine).sqrt(), 0.0, cosine];
            surface.trace(method, &ReliefRay::new(UV, view, SCALE, 1.0), &march).samples
        };
        let found = [1.0, 0.75, 0.5, 0.0625].map(loads);
        assert_eq!(found, [8, 12, 16, 23].map(|steps| 4 * steps), "{method:?}");
    }
}
