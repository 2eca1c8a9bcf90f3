//! The concatenation reference against 4×4 products in double precision.

use relievo::asset::transform::{AFFINE_IDENTITY, column_major};
use relievo::asset::{Bone, Skeleton, Transform};
use relievo::ops::animation::local_to_model::reference::{affine, local_to_model, local_to_model_into};

use crate::player::{Matrix, matrix, product, unit, wide};
use crate::sampling::{noise, skeleton};

#[test]
fn chains_of_every_length_are_products() {
    for bones in [1, 2, 153, 1000] {
        let skeleton = skeleton(bones);
        let words = noise(7, 10 * bones);
        let locals: Vec<Transform> = (words.chunks_exact(10))
            .map(|w| {
                let rotation = unit(wide([w[3], w[4], w[5], w[6] + 1.5])).map(|x| x as f32);
                let scale = [1.0 + 0.2 * w[7], 1.0 + 0.2 * w[8], if w[9] > 0.9 { -1.0 } else { 1.0 }];
                Transform { translation: [w[0], w[1], w[2]], rotation, scale }
            })
            .collect();
        let found = local_to_model(&skeleton, &locals);
        let mut expected: Vec<Matrix> = Vec::new();
        for (bone, local) in skeleton.bones().iter().zip(&locals) {
            let local = matrix(wide(local.translation), wide(local.rotation), wide(local.scale));
            expected.push(bone.parent.map_or(local, |parent| product(&expected[parent as usize], &local)));
        }
        for (found, expected) in found.iter().zip(&expected) {
            let largest = expected.iter().flatten().fold(1.0, |a: f64, b| a.max(b.abs()));
            let flat = column_major(found);
            for (row, column) in (0..4).flat_map(|row| (0..4).map(move |column| (row, column))) {
                let error = (f64::from(flat[4 * column + row]) - expected[row][column]).abs();
                assert!(error <= 3e-6 * largest, "{bones} bones: {error:e} of {largest}");
            }
        }
    }
}

#[test]
fn a_bone_scales_then_turns_then_moves() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    // A quarter turn about z.
    let transform = Transform {
        translation: [10.0, 20.0, 30.0],
        rotation: [0.0, 0.0, half, half],
        scale: [2.0, 3.0, 4.0],
    };
    let found = affine(&transform);
    let expected = [[0.0, -3.0, 0.0, 10.0], [2.0, 0.0, 0.0, 20.0], [0.0, 0.0, 4.0, 30.0]];
    let error = found.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs());
    assert!(error.fold(0.0, f32::max) < 1e-6, "{found:?}");
    assert_eq!(affine(&Transform::IDENTITY), AFFINE_IDENTITY);
}

#[test]
fn the_parents_scale_reaches_the_child() {
    let bone = |parent| Bone { name: String::new(), parent, rest: Transform::IDENTITY };
    let skeleton = Skeleton::of_joints(vec![bone(None), bone(Some(0))]).expect("valid");
    let parent = Transform { scale: [2.0, 2.0, -2.0], ..Transform::IDENTITY };
    let models = local_to_model(&skeleton, &[parent, Transform::from_translation([1.0, 2.0, 3.0])]);
    assert_eq!(models[1].map(|row| row[3]), [2.0, 4.0, -6.0]);
}

#[test]
fn crowds_are_concatenated_instance_by_instance() {
    let skeleton = skeleton(5);
    let words = noise(8, 3 * 5 * 4);
    let locals: Vec<Transform> = words
        .chunks_exact(3)
        .map(|w| Transform { translation: [w[0], w[1], w[2]], ..Transform::IDENTITY })
        .collect();
    let mut models = vec![AFFINE_IDENTITY; 20];
    local_to_model_into(&skeleton, &locals, &mut models);
    let expected: Vec<_> = locals.chunks(5).flat_map(|locals| local_to_model(&skeleton, locals)).collect();
    assert_eq!(models, expected);
    assert_ne!(models[..5], models[5..10]);
}
