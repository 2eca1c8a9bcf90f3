//! Levels of detail of a character with two meshes: each is as coarse as permitted, and the drawn surface keeps
//! to the error in pixels.

use std::ops::ControlFlow;

use glam::{Vec3, Vec4};
use relievo::asset::{Affine, Influence, Influences, Model};
use relievo::ops::animation::Projection;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::Palette;
use relievo::ops::skinning::palette::reference::palette;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::{
    Extent, InstanceLod, MeshLevels, add_levels, add_levels_with_progress, level_errors, own_levels, poses_of,
};

use crate::shapes::{model, models};

/// The error of the fade in pixels, and that of the levels.
const PIXELS: f32 = 0.25;

/// The creature, with 2,000 triangles, inside a shell of 300 triangles that is full of bumps.
fn two() -> (Model, Vec<MeshLevels>) {
    let mut model = model();
    add_levels(&mut model, &[0], 2).expect("valid");
    let levels = std::mem::take(&mut model.meshes[0].levels);
    let of = |most: usize| {
        let found = levels.iter().find(|level| level.indices.len() < 3 * most);
        found.expect("there").indices.clone()
    };
    let mut shell = model.meshes[0].clone();
    shell.indices = of(300);
    for position in &mut shell.positions {
        let [x, y, z] = *position;
        let bump = 0.05 * libm::sinf(91.0 * x + 57.0 * y + 71.0 * z);
        *position = [x + bump, y, z - bump];
    }
    model.meshes[0].indices = of(2200);
    model.meshes.push(shell);
    let poses = poses_of(&model.clips[0]).expect("short");
    let found = add_levels(&mut model, &[0], poses).expect("valid");
    (model, found)
}

#[test]
fn each_mesh_changes_where_its_own_error_allows() {
    let (model, found) = two();
    let errors = level_errors(&model.meshes);
    let own = [0, 1].map(|mesh| own_levels(&model.meshes[mesh], &errors));
    let first = |mesh: usize| own[mesh].iter().position(|level| *level > 0).expect("has levels");
    // While the other mesh is at level 0, the fine one has less than a third of its triangles.
    let alone = own[0][first(1) - 1];
    assert!(alone >= 3, "{own:?}");
    let left = model.meshes[0].triangles(alone).len();
    assert!(3 * left < model.meshes[0].indices.len(), "{left}");

    let extent = Extent::of_model(&model, &[0], poses_of(&model.clips[0]).expect("short")).expect("valid");
    let projection = Projection::new(1080, 1.0, 0.1);
    let begins = extent.level_ranges(&projection, PIXELS, errors.iter().copied());
    let screen = |place: Vec3| place.truncate() / place.z * projection.focal_pixels;
    let fade_range = extent.fade_range(&projection, PIXELS);
    let mut largest = 0.0_f32;
    for (at, begin) in begins.iter().enumerate() {
        // The view is straight ahead or to a side, just beyond the distance at which the level begins, where
        // its error is most visible.
        let side = [Vec3::NEG_Z, Vec3::new(0.3, -0.35, -1.0).normalize()][at % 2];
        let projected_distance = 1.0001 * begin / (side.z * side.z);
        let turn = 2.4 * at as f32;
        let turned = placed(Vec3::ZERO, turn);
        let middle = Vec3::from(turned.map(|row| Vec3::from_slice(&row).dot(extent.center)));
        let placement = placed(projected_distance * side - middle, turn);
        let mesh_lod = begins.iter().take_while(|begins| 1.0001 * begin >= **begins).count() as u32;
        let fade = InstanceLod::at_distance(1.0001 * begin, fade_range).expect("a distance");
        let instance_lod = InstanceLod { mesh_lod, ..fade };
        let time = model.clips[0].duration() * (0.618 * at as f32).fract();
        for (mesh, (own, found)) in model.meshes.iter().zip(own.iter().zip(&found)) {
            let bones = Palette::Linear(palette(&model.skins[0], &models(&model, "walk", time)));
            let placed = |instance_lod: InstanceLod| -> Vec<Vec3> {
                let vertices = skin(&morph(mesh, &[]), &mesh.influences, &bones, instance_lod);
                let place = |position: [f32; 3]| {
                    let position = Vec3::from(position).extend(1.0);
                    Vec3::from(placement.map(|row| Vec4::from(row).dot(position)))
                };
                vertices.iter().map(|vertex| place(vertex.position)).collect()
            };
            let (full, drawn) = (placed(InstanceLod::FULL), placed(instance_lod));
            let Some(level) = (own[instance_lod.mesh_lod as usize] as usize).checked_sub(1) else { continue };
            for (vertex, wanted) in full.into_iter().enumerate() {
                let nearest = found.nearest(level, vertex, wanted, |vertex| drawn[vertex as usize]);
                let off = screen(nearest).distance(screen(wanted));
                // Positions are rounded: they are hundreds of pixels, and metres far away.
                assert!(off <= 2.0 * PIXELS + 2e-3, "{off} pixels at {begin}: level {level}");
                largest = largest.max(off);
            }
        }
    }
    assert!(largest > 0.5 * PIXELS, "far too careful: {largest} pixels");
}

/// A placement: rotated about +Y by `turn` radians, then translated.
fn placed(at: Vec3, turn: f32) -> Affine {
    let (sine, cosine) = (libm::sinf(turn), libm::cosf(turn));
    [[cosine, 0.0, sine, at.x], [0.0, 1.0, 0.0, at.y], [-sine, 0.0, cosine, at.z]]
}

