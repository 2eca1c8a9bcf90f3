//! Rays of the host against static meshes and reliefs, whose triangles these tests place themselves in f64.

use std::collections::BTreeMap;
use std::f32::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use relievo::asset::material::Alpha;
use relievo::scene::{InstanceId, Placement, Ray, Relief, Scene};
use relievo_samples::maps::BuiltInMap;

use crate::frame::device;
use crate::host::Draw;
use crate::rays::{self, Triangle, first, model, placed, plain};

/// A ball of unequal radii, 24 triangles around and 10 upwards, outside out.
fn stone() -> Vec<[[f32; 3]; 3]> {
    let (around, upwards) = (12, 6);
    let corner = |column: usize, row: usize| {
        let column = column % around;
        let (turn, rise) = (column as f32 / around as f32 * TAU, row as f32 / upwards as f32 * PI);
        let is_pole = row == 0 || row == upwards;
        let radius = if is_pole { 1.0 } else { 1.0 + 0.1 * ((7 * column + 3 * row) % 5) as f32 };
        [radius * rise.sin() * turn.cos(), radius * rise.cos(), radius * rise.sin() * turn.sin()]
    };
    let cells = (0..upwards).flat_map(|row| (0..around).map(move |column| (column, row)));
    let triangles = cells.flat_map(|(x, y)| {
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)];
        [(y > 0).then_some([a, b, d]), (y + 1 < upwards).then_some([a, d, c])]
    });
    triangles.flatten().collect()
}

/// A relief on two triangles that are not in one plane.
fn folded() -> Relief {
    let map = BuiltInMap::Bricks;
    let mut relief = Relief::wall(2.0, map.height_map(64).expect("a map"), map.albedo(64).expect("colours"));
    relief.material.scale = 0.3;
    relief.mesh.vertices[3].position[2] += 0.6;
    relief
}

/// The corners of a relief's triangles.
fn flat(relief: &Relief) -> Vec<[[f32; 3]; 3]> {
    let triangles = relief.mesh.indices.as_chunks::<3>().0.iter();
    triangles.map(|corners| corners.map(|at| relief.mesh.vertices[at as usize].position)).collect()
}

/// The numbers of rays that hit each instance rightly, that rightly hit none, that are wrong, and for which rounding decides:
/// neighbours a hundred-thousandth beside them meet another triangle.
#[derive(Debug, Default)]
struct Rays {
    right: BTreeMap<usize, u32>,
    missed: u32,
    wrong: u32,
    unsure: u32,
}

/// Rays from around places towards these, against triangles whose tags are the numbers of instances.
fn shoot(scene: &Scene, instances: &[InstanceId], places: &[DVec3], triangles: &[Triangle]) -> Rays {
    let (mut draw, mut rays) = (Draw(11), Rays::default());
    for at in 0..1200 {
        let middle = places[at % places.len()];
        let (from, to) = (middle + 9.0 * draw.place(), middle + 1.7 * draw.place());
        let expected = first(triangles, [from, (to - from).normalize()]);
        let number = |hit: Option<rays::Hit>| hit.map(|hit| hit.triangle);
        let beside = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
        let mut beside = beside.map(|axis| first(triangles, [from, (to + 1e-5 * axis - from).normalize()]));
        if beside.any(|hit| number(hit) != number(expected)) {
            rays.unsure += 1;
            continue;
        }
        let found = scene.pick(&Ray::new(from, to - from)).expect("a ray");
        match (found, expected) {
            (None, None) => rays.missed += 1,
            (Some(found), Some(expected)) => {
                let Triangle { corners: [a, b, c], tag, .. } = triangles[expected.triangle];
                let outwards = (b - a).cross(c - a).normalize();
                let towards = (to - from).normalize();
                // Matrices of instances are rounded to 2^-24 of sizes below 8, in each of three products: 1.5e-6 units, which
                // are farther along a ray that grazes.
                let bound = 2e-6 / outwards.dot(towards).abs();
                let is_right = found.instance == instances[tag]
                    && found.world().distance(expected.position) <= bound
                    && found.normal.dot(outwards) > 1.0 - 1e-6;
                *(if is_right { rays.right.entry(tag).or_default() } else { &mut rays.wrong }) += 1;
            }
            _ => rays.wrong += 1,
        }
    }
    rays
}

/// Static meshes are hit on their triangles from the sides that are seen, and reliefs on those of their mesh.
#[test]
fn rays_hit_meshes_and_reliefs() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let (stone, folded) = (stone(), folded());
    let shell = || model(&stone, plain([1.0; 4], Alpha::Opaque), false);
    let single = scene.add_mesh(&shell(), 2).expect("added");
    // A bowl, whose inner side is seen too.
    let bowl = &stone[stone.len() / 2..];
    let double = scene.add_mesh(&model(bowl, plain([1.0; 4], Alpha::Opaque), true), 1).expect("added");
    let wall = scene.add_relief(&folded, 2).expect("added");
    let mirrored = Vec3::new(-1.0, 1.4, 0.8);
    let all = [
        (single, &stone[..], Placement::at([0.0, 0.0, 0.0]).turned(0.4)),
        (single, &stone, Placement { scale: mirrored, ..Placement::at([3.0, 0.5, 0.0]).turned(2.0) }),
        (double, bowl, Placement::at([0.0, -0.5, 4.0]).turned(1.0)),
        (wall, &flat(&folded), Placement::at([3.5, 0.0, 4.0]).turned(0.3).scaled(3.0)),
        (wall, &flat(&folded), Placement { scale: 2.0 * mirrored, ..Placement::at([-3.0, 0.0, 3.0]) }),
    ]
    .map(|(object, corners, placement)| (object, corners.to_vec(), placement));
    let instances: Vec<_> =
        all.iter().map(|(object, _, placement)| scene.spawn(*object, *placement).expect("room")).collect();
    let places: Vec<_> = all.iter().map(|(.., placement)| placement.world()).collect();
    let triangles = |moved: f64| -> Vec<Triangle> {
        let of_all = all.iter().enumerate().flat_map(|(tag, (object, corners, placement))| {
            placed(corners, placement, *object == double, move |_| tag)
        });
        let shift = |corner: DVec3| corner + moved * DVec3::new(0.6, 0.0, 0.8);
        of_all.map(|triangle| Triangle { corners: triangle.corners.map(shift), ..triangle }).collect()
    };
    let rays = shoot(&scene, &instances, &places, &triangles(0.0));
    println!("{rays:?}");
    assert!(rays.wrong == 0 && rays.unsure <= 12 && rays.missed > 30, "{rays:?}");
    assert!(rays.right.len() == 5 && rays.right.values().all(|hits| *hits >= 20), "{rays:?}");
    // A hundredth of a unit beside it, hardly a ray would be right.
    let beside = shoot(&scene, &instances, &places, &triangles(0.01));
    assert!(beside.right.values().sum::<u32>() == 0 && beside.wrong > 400, "{beside:?}");
}
