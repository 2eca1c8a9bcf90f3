//! Progressive meshes: levels are prefixes, patches apply and undo to the bit, and a level that has moved all the way is the
//! next coarser one.

mod stored;

use relievo::InputError;
use relievo::asset::morph::MorphDelta;
use relievo::asset::{Influence, Influences, Interpolation, Mesh, MorphTarget, WeightKeys};
use relievo::ops::mesh::progressive::ChosenLevel;
use relievo::ops::mesh::{ProgressiveMesh, Simplified, SimplifyOptions, simplify};

use crate::measure::distances;
use crate::shapes::{Shape, bumps, cube, ground, sphere, torus};

/// A shape as a mesh, each of whose attributes tells its vertices apart.
fn mesh(shape: &Shape, bones: u32) -> Mesh {
    let vertices = shape.uv.len();
    let weights = |vertex: usize| {
        let bone = (vertex as u32 / 3) % bones;
        let two = [Influence { bone, weight: 0.625 }, Influence { bone: bone + 1, weight: 0.375 }];
        if bones == 1 { vec![Influence { bone: 0, weight: 1.0 }] } else { two.to_vec() }
    };
    let delta = |vertex: usize| MorphDelta {
        position: if vertex.is_multiple_of(5) { [0.1, vertex as f32, 0.0] } else { [0.0; 3] },
        ..MorphDelta::default()
    };
    let unit = |vertex: usize| glam::Vec3::new(1.0, vertex as f32, 3.0).normalize();
    let keys = WeightKeys::new(["t", "v"], vec![0.0, 1.0], vec![0.0, 0.5], Interpolation::Linear, 1);
    Mesh {
        name: "shape".to_owned(),
        skin: 0,
        positions: shape.poses[0].clone(),
        normals: (0..vertices).map(|vertex| unit(vertex).to_array()).collect(),
        tangents: (0..vertices)
            .map(|vertex| unit(vertex).any_orthogonal_vector().extend(1.0).to_array())
            .collect(),
        uv: shape.uv.clone(),
        indices: shape.indices.clone(),
        double_sided: true,
        material: Some(3),
        influences: Influences::new("w", bones as usize + 1, (0..vertices).map(weights)).expect("valid"),
        targets: vec![MorphTarget::new(&(0..vertices).map(delta).collect::<Vec<_>>())],
        weights: vec![0.25],
        weight_keys: vec![(2, keys.expect("valid"))],
        ..Mesh::default()
    }
}

/// Levels of half as many triangles each, down to a handful.
fn halves(simplified: &Simplified, triangles: usize) -> Vec<ChosenLevel> {
    let mut chosen: Vec<ChosenLevel> = Vec::new();
    for halving in 1..16 {
        let collapses = simplified.collapses_to(triangles >> halving);
        let last = chosen.last().map_or(0, |last| last.collapses);
        if collapses > last && collapses < simplified.collapses().len() {
            chosen.push(ChosenLevel { collapses, error: simplified.collapses()[collapses - 1].error });
        }
    }
    chosen
}

/// The error, without a word of what was not refused.
fn error_of<T>(result: Result<T, InputError>) -> InputError {
    match result {
        Ok(_) => panic!("was not refused"),
        Err(error) => error,
    }
}

struct Case {
    name: &'static str,
    shape: Shape,
    mesh: Mesh,
    simplified: Simplified,
    chosen: Vec<ChosenLevel>,
    progressive: ProgressiveMesh,
}

fn cases() -> Vec<Case> {
    let shapes = [
        ("sphere", sphere(24, 16), 1),
        ("torus", torus(24, 16), 1),
        ("cube", cube(8), 3),
        ("ground", ground(24, bumps), 7),
    ];
    let case = |(name, shape, bones): (&'static str, Shape, u32)| {
        let mesh = mesh(&shape, bones);
        let simplified = simplify(&shape.with_uv(), &SimplifyOptions::default()).expect("valid");
        let chosen = halves(&simplified, shape.triangles());
        let progressive = ProgressiveMesh::new(&mesh, &simplified, &chosen).expect("valid");
        Case { name, shape, mesh, simplified, chosen, progressive }
    };
    shapes.into_iter().map(case).collect()
}