/// The fractions ascend from 0 to 1, and a program that cancels keeps its model.
#[test]
fn progress_is_told_and_can_end_the_work() {
    let plain = relievo_samples::creature().expect("valid");
    let mut model = plain.clone();
    let mut told = Vec::new();
    let found = add_levels_with_progress(&mut model, &[0], 24, &mut |fraction| {
        told.push(fraction);
        ControlFlow::Continue(())
    });
    assert!(found.expect("valid").is_some());
    assert!(told.len() > 9 && told[0] == 0.0 && told[told.len() - 1] == 1.0, "{told:?}");
    assert!(told.windows(2).all(|pair| pair[0] <= pair[1] && pair[1] - pair[0] < 0.35), "{told:?}");
    let mut silent = plain.clone();
    add_levels(&mut silent, &[0], 24).expect("valid");
    assert!(model == silent && !model.meshes[0].levels.is_empty());
    for most in [0.0, 0.3, 0.8] {
        let mut model = plain.clone();
        let mut last = 0.0;
        let found = add_levels_with_progress(&mut model, &[0], 24, &mut |fraction| {
            last = fraction;
            if fraction >= most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(found.expect("valid").is_none() && model == plain, "{most}");
        assert!(last < most + 0.35, "{last} of {most}");
    }
}

/// Where vertices follow one bone each, twenty times as many poses are hardly more work.
#[cfg(unix)]
#[test]
fn poses_of_rigid_parts_cost_little() {
    let mut model = relievo_samples::creature().expect("valid");
    let mesh = &mut model.meshes[0];
    let strongest = (0..mesh.vertices()).map(|vertex| {
        let bone = mesh.influences.of(vertex)[0].bone;
        vec![Influence { bone, weight: 1.0 }]
    });
    mesh.influences = Influences::new("w", model.skins[0].bones.len(), strongest).expect("valid");
    let seconds = |poses: usize| {
        let clock = || {
            let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
            time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        let mut model = model.clone();
        pool.install(|| {
            let before = clock();
            add_levels(&mut model, &[0], poses).expect("valid");
            clock() - before
        })
    };
    let [few, many] = [24, 480].map(seconds);
    assert!(many < 2.0 * few, "{few} s, {many} s");
}

/// A small piece of a mesh, far from the rest of it, stays at every level and within the level's error: another mesh around it
/// does not stand for it.
#[test]
fn a_piece_stays_within_the_error_of_its_own_mesh() {
    let mut model = model();
    model.meshes[0].levels.clear();
    // The other mesh has two pieces: some triangles at the top, and many at one side.
    let whole = model.meshes[0].clone();
    let mut triangles: Vec<[u32; 3]> = whole.indices.as_chunks::<3>().0.to_vec();
    let middle = |triangle: &[u32; 3], axis: usize| -> f32 {
        triangle.iter().map(|vertex| whole.positions[*vertex as usize][axis]).sum()
    };
    triangles.sort_by(|a, b| middle(b, 1).total_cmp(&middle(a, 1)));
    let top: Vec<[u32; 3]> = triangles.drain(..40).collect();
    triangles.sort_by(|a, b| middle(a, 0).total_cmp(&middle(b, 0)));
    let side: Vec<[u32; 3]> = triangles.drain(..900).collect();
    let flat = |all: &[&[[u32; 3]]]| all.iter().flat_map(|part| part.as_flattened()).copied().collect();
    let mut pieces = whole.clone();
    pieces.indices = flat(&[&top, &side]);
    model.meshes[0].indices = flat(&[&triangles]);
    model.meshes.push(pieces);
    let poses = 9;
    add_levels(&mut model, &[0], poses).expect("valid");
    let mesh = &model.meshes[1];
    let used: Vec<u32> = top.as_flattened().to_vec();
    assert!(mesh.levels.len() > 8, "{} levels", mesh.levels.len());
    for level in &mesh.levels {
        let is_left = used.iter().any(|vertex| level.indices.contains(vertex));
        assert!(is_left, "a level without the piece");
        let mut largest = 0.0_f32;
        for at in 0..poses {
            let time = model.clips[0].duration() * at as f32 / (poses - 1) as f32;
            let bones = Palette::Linear(palette(&model.skins[mesh.skin], &models(&model, "walk", time)));
            let vertices = skin(&morph(mesh, &[]), &mesh.influences, &bones, InstanceLod::FULL);
            let place = |vertex: &u32| Vec3::from(vertices[*vertex as usize].position);
            let drawn: Vec<[Vec3; 3]> = level
                .indices
                .as_chunks::<3>()
                .0
                .iter()
                .map(|corners| corners.each_ref().map(place))
                .collect();
            for wanted in used.iter().map(place) {
                let off = drawn.iter().map(|corners| distance_to_triangle(wanted, *corners));
                largest = largest.max(off.fold(f32::INFINITY, f32::min));
            }
        }
        assert!(largest <= 1.001 * level.error + 1e-5, "{largest} is more than {}", level.error);
    }
}

/// The distance of a point from a triangle.
fn distance_to_triangle(point: Vec3, [a, b, c]: [Vec3; 3]) -> f32 {
    let on_edge = |from: Vec3, to: Vec3| {
        let along = to - from;
        let part = (point - from).dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
        point.distance(from + part.clamp(0.0, 1.0) * along)
    };
    let normal = (b - a).cross(c - a);
    let is_inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(from, to)| (*to - *from).cross(point - *from).dot(normal) >= 0.0);
    let edges = on_edge(a, b).min(on_edge(b, c)).min(on_edge(c, a));
    match is_inside && normal != Vec3::ZERO {
        true => ((point - a).dot(normal) / normal.length()).abs(),
        false => edges,
    }
}
