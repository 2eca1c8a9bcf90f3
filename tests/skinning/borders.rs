//! Meshes of one model that share a border: what is closed across them is closed at every level. Their nodes have other
//! units, and one is mirrored, so that the border's positions are equal but for rounding.

use std::collections::{BTreeSet, HashMap};

use relievo::ops::mesh::ProgressiveMesh;
use relievo::ops::skinning::clusters::Clusters;
use relievo::ops::skinning::merged::merged;
use relievo::ops::skinning::{MeshLevels, add_levels, level_errors, own_levels};

use crate::hull::{Hull, halves, hull};

/// Of the triangles of all parts at a level, the edges that have no opposite.
fn gaps(Hull { model, points }: &Hull, level: u32) -> usize {
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    for (mesh, points) in model.meshes.iter().zip(points) {
        for corners in mesh.triangles(level).chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|at| points[corners[at] as usize]);
            for [from, to] in [[a, b], [b, c], [c, a]].into_iter().filter(|[from, to]| from != to) {
                *edges.entry([from, to]).or_default() += 1;
                *edges.entry([to, from]).or_default() -= 1;
            }
        }
    }
    edges.values().filter(|sum| **sum != 0).count()
}

/// The points of a part at a level that another part has at full detail.
fn border(Hull { model, points }: &Hull, part: usize, other: usize, level: u32) -> BTreeSet<u32> {
    let of = |part: usize, level: u32| -> BTreeSet<u32> {
        model.meshes[part].triangles(level).iter().map(|at| points[part][*at as usize]).collect()
    };
    of(part, level).intersection(&of(other, 0)).copied().collect()
}

#[test]
fn a_hull_of_two_parts_has_no_gap_at_any_level() {
    let mut hull = halves();
    assert_eq!((hull.model.meshes.len(), gaps(&hull, 0)), (2, 0));
    let alone: Vec<MeshLevels> =
        (0..2).map(|mesh| MeshLevels::new(&hull.model, mesh, &[0], 5).expect("valid")).collect();
    let found = add_levels(&mut hull.model, &[0], 5).expect("valid");
    let levels = found[0].levels.len() as u32;
    assert!(levels >= 8, "{levels}");
    let errors =
        |mesh: usize| hull.model.meshes[mesh].levels.iter().map(|level| level.error).collect::<Vec<_>>();
    assert_eq!(errors(0), errors(1));
    for level in 1..=levels {
        assert_eq!(gaps(&hull, level), 0, "level {level}");
        let borders = [border(&hull, 0, 1, level), border(&hull, 1, 0, level)];
        assert!(
            borders[0] == borders[1],
            "level {level}: {} and {} points",
            borders[0].len(),
            borders[1].len()
        );
    }
    let triangles =
        |level: u32| hull.model.meshes.iter().map(|mesh| mesh.triangles(level).len()).sum::<usize>();
    assert!(triangles(levels) < triangles(0) / 20, "{} of {}", triangles(levels), triangles(0));
    let borders = [0, levels].map(|level| border(&hull, 0, 1, level).len());
    assert!(borders[1] < borders[0] / 2, "the border is simplified too: {borders:?}");
    // Parts that are simplified alone do part.
    for (mesh, alone) in hull.model.meshes.iter_mut().zip(&alone) {
        mesh.levels.clone_from(&alone.levels);
    }
    let most = alone.iter().map(|alone| alone.levels.len()).min().expect("two") as u32;
    assert!((1..=most).any(|level| gaps(&hull, level) > 0));
}

/// A part that is a single triangle, and a part that is a stripe: both stay, and the hull stays closed.
#[test]
fn narrow_parts_leave_no_gap() {
    let first = {
        let rock = relievo_samples::rock().expect("valid").meshes.remove(0);
        let [a, b, c] =
            [0, 1, 2].map(|at| glam::Vec3::from(rock.positions[rock.indices[3000 + at] as usize]));
        (a + b + c) / 3.0
    };
    let mut hull =
        hull(|middle| if middle == first { 1 } else { 2 * usize::from(middle.y > 0.6 && middle.y < 0.64) });
    assert_eq!((hull.model.meshes.len(), gaps(&hull, 0)), (3, 0));
    add_levels(&mut hull.model, &[0], 2).expect("valid");
    for mesh in &hull.model.meshes {
        assert_eq!(mesh.validate(&hull.model.skins), Ok(()));
    }
    let levels = hull.model.meshes[0].levels.len() as u32;
    assert!(levels >= 8, "{levels}");
    assert!((1..=levels).all(|level| gaps(&hull, level) == 0));
    // What remains of the triangle still has an area.
    let last = hull.model.meshes[1].triangles(levels);
    assert!(last.len() == 3 && last[0] != last[1] && last[1] != last[2], "{last:?}");
    // Levels go into each other all the same.
    for mesh in &hull.model.meshes {
        ProgressiveMesh::of_levels(mesh).expect("valid");
    }
}

