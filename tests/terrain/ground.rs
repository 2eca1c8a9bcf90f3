//! Compares the ground at world positions with vertical rays through the triangles of the exported meshes.

use glam::DVec3;
use relievo::ops::terrain::config::{Border, TerrainConfig};
use relievo::ops::terrain::field::field;
use relievo::ops::terrain::ground::Ground;
use relievo::ops::terrain::mesh::{GroundPoint, HeightField};
use relievo::ops::terrain::recipe::Recipe;

const SIZE: u32 = 9;
const EDGE: i32 = SIZE as i32 - 1;

/// The 3×3 patches around (0, 0), some with negative coordinates.
const BLOCK: [[i32; 2]; 9] =
    [[-2, -2], [-1, -2], [0, -2], [-2, -1], [-1, -1], [0, -1], [-2, 0], [-1, 0], [0, 0]];

fn config(terrain_scale: f64) -> TerrainConfig {
    TerrainConfig { terrain_scale, ..TerrainConfig::new(SIZE, 12.0, "ground").expect("valid") }
}

fn heights(config: &TerrainConfig, patches: &[[i32; 2]]) -> Vec<Vec<i32>> {
    field(&Recipe::new(config.clone()), patches, 0).expect("valid")
}

fn ground(config: &TerrainConfig, patches: &[[i32; 2]]) -> Ground {
    let mut ground = Ground::new(config).expect("valid");
    for (patch, heights) in patches.iter().zip(heights(config, patches)) {
        ground.insert(*patch, &heights, 0).expect("as many as there should be");
    }
    ground
}

/// The triangles of the patches' OBJ files, in world space.
fn exported(config: &TerrainConfig, patches: &[[i32; 2]]) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for (patch, heights) in patches.iter().zip(heights(config, patches)) {
        let field = HeightField::new(heights, SIZE as usize, config.terrain_scale).expect("square");
        let mut text = Vec::new();
        field.write_obj(&mut text, patch.map(|index| i64::from(index * EDGE))).expect("a vector takes all");
        let text = String::from_utf8(text).expect("ASCII");
        let numbers = |prefix: &'static str| {
            text.lines().filter_map(move |line| line.strip_prefix(prefix)).map(|rest| {
                let number = |word: &str| word.split('/').next().and_then(|first| first.parse::<f64>().ok());
                let [a, b, c] =
                    [0, 1, 2].map(|at| rest.split(' ').nth(at).and_then(number).expect("a number"));
                DVec3::new(a, b, c)
            })
        };
        let points: Vec<_> = numbers("v ").collect();
        triangles.extend(numbers("f ").map(|face| face.to_array().map(|index| points[index as usize - 1])));
    }
    triangles
}

/// Where a vertical ray at (x, z) meets a triangle, and the triangle's normal (Möller and Trumbore 1997).
fn hit([a, b, c]: [DVec3; 3], x: f64, z: f64) -> Option<GroundPoint> {
    let (ray, origin) = (DVec3::NEG_Y, DVec3::new(x, 1e3, z));
    let (ab, ac) = (b - a, c - a);
    let across = ray.cross(ac);
    let inverse = 1.0 / ab.dot(across);
    let u = inverse * (origin - a).dot(across);
    let v = inverse * ray.dot((origin - a).cross(ab));
    let inside = u >= -1e-9 && v >= -1e-9 && u + v <= 1.0 + 1e-9;
    let distance = inverse * ac.dot((origin - a).cross(ab));
    inside.then(|| GroundPoint { height: 1e3 - distance, normal: ab.cross(ac).normalize().to_array() })
}