#[test]
fn a_level_is_a_prefix_and_the_triangles_of_the_record() {
    for Case { name, shape, mesh, simplified, chosen, progressive } in cases() {
        assert_eq!(progressive.levels(), chosen.len() + 1, "{name}");
        assert!(progressive.levels() > 4, "{name}: {}", progressive.levels());
        for level in 0..progressive.levels() {
            let own = level.checked_sub(1).map(|at| chosen[at]);
            let collapses = own.map_or(0, |chosen| chosen.collapses);
            let sources = progressive.indices(level).iter().map(|at| progressive.sources()[*at as usize]);
            let wanted = simplified.triangles(&shape.indices, collapses);
            assert!(sources.eq(wanted.iter().copied()), "{name}: level {level}");
            let most = progressive.indices(level).iter().max().map(|most| *most as usize + 1);
            assert_eq!(most, Some(progressive.vertices(level)), "{name}: level {level}");
            assert_eq!(progressive.error(level), own.map_or(0.0, |chosen| chosen.error));
        }
        let placed = progressive.mesh();
        for (at, source) in progressive.sources().iter().map(|source| *source as usize).enumerate() {
            let same = placed.positions[at] == mesh.positions[source]
                && placed.normals[at] == mesh.normals[source]
                && placed.tangents[at] == mesh.tangents[source]
                && placed.uv[at] == mesh.uv[source]
                && placed.influences.of(at) == mesh.influences.of(source);
            assert!(same, "{name}: vertex {at}");
        }
        let moved = placed.targets[0].vertices.iter().map(|at| progressive.sources()[*at as usize]);
        let (mut moved, target): (Vec<u32>, _) = (moved.collect(), &mesh.targets[0]);
        moved.sort_unstable();
        assert!(moved == target.vertices, "{name}");
        let y = |at: usize| progressive.sources()[placed.targets[0].vertices[at] as usize] as f32;
        assert!(placed.targets[0].deltas.iter().enumerate().all(|(at, delta)| delta.position[1] == y(at)));
    }
}

/// Within a level, vertices follow few bones, or come in the order of their collapses.
#[test]
fn vertices_are_sorted_by_bones_or_by_time() {
    for Case { name, simplified, chosen, progressive, mesh, .. } in cases() {
        let mut times = vec![usize::MAX; mesh.vertices()];
        for collapse in 0..simplified.collapses().len() {
            simplified.moved(collapse).iter().for_each(|[from, _]| times[*from as usize] = collapse);
        }
        let first_bone = |at: u32| progressive.mesh().influences.of(at as usize)[0].bone;
        let is_skinned = mesh.influences.most() > 1;
        for level in 0..chosen.len() {
            let run = progressive.patch(level).vertices();
            let pairs = run.clone().zip(run.skip(1));
            let sorted = pairs.into_iter().all(|(a, b)| match is_skinned {
                true => first_bone(a) <= first_bone(b),
                false => {
                    times[progressive.sources()[a as usize] as usize]
                        >= times[progressive.sources()[b as usize] as usize]
                }
            });
            assert!(sorted, "{name}: level {level}");
        }
    }
}

#[test]
fn patches_apply_and_undo_to_the_bit() {
    for Case { name, progressive, .. } in cases() {
        let coarsest = progressive.levels() - 1;
        let mut triangles = progressive.indices(coarsest).to_vec();
        let mut held = progressive.vertices(coarsest) as u32;
        for level in (0..coarsest).rev() {
            progressive.refine(level, &mut triangles).expect("fits");
            let run = progressive.patch(level).vertices();
            assert_eq!(run.start, held, "{name}");
            held = run.end;
            assert!(triangles == progressive.indices(level), "{name}: level {level}");
        }
        assert_eq!(held as usize, progressive.mesh().vertices());
        for level in 0..coarsest {
            progressive.coarsen(level, &mut triangles).expect("fits");
            assert!(triangles == progressive.indices(level + 1), "{name}: level {level}");
        }
        // Another level's triangles are refused, and stay.
        let before = triangles.clone();
        for level in 0..coarsest {
            assert!(progressive.coarsen(level, &mut triangles).is_err(), "{name}: {level}");
        }
        assert!(progressive.refine(0, &mut triangles).is_err());
        assert_eq!(error_of(progressive.refine(coarsest, &mut triangles)).path, "level");
        assert!(triangles == before);
    }
}

