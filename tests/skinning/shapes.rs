//! Meshes and poses that the tests share.

use relievo::asset::Model;
use relievo::asset::influences::{Influence, Influences};
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use relievo_samples::creature;

pub fn model() -> Model {
    creature().expect("valid")
}

/// The creature's palette at a time of a clip.
pub fn models(model: &Model, clip: &str, time: f32) -> Vec<Affine> {
    let clip = model.clip(clip).expect("there");
    local_to_model(&model.skeleton, &sample(clip, time, RotationPath::Slerp))
}

pub fn rows(matrix: glam::Mat4) -> Affine {
    let m = matrix.transpose().to_cols_array_2d();
    [m[0], m[1], m[2]]
}

/// The influences of one vertex after the other: bones and weights.
pub fn influences(vertices: &[&[(u32, f32)]]) -> Influences {
    let vertex =
        |given: &&[(u32, f32)]| given.iter().map(|&(bone, weight)| Influence { bone, weight }).collect();
    Influences::new("w", 64, vertices.iter().map(vertex)).expect("valid")
}

/// Matrices of every kind: rotations, translations, non-uniform scales, shears, mirrors.
pub fn matrices() -> Vec<glam::Mat4> {
    let mut all = Vec::new();
    for step in 0..40 {
        let at = step as f32;
        let axis = glam::vec3(at.sin(), (2.0 * at).cos(), 0.3).normalize();
        let turn = glam::Mat4::from_axis_angle(axis, 0.37 * at);
        let mirror = if step % 3 == 0 { -1.0 } else { 1.0 };
        let stretch = glam::Mat4::from_scale(glam::vec3(mirror, 0.5 + 0.1 * at, 1.5));
        let shear = glam::Mat4::from_axis_angle(axis.zxy(), 0.9) * stretch * turn;
        all.push(
            glam::Mat4::from_translation(glam::vec3(at, -1.0, 0.5 * at))
                * turn
                * if step % 2 == 0 { stretch } else { shear },
        );
    }
    all
}

use glam::Vec3Swizzles as _;
