//! The bounds' reference against the exact box in double precision.

use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::AFFINE_IDENTITY;
use relievo::asset::{Affine, Bone, Skeleton, Transform};
use relievo::ops::animation::MotionBounds;
use relievo::ops::animation::bounds::bone_radii;
use relievo::ops::animation::bounds::reference::bounds;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use relievo_samples::creature;

use crate::player::unit;
use crate::sampling::noise;

/// Where a matrix puts a point.
fn moved(model: &Affine, point: [f64; 3]) -> [f64; 3] {
    model.map(|[x, y, z, w]| {
        f64::from(x) * point[0] + f64::from(y) * point[1] + f64::from(z) * point[2] + f64::from(w)
    })
}

fn contains(found: &MotionBounds, point: [f64; 3]) -> bool {
    (0..3).all(|i| (f64::from(found.low[i])..=f64::from(found.high[i])).contains(&point[i]))
}

/// Directions, the axes among them.
fn directions() -> Vec<[f64; 3]> {
    let axes = (0..6)
        .map(|i| std::array::from_fn(|axis| if axis == i / 2 { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 }));
    let random = noise(41, 3 * 500);
    let random = random.chunks_exact(3).map(|w| {
        let [x, y, z, _] = unit([w[0].into(), w[1].into(), w[2].into(), 0.0]);
        [x, y, z]
    });
    axes.chain(random).collect()
}

#[test]
fn a_ball_is_its_box() {
    let model = [[1.0, 0.0, 0.0, 1.0], [0.0, 2.0, 0.0, -3.0], [0.0, 0.0, -0.5, 0.0]];
    let found = bounds(&[model], &[2.0])[0];
    for (side, exact) in found.low.iter().chain(&found.high).zip([-1.0, -7.0, -1.0, 0.0, 3.0, 1.0, 1.0, 0.0])
    {
        assert!((side - exact).abs() < 1.5e-5, "{found:?}");
    }
    assert!(contains(&found, [3.0, 1.0, 1.0]) && contains(&found, [-1.0, -7.0, -1.0]));
}

/// The parent's uneven scale shears the child: its longest column is shorter than it stretches.
#[test]
fn shear_is_covered() {
    let eighth = std::f32::consts::FRAC_PI_8;
    let bone = |parent| Bone { name: String::new(), parent, rest: Transform::IDENTITY };
    let skeleton = Skeleton::of_joints(vec![bone(None), bone(Some(0))]).expect("valid");
    let locals = [
        Transform { scale: [10.0, 1.0, 1.0], ..Transform::IDENTITY },
        Transform { rotation: [0.0, 0.0, eighth.sin(), eighth.cos()], ..Transform::IDENTITY },
    ];
    let models = local_to_model(&skeleton, &locals);
    let found = bounds(&models, &[0.0, 1.0])[0];
    assert!(directions().iter().all(|direction| contains(&found, moved(&models[1], *direction))));
    let column = |axis: usize| models[1].map(|row| row[axis]).iter().map(|x| x * x).sum::<f32>().sqrt();
    assert!((0..3).all(|axis| column(axis) < 7.2) && found.high[0] >= 10.0, "{found:?}");
}

/// Every point that bones of a walking creature may move is inside, and so are points that two bones share; and
/// some point lies close to each side.
#[test]
fn all_that_bones_reach_lies_inside() {
    let model = creature().expect("valid");
    let bone_radii = bone_radii(&model.skeleton);
    let directions = directions();
    for time in [0.0, 0.21, 0.6] {
        let models = local_to_model(&model.skeleton, &sample(&model.clips[0], time, RotationPath::Slerp));
        let found = bounds(&models, &bone_radii)[0];
        let mut reached = [[f64::MAX; 3], [f64::MIN; 3]];
        for (at, (own, bone_radius)) in models.iter().zip(&bone_radii).enumerate() {
            for (turn, direction) in directions.iter().enumerate() {
                let point = moved(own, direction.map(|x| x * f64::from(*bone_radius)));
                assert!(contains(&found, point), "bone {at}: {point:?} outside {found:?}");
                let other = (at * 31 + turn) % models.len();
                let shared = moved(
                    &models[other],
                    directions[(turn * 7) % 500].map(|x| x * f64::from(bone_radii[other])),
                );
                let fraction = turn as f64 / 505.0;
                let between = std::array::from_fn(|i| point[i] + (shared[i] - point[i]) * fraction);
                assert!(contains(&found, between));
                for i in 0..3 {
                    reached[0][i] = reached[0][i].min(point[i]);
                    reached[1][i] = reached[1][i].max(point[i]);
                }
            }
        }
        let [least, largest] = reached;
        let lower = least.iter().zip(found.low).map(|(reached, side)| reached - f64::from(side));
        let upper = largest.iter().zip(found.high).map(|(reached, side)| f64::from(side) - reached);
        // 500 directions come within some degrees of every other one, 0.5 % of the radius.
        assert!(lower.chain(upper).all(|off| (0.0..0.01).contains(&off)), "{reached:?} in {found:?}");
    }
}

#[test]
fn a_point_is_a_point() {
    let found = bounds(&[AFFINE_IDENTITY], &[0.0])[0];
    assert_eq!((found.low, found.high), ([0.0; 4], [0.0; 4]));
}