/// A narrow stripe belongs to the same mesh as a far cap. If the stripe vanished between its neighbours, its vertices would be as
/// far from their mesh as the cap is.
#[test]
fn a_stripe_stays_where_the_rest_of_its_mesh_is_far() {
    let errors = |part: fn(f32) -> usize| {
        let mut hull = hull(|middle| part(middle.y));
        add_levels(&mut hull.model, &[0], 2).expect("valid");
        let levels = &hull.model.meshes[0].levels;
        levels.iter().map(|level| level.error).collect::<Vec<f32>>()
    };
    let plain = errors(|_| 0);
    let striped = errors(|y| usize::from(y < 0.1 || y > 0.6 && y < 0.64));
    for (striped, plain) in striped.iter().zip(&plain).take(5) {
        assert!(*striped < 1.5 * plain, "{striped} and {plain}");
    }
}

/// An object draws the same level of both parts, and the merged mesh keeps partners.
#[test]
fn an_object_draws_levels_that_belong_together() {
    let mut hull = halves();
    add_levels(&mut hull.model, &[0], 5).expect("valid");
    let errors = level_errors(&hull.model.meshes);
    let own = [0, 1].map(|mesh| own_levels(&hull.model.meshes[mesh], &errors));
    assert_eq!(own[0], own[1]);
    for most in [3, 8] {
        let merged = merged(&hull.model, most).expect("valid");
        assert_eq!((merged.model.meshes.len(), merged.levels()), (1, most));
        let mesh = &merged.model.meshes[0];
        assert_eq!(mesh.partners.len(), mesh.vertices());
        let progressive = ProgressiveMesh::of_levels(mesh).expect("the partners of the levels that are left");
        assert_eq!(progressive.levels(), most);
    }
}

/// A closed copy at the same place is another surface, which is simplified by itself.
#[test]
fn copies_of_a_surface_are_not_joined() {
    let mut single = hull(|_| 0);
    let mut twice = hull(|_| 0);
    let copy = twice.model.meshes[0].clone();
    twice.model.meshes.push(copy);
    let alone = add_levels(&mut single.model, &[], 1).expect("valid");
    let both = add_levels(&mut twice.model, &[], 1).expect("valid");
    assert!(both.iter().all(|found| found.levels == alone[0].levels && found.partners == alone[0].partners));
}

/// The levels of a skinned mesh as a progressive mesh, whose order is that of clusters already.
#[test]
fn levels_of_a_skinned_mesh_are_progressive() {
    let mut model = relievo_samples::creature().expect("valid");
    add_levels(&mut model, &[0], 5).expect("valid");
    let progressive = ProgressiveMesh::of_levels(&model.meshes[0]).expect("valid");
    assert!(progressive.levels() > 8, "{}", progressive.levels());
    let clusters = Clusters::new(progressive.mesh(), &model.skins, &model.skeleton).expect("fits");
    assert!(clusters.order.iter().copied().eq(0..progressive.mesh().vertices() as u32));
    for level in 0..progressive.levels() - 1 {
        assert_eq!(clusters.level(level as u32).vertices as usize, progressive.vertices(level));
        // Every corner of what is left has the position, normal, texture coordinate and influences of the coarser level.
        let positions = &progressive.mesh().positions;
        let place = |at: u32| positions[at as usize].map(|x| (x + 0.0).to_bits());
        let partners = progressive.partners(level);
        let moved: Vec<u32> =
            progressive.indices(level).iter().map(|vertex| partners[*vertex as usize]).collect();
        let has_area = |corners: &&[u32]| {
            let [a, b, c] = [0, 1, 2].map(|at| place(corners[at]));
            a != b && b != c && c != a
        };
        let left = moved.chunks(3).filter(has_area).flatten().copied();
        assert!(left.eq(progressive.indices(level + 1).iter().copied()), "level {level}");
    }
}
