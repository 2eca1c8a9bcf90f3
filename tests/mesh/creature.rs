//! The built-in creature in the poses of its walk.

use std::time::Instant;

use relievo::asset::keyframe::RotationPath;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use relievo::ops::mesh::{SimplifyOptions, Stopped, Surface, simplify};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::vertex::Blend;
use relievo::ops::terrain::export::sha256;
use relievo_samples::creature;

use crate::measure::{Topology, distances, topology};
use crate::shapes::Shape;

/// The creature at `poses` evenly spaced times of a cycle.
fn walking(poses: usize) -> Shape {
    let model = creature().expect("valid");
    let mesh = &model.meshes[0];
    let clip = model.clip("walk").expect("there");
    let vertices = morph(mesh, &mesh.weights);
    let pose = |at: usize| {
        let time = clip.duration() * at as f32 / poses as f32;
        let models = local_to_model(&model.skeleton, &sample(clip, time, RotationPath::Slerp));
        let palette = palette_for(&model.skins[mesh.skin], &models, Blend::Linear);
        let skinned = skin(&vertices, &mesh.influences, &palette, InstanceLod::FULL);
        skinned.iter().map(|vertex| vertex.position).collect()
    };
    Shape { poses: (0..poses).map(pose).collect(), uv: mesh.uv.clone(), indices: mesh.indices.clone() }
}

#[test]
fn it_keeps_its_shape_in_every_pose() {
    let shape = walking(8);
    let triangles = shape.triangles() * 15 / 100;
    // The width of the texture counts as much as 4 mm.
    let uv: Vec<f32> = shape.uv.as_flattened().iter().map(|value| value * 0.004).collect();
    let surface = Surface { attributes: &uv, ..shape.with_uv() };
    let start = Instant::now();
    let simplified =
        simplify(&surface, &SimplifyOptions { triangles, prune: false, ..SimplifyOptions::default() })
            .expect("valid");
    let taken = start.elapsed();
    assert!(taken.as_secs_f64() < 1.0, "{taken:?}");
    assert_eq!(simplified.stopped(), Stopped::Triangles);
    let whole = topology(&shape, &shape.indices);
    assert!(whole.is_manifold && whole.border == 0);
    for collapses in (0..=simplified.collapses().len()).step_by(100) {
        let level = simplified.triangles(&shape.indices, collapses);
        assert_eq!(topology(&shape, &level), Topology { ..whole }, "after {collapses}");
    }
    let left = simplified.triangles(&shape.indices, simplified.collapses().len());
    for pose in 0..8 {
        // The distances are those of a body 1.8 m tall.
        let [rms, most] = distances(&shape, pose, &left);
        assert!(rms < 0.007 && most < 0.05, "{pose}: {rms} {most}");
    }
}

/// The shape is made without functions that differ between machines.
#[test]
fn it_is_simplified_alike_everywhere() {
    let shape = walking(1);
    let simplified = simplify(&shape.with_uv(), &SimplifyOptions::default()).expect("valid");
    let moved = (0..simplified.collapses().len()).flat_map(|at| simplified.moved(at)).flatten();
    let errors = simplified.collapses().iter().map(|collapse| collapse.error.to_bits());
    let words: Vec<i32> = moved.copied().chain(errors).map(|word| word as i32).collect();
    assert_eq!(sha256(&words), "6628219b372e2021936b425742c0bb26995c8406d3009eb191f47e30709f7d1b");
}