/// Positions in samples: every sample of the block, the middles of all edges and diagonals, and positions in between.
fn positions(terrain_scale: f64) -> Vec<[f64; 2]> {
    let mut positions = Vec::new();
    for (y, x) in (-4 * EDGE..=2 * EDGE).flat_map(|y| (-4 * EDGE..=2 * EDGE).map(move |x| (y, x))) {
        positions.push([x, y].map(|half| f64::from(half) / 2.0 * terrain_scale));
    }
    let mut state = 7_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..2000 {
        positions.push([0, 1].map(|_| f64::from(EDGE) * (3.0 * random() - 2.0) * terrain_scale));
    }
    positions
}

#[test]
fn it_is_where_rays_meet_the_exported_triangles() {
    for terrain_scale in [0.25, 0.3, 1.0, 7.5] {
        let config = config(terrain_scale);
        let (ground, triangles) = (ground(&config, &BLOCK), exported(&config, &BLOCK));
        assert_eq!(triangles.len(), 9 * 2 * (EDGE * EDGE) as usize);
        for [x, z] in positions(terrain_scale) {
            let hits: Vec<_> = triangles.iter().filter_map(|triangle| hit(*triangle, x, z)).collect();
            let answer = ground.point_at(x, z).expect("inside");
            assert!(!hits.is_empty(), "({x}, {z}) is inside");
            // The change of height over 2⁻³⁰ of a sample and by a few roundings, on slopes below 100.
            let bound = 1e-7 * terrain_scale.max(1.0);
            for met in &hits {
                let error = (met.height - answer.height).abs();
                assert!(error <= bound, "({x}, {z}) × {terrain_scale}: {answer:?}, and the mesh has {met:?}");
            }
            let is_normal =
                |met: &GroundPoint| DVec3::from(met.normal).abs_diff_eq(DVec3::from(answer.normal), 1e-9);
            assert!(hits.iter().any(is_normal), "({x}, {z}) × {terrain_scale}: {answer:?}, and not {hits:?}");
        }
    }
}

#[test]
fn outside_of_all_patches_there_is_none() {
    let config = config(0.3);
    let (low, high) = (-2.0 * f64::from(EDGE) * 0.3, f64::from(EDGE) * 0.3);
    let mut ground = ground(&config, &BLOCK);
    for [x, z] in [[low, low], [high, low], [low, high], [high, high]] {
        assert!(ground.point_at(x, z).is_some(), "({x}, {z})");
        for [dx, dz] in [[1e-6 * x.signum(), 0.0], [0.0, 1e-6 * z.signum()]] {
            assert_eq!(ground.point_at(x + dx, z + dz), None, "({x}, {z})");
        }
    }
    for far in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -1e17, 1e12] {
        assert_eq!(ground.point_at(far, 0.0), None, "{far}");
        assert_eq!(ground.point_at(0.0, far), None, "{far}");
        assert_eq!(ground.point_from([i32::MIN, i32::MAX], 0.0, far), None, "{far}");
    }
    // Removing a patch leaves a hole; its neighbours still have the samples on its border.
    assert!(ground.point_at(-0.3, -0.3).is_some());
    assert!(ground.remove([-1, -1]) && !ground.remove([-1, -1]));
    assert_eq!(ground.point_at(-0.3, -0.3), None);
    assert!(ground.point_at(0.0, -0.3).is_some() && ground.point_at(-0.3, -2.4).is_some());
}

#[test]
fn patches_agree_on_their_borders_to_the_bit() {
    let config = config(0.3);
    let all = ground(&config, &BLOCK);
    let alone: Vec<_> = BLOCK.iter().map(|patch| ground(&config, &[*patch])).collect();
    let (mut shared, mut corners) = (0, 0);
    for step in 0..=72 {
        let along = (f64::from(step) / 3.0 - 16.0) * 0.3;
        for border in [-8.0 * 0.3, 0.0] {
            for [x, z] in [[along, border], [border, along]] {
                let answers: Vec<_> = alone.iter().filter_map(|patch| patch.point_at(x, z)).collect();
                let answer = all.point_at(x, z).expect("inside");
                assert!(answers.len() == 2 || answers.len() == 4, "({x}, {z}): {} patches", answers.len());
                assert!(
                    answers.iter().all(|other| other.height.to_bits() == answer.height.to_bits()),
                    "({x}, {z})"
                );
                // Of the patches that share the position, the last is the one to the south-east.
                assert_eq!(answers.last(), Some(&answer), "({x}, {z})");
                shared += 1;
                corners += usize::from(answers.len() == 4);
            }
        }
    }
    assert_eq!((shared, corners), (4 * 73, 8));
}