#[test]
fn a_level_that_has_moved_is_the_next_coarser_one() {
    for Case { name, progressive, .. } in cases() {
        let mesh = progressive.mesh();
        for level in 0..progressive.levels() - 1 {
            let partners = progressive.partners(level);
            let moved: Vec<u32> =
                progressive.indices(level).iter().map(|vertex| partners[*vertex as usize]).collect();
            let place = |vertex: u32| mesh.positions[vertex as usize].map(|x| (x + 0.0).to_bits());
            let has_area = |triangle: &&[u32]| {
                let [a, b, c] = [0, 1, 2].map(|corner| place(triangle[corner]));
                a != b && b != c && c != a
            };
            let left: Vec<u32> = moved.chunks(3).filter(has_area).flatten().copied().collect();
            assert!(left == progressive.indices(level + 1), "{name}: level {level}");
            // Attributes at the corners of what is left.
            let positions = progressive.morphed(level, 1.0, &mesh.positions).expect("valid");
            let normals = progressive.morphed(level, 1.0, &mesh.normals).expect("valid");
            let uv = progressive.morphed(level, 1.0, &mesh.uv).expect("valid");
            let partners = progressive.partners(level);
            let kept = progressive.indices(level).chunks(3).zip(moved.chunks(3));
            let kept = kept.filter(|(_, moved)| has_area(moved)).flat_map(|(fine, _)| fine);
            for (fine, coarse) in kept.zip(progressive.indices(level + 1)) {
                let (fine, coarse) = (*fine as usize, *coarse as usize);
                let same = positions[fine] == mesh.positions[coarse]
                    && normals[fine] == mesh.normals[coarse]
                    && uv[fine] == mesh.uv[coarse]
                    && mesh.influences.of(partners[fine] as usize) == mesh.influences.of(coarse);
                assert!(same, "{name}: level {level}, vertex {fine}");
            }
            let still = progressive.morphed(level, 0.0, &mesh.positions).expect("valid");
            assert!(still == mesh.positions[..progressive.vertices(level)], "{name}: level {level}");
            let half = progressive.morphed(level, 0.5, &mesh.positions).expect("valid");
            let between = half.iter().zip(&still).zip(&positions);
            let middle = |a: &[f32; 3], b: &[f32; 3]| [0, 1, 2].map(|at| a[at] * 0.5 + b[at] * 0.5);
            assert!(between.into_iter().all(|((half, a), b)| *half == middle(a, b)));
        }
        assert_eq!(error_of(progressive.morphed(0, 1.5, &mesh.positions)).path, "t");
        assert_eq!(error_of(progressive.morphed(0, 0.5, &mesh.uv[1..])).path, "values.len");
    }
}

/// The largest distance of the mesh's vertices from a level on its way to the next one.
fn off(progressive: &ProgressiveMesh, level: usize, t: f32) -> f64 {
    let mesh = progressive.mesh();
    let mut places = mesh.positions.clone();
    let first = places.len() as u32;
    places.extend(progressive.morphed(level, t, &mesh.positions).expect("valid"));
    let indices: Vec<u32> = progressive.indices(level).iter().map(|vertex| first + vertex).collect();
    distances(&crate::shapes::bare(places, Vec::new()), 0, &indices)[1]
}

