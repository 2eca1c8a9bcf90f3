//! Crowds on the device.

use relievo::Error;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::{Affine, Model, Transform};
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::animation::bounds::{BoundsPass, bone_radii};
use relievo::ops::animation::crowd::{ClipBuffers, Crowd, unpacked};
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::keyframe_cursor::KeyframeCursorPass;
use relievo::ops::animation::keyframe_cursor::reference::cursors;
use relievo::ops::animation::layers::{MAX_LAYERS, all_instances};
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::local_to_model::{LOCAL_TO_MODEL_BOUND, LocalToModelPass};
use relievo::ops::animation::sample::reference::sample_layers;
use relievo::ops::animation::sample::{SAMPLE_BOUND, SamplePass};
use relievo::ops::animation::{AnimationLayer, ClipSet};
use relievo_lab::harness::compare::absolute;
use relievo_samples::creature;

use crate::harness::gpu;

fn scene() -> (Model, ClipSet) {
    let model = creature().expect("valid");
    let set = ClipSet::new(&model.clips.iter().collect::<Vec<_>>()).expect("one skeleton");
    (model, set)
}

/// Each at a time and a rate of its own.
fn plays(clip: u32, count: usize) -> Vec<Instance> {
    (0..count).map(|at| Instance::new(clip, Wrap::Loop, at as f32 / 16.0, 1.0 + at as f32 / 8.0)).collect()
}

fn field(error: Error) -> String {
    match error {
        Error::Input(error) => error.path,
        other => panic!("{other}"),
    }
}

fn sampled(gpu: &Gpu, set: &ClipSet, crowd: &Crowd, elapsed: f32) -> Vec<Transform> {
    let clips = ClipBuffers::new(gpu, set).expect("uploaded");
    let cursor =
        KeyframeCursorPass::new(gpu).expect("compiled").prepare(gpu, &clips, crowd).expect("prepared");
    let sample = SamplePass::layered(gpu, RotationPath::Slerp).expect("compiled");
    let sample = sample.prepare(gpu, &clips, crowd).expect("prepared");
    cursor.set(gpu, elapsed).expect("set");
    gpu.run("test", |encoder| {
        cursor.record(encoder);
        sample.record(encoder);
    })
    .expect("run");
    crowd.locals.read_blocking(gpu).expect("read").iter().map(unpacked).collect()
}

/// The steps of an engine: cursors of all layers, poses, other weights in the next frame.
#[test]
fn layers_play_from_places_to_poses() {
    let (gpu, (_, set)) = (gpu(), scene());
    let base = plays(0, 5);
    let weights = |shift: usize| (0..5).map(|at| ((at + shift) % 5) as f32 / 4.0).collect::<Vec<_>>();
    let mut layers =
        [AnimationLayer::new(plays(1, 5), weights(0)), AnimationLayer::new(plays(2, 5), weights(2))];
    let crowd = Crowd::layered(&gpu, &set, &base, &layers).expect("fits");
    assert_eq!((crowd.len(), crowd.layers, crowd.pairs()), (5, 3, 5 * 153));
    for frame in 0..2 {
        let elapsed = 0.3 + frame as f32;
        let found = cursors(&set, &all_instances(&base, &layers), elapsed);
        let expected = sample_layers(&set, &base, &layers, &found, RotationPath::Slerp);
        // Cursors may be off by 1e-3 of a key, which moves bones accordingly.
        for (actual, expected) in sampled(&gpu, &set, &crowd, elapsed).iter().zip(&expected) {
            let off = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            let errors = [
                off(&actual.translation, &expected.translation),
                off(&actual.rotation, &expected.rotation),
                off(&actual.scale, &expected.scale),
            ];
            assert!(errors.into_iter().fold(0.0, f32::max) < 1e-3 + SAMPLE_BOUND, "{errors:?}");
        }
        layers[1].weights = weights(4);
        crowd.set_weights(&gpu, 2, &layers[1].weights).expect("set");
    }
}