#[test]
fn positions_far_from_the_origin_find_their_cell() {
    let config = config(0.3);
    let far = [500_000, -500_000];
    let patches = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [far[0] + x, far[1] + y]);
    let (ground, triangles) = (ground(&config, &patches), exported(&config, &patches));
    let first = far.map(|index| f64::from(index) * f64::from(EDGE) * 0.3);
    for [x, z] in positions(0.3).into_iter().map(|at| at.map(|part| (part + 16.0 * 0.3) * 2.0 / 3.0)) {
        let near = ground.point_from(far, x, z).expect("inside");
        let beyond = ground.point_from([far[0] + 1, far[1] - 3], x - 2.4, z + 7.2).expect("inside");
        assert!((near.height - beyond.height).abs() < 1e-7, "({x}, {z}): {near:?}, {beyond:?}");
        // The world positions of this test are multiples of 2⁻³².
        let [x, z] = [first[0] + x, first[1] + z];
        let Some(answer) = ground.point_at(x, z) else { continue };
        assert!((near.height - answer.height).abs() < 1e-7, "({x}, {z}): {near:?}, {answer:?}");
        let met = triangles.iter().filter_map(|triangle| hit(*triangle, x, z));
        let worst = met.map(|met| (met.height - answer.height).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-6, "({x}, {z}): off by {worst}");
    }
}

#[test]
fn an_origin_moves_positions_and_nothing_else() {
    let config = config(0.25);
    let ground = ground(&config, &BLOCK);
    for [x, z] in positions(0.25) {
        // Positions are multiples of a quarter of a sample, which f64 represents exactly from either origin.
        let [x, z] = [x, z].map(|part| (part * 16.0).round() / 16.0);
        assert_eq!(ground.point_from([-2, -1], x + 4.0, z + 2.0), ground.point_at(x, z));
    }
}

#[test]
fn margins_are_cut_off_and_other_numbers_of_heights_are_refused() {
    let config = config(1.0);
    let wide = field(&Recipe::new(config.clone()), &[[0, 0]], 2).expect("valid").remove(0);
    let mut margin = Ground::new(&config).expect("valid");
    margin.insert([0, 0], &wide, 2).expect("13² heights");
    let plain = ground(&config, &[[0, 0]]);
    assert_eq!(margin.point_at(3.3, 4.4), plain.point_at(3.3, 4.4));
    for (length, given) in [(169, 1), (80, 0), (0, 0), (169, u32::MAX)] {
        let error = margin.insert([1, 0], &wide[..length], given).expect_err("refused").to_string();
        assert!(error.starts_with(&format!("heights = [{length} heights]: must be ")), "{error}");
    }
    assert_eq!(margin.point_at(9.0, 1.0), None);
    let error = Ground::new(&TerrainConfig { terrain_scale: 0.0, ..config.clone() }).expect_err("refused");
    assert_eq!(error.path, "terrain_scale");
    // Patches that do not blend have different heights on their common edge; the eastern patch decides.
    let config = TerrainConfig { border: Border::Wrap, ..config };
    let (both, east) = (ground(&config, &[[-1, 0], [0, 0]]), ground(&config, &[[0, 0]]));
    let west = ground(&config, &[[-1, 0]]);
    assert_ne!(west.point_at(0.0, 4.0), east.point_at(0.0, 4.0));
    assert_eq!(both.point_at(0.0, 4.0), east.point_at(0.0, 4.0));
}