/// On its way a level is hardly further off than the worse of its ends.
#[test]
fn between_two_levels_it_is_hardly_further_off() {
    let mut worst = 0.0_f64;
    for Case { name, progressive, .. } in cases() {
        for level in 0..progressive.levels() - 1 {
            let ends = off(&progressive, level, 0.0).max(off(&progressive, level, 1.0));
            for t in [0.25, 0.5, 0.75] {
                let between = off(&progressive, level, t);
                // Rounding alone puts a flat cube off.
                let ratio = if ends > 1e-6 { between / ends } else { between };
                assert!(ratio <= 1.1, "{name}: level {level} at {t}: {between} of {ends}");
                worst = worst.max(ratio);
            }
        }
    }
    assert!(worst > 0.5, "it was measured: {worst}");
}

/// A partner that is not the one of the record, and a level that lacks a triangle of the one before, are found.
#[test]
fn levels_and_partners_must_belong_together() {
    for Case { name, progressive, .. } in cases() {
        let whole = progressive.mesh();
        let again = ProgressiveMesh::of_levels(whole).expect("valid");
        let same = (0..progressive.levels())
            .all(|level| again.indices(level).len() == progressive.indices(level).len());
        assert!(same, "{name}");
        let mut torn = whole.clone();
        torn.levels[1].indices.swap(0, 1);
        assert_eq!(error_of(ProgressiveMesh::of_levels(&torn)).path, "mesh.levels[1].indices", "{name}");
        let mut astray = whole.clone();
        // A corner that changes.
        let [_, vertex] = progressive.patch(0).corners()[0];
        let other =
            (0..progressive.vertices(1) as u32).find(|other| *other != whole.partners[vertex as usize]);
        astray.partners[vertex as usize] = other.expect("there");
        assert_eq!(error_of(ProgressiveMesh::of_levels(&astray)).path, "mesh.levels[0].indices", "{name}");
        let mut circle = whole.clone();
        let pair = [vertex, vertex - 1];
        circle.partners[pair[0] as usize] = pair[1];
        circle.partners[pair[1] as usize] = pair[0];
        let error = error_of(ProgressiveMesh::of_levels(&circle));
        assert!(error.path.starts_with("mesh.partners["), "{name}: {error}");
        let bare = Mesh { partners: Vec::new(), ..whole.clone() };
        assert_eq!(error_of(ProgressiveMesh::of_levels(&bare)).path, "mesh.partners.len", "{name}");
    }
}

#[test]
fn chosen_levels_are_checked() {
    let Case { mesh, simplified, chosen, .. } = cases().remove(0);
    let refused =
        |mesh: &Mesh, chosen: &[ChosenLevel]| error_of(ProgressiveMesh::new(mesh, &simplified, chosen)).path;
    let none = ChosenLevel { collapses: 0, error: 0.0 };
    assert_eq!(refused(&mesh, &[none]), "chosen[0].collapses");
    assert_eq!(refused(&mesh, &[chosen[1], chosen[0]]), "chosen[1].collapses");
    let far = ChosenLevel { collapses: simplified.collapses().len() + 1, ..none };
    assert_eq!(refused(&mesh, &[chosen[0], far]), "chosen[1].collapses");
    assert_eq!(refused(&mesh, &[none; 16]), "chosen.len");
    let falling = [ChosenLevel { error: 1.0, ..chosen[0] }, ChosenLevel { error: 0.5, ..chosen[1] }];
    assert_eq!(refused(&mesh, &falling), "mesh.levels[1].error");
    assert_eq!(refused(&mesh, &[ChosenLevel { error: f32::NAN, ..chosen[0] }]), "mesh.levels[0].error");
    let mut other = mesh.clone();
    other.indices.truncate(300);
    assert_eq!(refused(&other, &chosen[..1]), "chosen[0].triangles");
    let other = self::mesh(&torus(20, 16), 1);
    assert_eq!(refused(&other, &chosen), "mesh.positions.len");
    let alone = ProgressiveMesh::new(&mesh, &simplified, &[]).expect("valid");
    assert_eq!((alone.levels(), alone.vertices(0)), (1, mesh.vertices()));
}
