//! Where vertices, normals and tangents go.

use glam::{Mat4, Vec3};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::Palette;
use relievo::ops::skinning::palette::reference::{dual, palette, palette_for};
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::vertex::{Blend, Vertex};

use crate::shapes::{influences, matrices, model, models, rows};

fn close(a: [f32; 3], b: [f32; 3], bound: f32) -> bool {
    Vec3::from(a).distance(Vec3::from(b)) <= bound
}

fn vertex(position: Vec3, normal: Vec3, tangent: Vec3) -> Vertex {
    Vertex { position: position.into(), normal: normal.into(), tangent: tangent.extend(1.0).into() }
}

#[test]
fn at_rest_nothing_moves() {
    let model = model();
    let mesh = &model.meshes[0];
    let rest = relievo::ops::animation::local_to_model::reference::local_to_model(
        &model.skeleton,
        &model.skeleton.rest(),
    );
    let vertices = morph(mesh, &[]);
    for blend in [Blend::Linear, Blend::DualQuaternion] {
        let palette = palette_for(&model.skins[0], &rest, blend);
        for (old, new) in vertices.iter().zip(skin(&vertices, &mesh.influences, &palette, InstanceLod::FULL))
        {
            assert!(close(old.position, new.position, 1e-5) && close(old.normal, new.normal, 1e-5));
            assert!(old.tangent.iter().zip(new.tangent).all(|(a, b)| (a - b).abs() < 1e-5));
        }
    }
}

/// Compares positions with glTF's formula in double precision.
#[test]
fn a_walking_creature_is_where_gltf_puts_it() {
    let model = model();
    let (mesh, skin_of) = (&model.meshes[0], &model.skins[0]);
    for time in [0.0, 0.31, 0.77] {
        let models = models(&model, "walk", time);
        let found = skin(
            &morph(mesh, &[]),
            &mesh.influences,
            &Palette::Linear(palette(skin_of, &models)),
            InstanceLod::FULL,
        );
        for (at, found) in found.iter().enumerate() {
            let mut expected = [0.0_f64; 3];
            for influence in mesh.influences.of(at) {
                let bind = skin_of.inverse_binds[influence.bone as usize].map(f64::from);
                let bone =
                    models[skin_of.bones[influence.bone as usize] as usize].map(|row| row.map(f64::from));
                let p = mesh.positions[at].map(f64::from);
                let local: [f64; 3] = std::array::from_fn(|row| {
                    bind[row] * p[0] + bind[4 + row] * p[1] + bind[8 + row] * p[2] + bind[12 + row]
                });
                for axis in 0..3 {
                    let row = bone[axis];
                    let moved = row[0] * local[0] + row[1] * local[1] + row[2] * local[2] + row[3];
                    expected[axis] += f64::from(influence.weight) * moved;
                }
            }
            assert!(
                close(found.position, expected.map(|x| x as f32), 2e-6),
                "{found:?} instead of {expected:?}"
            );
        }
    }
}

/// A small triangle through the vertex is transformed corner by corner; its own normal and edges tell what is right.
#[test]
fn normals_and_tangents_stay_on_the_surface() {
    let one = influences(&[&[(0, 1.0)]]);
    for (case, matrix) in matrices().into_iter().enumerate() {
        let tangent = Vec3::new(1.0, 0.2 * case as f32, -0.4).normalize();
        let normal = tangent.cross(Vec3::new(0.1, 0.7, 1.0)).normalize();
        let bitangent = normal.cross(tangent);
        let palette = Palette::Linear(vec![rows(matrix)]);
        let found = skin(&[vertex(Vec3::ONE, normal, tangent)], &one, &palette, InstanceLod::FULL)[0];
        let [t, b] = [tangent, bitangent].map(|along| matrix.transform_vector3(along));
        // The face's normal points to the same side as the matrix's image of the vertex normal.
        let face = t.cross(b).normalize();
        let outward = if face.dot(matrix.transform_vector3(normal)) < 0.0 { -face } else { face };
        assert!(close(found.normal, outward.into(), 1e-5), "{case}: {:?} instead of {outward}", found.normal);
        let [x, y, z, handedness] = found.tangent;
        assert!(close([x, y, z], t.normalize().into(), 1e-5), "{case}");
        // The bitangent points to the same side as the surface's.
        let frame = Vec3::from(found.normal).cross(Vec3::new(x, y, z)) * handedness;
        assert!(frame.dot(b) > 0.0, "{case}: handedness");
    }
}