#[test]
fn layers_that_do_not_fit_are_refused() {
    let (gpu, (_, set)) = (gpu(), scene());
    let layer = AnimationLayer::new(plays(1, 2), vec![1.0; 2]);
    let crowd = Crowd::layered(&gpu, &set, &plays(0, 2), std::slice::from_ref(&layer)).expect("fits");
    let refused = |layers: &[AnimationLayer]| {
        field(Crowd::layered(&gpu, &set, &plays(0, 2), layers).expect_err("refused"))
    };
    assert_eq!(refused(&vec![layer.clone(); MAX_LAYERS]), "layers.len");
    assert_eq!(
        refused(&[layer.clone(), AnimationLayer { weights: vec![0.0, 2.0], ..layer }]),
        "layers[1].weights[1]"
    );
    let refused =
        |layer, weights: &[f32]| field(crowd.set_weights(&gpu, layer, weights).expect_err("refused"));
    assert_eq!((refused(0, &[1.0; 2]), refused(2, &[1.0; 2])), ("layer".to_owned(), "layer".to_owned()));
    assert_eq!(
        (refused(1, &[1.0]), refused(1, &[0.0, f32::NAN])),
        ("weights.len".into(), "weights[1]".into())
    );
    let clips = ClipBuffers::new(&gpu, &set).expect("uploaded");
    let plain = SamplePass::new(&gpu, RotationPath::Slerp).expect("compiled");
    assert_eq!(field(plain.prepare(&gpu, &clips, &crowd).expect_err("refused")), "crowd.layers");
}

/// Layers end with sampling: concatenation handles each instance once, whatever the number of layers.
#[test]
fn layered_crowds_are_concatenated() {
    let (gpu, (model, set)) = (gpu(), scene());
    let layers =
        [AnimationLayer::new(plays(1, 5), vec![0.5; 5]), AnimationLayer::new(plays(2, 5), vec![0.25; 5])];
    let crowd = Crowd::layered(&gpu, &set, &plays(0, 5), &layers).expect("fits");
    let stale = vec![[f32::NAN; 12]; crowd.pairs()];
    gpu.queue().write_buffer(crowd.model_matrices().raw(), 0, bytemuck::cast_slice(&stale));
    let locals = sampled(&gpu, &set, &crowd, 0.3);
    let expected: Vec<f32> = locals
        .chunks(153)
        .flat_map(|locals| local_to_model(&model.skeleton, locals))
        .flatten()
        .flatten()
        .collect();
    let pass = LocalToModelPass::new(&gpu).expect("compiled");
    let job = pass.prepare(&gpu, &model.skeleton, &crowd).expect("prepared");
    gpu.run("test", |encoder| job.record(encoder)).expect("run");
    let flat = |models: &[Affine]| models.as_flattened().as_flattened().to_vec();
    let actual = crowd.model_matrices().read_blocking(&gpu).expect("read");
    let found = absolute(&flat(&actual), &expected, 20.0 * LOCAL_TO_MODEL_BOUND * 3.0);
    assert!(found.holds, "{found:?}");
}

#[test]
fn bounds_that_do_not_fit_are_refused() {
    let (gpu, (model, set)) = (gpu(), scene());
    let crowd = Crowd::new(&gpu, &set, &plays(0, 3)).expect("fits");
    let pass = BoundsPass::new(&gpu).expect("compiled");
    let refused = |bone_radii: &[f32], room| {
        let bounds = Buffer::new(&gpu, "bounds", room).expect("allocated");
        field(pass.prepare(&gpu, &crowd, bone_radii, &bounds).expect_err("refused"))
    };
    let bone_radii = bone_radii(&model.skeleton);
    assert_eq!(
        (refused(&bone_radii[1..], 3), refused(&bone_radii, 2)),
        ("bone_radii.len".into(), "bounds".into())
    );
    assert_eq!(refused(&[&bone_radii[..152], &[f32::NAN]].concat(), 3), "bone_radii[152]");
}