#[test]
fn one_bone_does_the_same_in_both_kinds_of_blending() {
    let one = influences(&[&[(0, 1.0)]]);
    for (case, matrix) in matrices().into_iter().enumerate() {
        let vertex = vertex(Vec3::new(0.3, -0.8, 1.1), Vec3::Y, Vec3::X);
        let affine = rows(matrix);
        let [linear, dual] = [Palette::Linear(vec![affine]), Palette::Dual(vec![dual(&affine)])]
            .map(|palette| skin(&[vertex], &one, &palette, InstanceLod::FULL)[0]);
        let size = matrix.to_cols_array().iter().fold(1.0, |a: f32, b| a.max(b.abs()));
        assert!(close(linear.position, dual.position, 2e-6 * size), "{case}: {linear:?} {dual:?}");
        assert!(close(linear.normal, dual.normal, 1e-5), "{case}: {linear:?} {dual:?}");
        assert!(linear.tangent.iter().zip(dual.tangent).all(|(a, b)| (a - b).abs() < 1e-5), "{case}");
    }
}

/// The limb is half way between a bone and the same bone rotated by almost half a turn about the limb.
#[test]
fn twisted_limbs_keep_their_volume_with_dual_quaternions() {
    let half = influences(&[&[(0, 0.5), (1, 0.5)]]);
    let twist = Mat4::from_axis_angle(Vec3::X, 3.0);
    let affines = vec![rows(Mat4::IDENTITY), rows(twist)];
    let vertex = vertex(Vec3::new(0.5, 1.0, 0.0), Vec3::Y, Vec3::X);
    let radius = |palette: &Palette| {
        let [_, y, z] = skin(&[vertex], &half, palette, InstanceLod::FULL)[0].position;
        y.hypot(z)
    };
    let thin = radius(&Palette::Linear(affines.clone()));
    assert!((thin - 1.5_f32.cos()).abs() < 1e-5, "{thin}");
    let round = radius(&Palette::Dual(affines.iter().map(dual).collect()));
    assert!((round - 1.0).abs() < 1e-5, "{round}");
}

#[test]
fn nothing_becomes_nan() {
    let both = influences(&[&[(0, 0.5), (1, 0.5)]]);
    let zero = Mat4::from_scale(Vec3::ZERO);
    let flat = Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let opposite = Mat4::from_scale(Vec3::NEG_ONE);
    let small = Mat4::from_scale(Vec3::splat(1e-18));
    for [a, b] in [[zero, zero], [flat, flat], [Mat4::IDENTITY, opposite], [small, small], [flat, zero]] {
        let affines = vec![rows(a), rows(b)];
        let dual = Palette::Dual(affines.iter().map(dual).collect());
        for palette in [Palette::Linear(affines), dual] {
            for normal in [Vec3::Y, Vec3::ZERO] {
                let found =
                    skin(&[vertex(Vec3::ONE, normal, Vec3::X)], &both, &palette, InstanceLod::FULL)[0];
                let all =
                    [found.position, found.normal, [found.tangent[0], found.tangent[1], found.tangent[2]]];
                assert!(all.as_flattened().iter().all(|value| value.is_finite()), "{found:?}");
            }
        }
    }
}

#[test]
fn targets_add_up_before_bones() {
    use relievo::asset::MorphTarget;
    use relievo::asset::morph::MorphDelta;
    let mut mesh = model().meshes.remove(0);
    let delta =
        |x: f32| MorphDelta { position: [x, 0.0, 0.0], normal: [0.0, x, 0.0], tangent: [0.0, 0.0, x] };
    mesh.targets = vec![
        MorphTarget { vertices: vec![1, 5], deltas: vec![delta(1.0), delta(2.0)] },
        MorphTarget { vertices: vec![5], deltas: vec![delta(10.0)] },
    ];
    let (before, after) = (morph(&mesh, &[0.0, 0.0]), morph(&mesh, &[0.5, -2.0]));
    for at in 0..mesh.vertices() {
        let moved = match at {
            1 => 0.5,
            5 => 1.0 - 20.0,
            _ => 0.0,
        };
        assert_eq!(after[at].position[0], before[at].position[0] + moved);
        assert!((after[at].normal[1] - before[at].normal[1] - moved).abs() < 1e-5);
        assert!((after[at].tangent[2] - before[at].tangent[2] - moved).abs() < 1e-5);
        assert_eq!(after[at].tangent[3], before[at].tangent[3]);
    }
}
