//! Whole frames under a gate on the device, with layers, compared with frames in full.

use relievo::Error;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::{Affine, Clip, Model, Skeleton};
use relievo::gpu::Gpu;
use relievo::ops::animation::active::Active;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::frame::GatedFrame;
use relievo::ops::animation::gate::GatePass;
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::keyframe_cursor::KeyframeCursorPass;
use relievo::ops::animation::local_to_model::LocalToModelPass;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::sample::SamplePass;
use relievo::ops::animation::{
    AnimatedBones, AnimationLayer, BoundTable, ClipSet, ExpectationTable, Frame, Gate, GateState, Lod,
};
use relievo_samples::creature;

use crate::harness::{foreign_adapter, gpu};

fn frame(number: u32) -> Frame {
    Frame { ticks: number, frame_ticks: 1, frame: number, ahead: 1.0 / 60.0 }
}

/// The largest difference of two entries.
fn furthest(a: &[Affine], b: &[Affine]) -> f32 {
    let pairs = a.as_flattened().as_flattened().iter().zip(b.as_flattened().as_flattened());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// If nothing may be missed, a gated crowd equals the full one: layers fade in and out, clips change.
#[test]
fn a_gate_that_misses_nothing_changes_nothing() {
    let gpu = &gpu();
    let model = creature().expect("valid");
    let clips: Vec<_> = model.clips.iter().collect();
    let set = ClipSet::new(&clips).expect("one skeleton");
    let buffers = ClipBuffers::new(gpu, &set).expect("uploaded");
    let bone_radii = vec![0.1; model.skeleton.len()];
    let table = BoundTable::new(&model.skeleton, &set, &clips, &bone_radii, RotationPath::Slerp);
    let gate = Gate::Bounded(table.expect("fits"));
    let plays = |clip: u32| -> Vec<Instance> {
        (0..5).map(|at| Instance::new(clip, Wrap::Loop, 0.2 * at as f32, 1.0 - 0.4 * at as f32)).collect()
    };
    let layers = [AnimationLayer::new(plays(2), vec![0.0, 0.5, 1.0, 0.0, 0.25])];
    let crowd = || Crowd::layered(gpu, &set, &plays(0), &layers).expect("fits");
    let (lazy, full) = (crowd(), crowd());
    let gated = GatedFrame::new(gpu, &model.skeleton, &buffers, &lazy, &gate).expect("prepared");
    gated.state.write_lods(gpu, &[Lod::FULL; 5]).expect("written");
    let (cursor, sample) = (KeyframeCursorPass::new(gpu), SamplePass::layered(gpu, RotationPath::Slerp));
    let (cursor, sample) = (cursor.expect("compiled"), sample.expect("compiled"));
    let local_to_model = LocalToModelPass::new(gpu).expect("compiled");
    let all_cursors = cursor.prepare(gpu, &buffers, &full).expect("prepared");
    let all_samples = sample.prepare(gpu, &buffers, &full).expect("prepared");
    let all_matrices = local_to_model.prepare(gpu, &model.skeleton, &full).expect("prepared");
    for number in 0..8_u32 {
        let elapsed = 0.15 * number as f32;
        if number == 3 {
            for crowd in [&lazy, &full] {
                crowd.set_weights(gpu, 1, &[1.0, 0.0, 0.0, 0.5, 0.0]).expect("fits");
                crowd.instances.write_at(gpu, 0, &plays(1)).expect("written");
            }
        }
        gated.set(gpu, &frame(number), elapsed).expect("set");
        all_cursors.set(gpu, elapsed).expect("set");
        gpu.run("test", |encoder| {
            gated.record(encoder);
            all_cursors.record(encoder);
            all_samples.record(encoder);
            all_matrices.record(encoder);
        })
        .expect("run");
        let [lazy, full] =
            [&lazy, &full].map(|crowd| crowd.model_matrices().read_blocking(gpu).expect("read"));
        let worst = furthest(&lazy, &full);
        assert!(worst < 1e-5, "frame {number}: {worst}");
    }
}

/// Gates of a clip: one that decides by its table of bones alone, one by bounds, one by a budget.
fn gates(skeleton: &Skeleton, set: &ClipSet, clip: &Clip, path: RotationPath) -> [Gate; 3] {
    let (clips, bone_radii) = ([clip], vec![0.1; skeleton.len()]);
    let bones = AnimatedBones::new(&Order::new(skeleton), set, &clips).expect("fits");
    let bounds = BoundTable::new(skeleton, set, &clips, &bone_radii, path).expect("fits");
    let table = ExpectationTable::new(skeleton, set, &clips, &bone_radii, path).expect("fits");
    [Gate::Uniform(bones), Gate::Bounded(bounds), Gate::Budget { table, bones: 1000 }]
}

/// The state after a gated frame of a crowd of characters, every second one at half detail: active bits and
/// matrices.
fn played(gpu: &Gpu, model: &Model, set: &ClipSet, gate: &Gate) -> (Vec<u32>, Vec<Affine>) {
    let buffers = ClipBuffers::new(gpu, set).expect("uploaded");
    let plays: Vec<_> = (0..40).map(|at| Instance::new(0, Wrap::Loop, 0.1 * at as f32, 1.0)).collect();
    let crowd = Crowd::new(gpu, set, &plays).expect("fits");
    let prepared = GatedFrame::new(gpu, &model.skeleton, &buffers, &crowd, gate);
    let prepared = prepared.expect("prepared");
    let allowed = if let Gate::Bounded(table) = gate { table.units(0.01) } else { 0 };
    let lod = |at: u32| Lod { omega: 65536 / (1 + at % 2), allowed, ..Lod::FULL };
    prepared.state.write_lods(gpu, &(0..40).map(lod).collect::<Vec<_>>()).expect("written");
    for number in 0..4 {
        prepared.set(gpu, &frame(number), number as f32 / 8.0).expect("set");
        gpu.run("test", |encoder| prepared.record(encoder)).expect("run");
    }
    let bits = prepared.active.bits.read_blocking(gpu).expect("read");
    (bits, crowd.model_matrices().read_blocking(gpu).expect("read"))
}

/// A device that another program opened, with WebGPU's default limits, has the same result.
#[test]
fn devices_with_default_limits_play_the_same_frames() {
    let (own, foreign) = (gpu(), foreign());
    let model = creature().expect("valid");
    let set = ClipSet::new(&[&model.clips[0]]).expect("one skeleton");
    for gate in gates(&model.skeleton, &set, &model.clips[0], RotationPath::Slerp) {
        let [(bits, models), (same_bits, same_models)] =
            [&own, &foreign].map(|gpu| played(gpu, &model, &set, &gate));
        assert!(bits.iter().any(|word| *word != 0), "{}: nothing was active", gate.name());
        assert_eq!(bits, same_bits, "{}", gate.name());
        assert!(furthest(&models, &same_models) < 1e-5, "{}", gate.name());
    }
}

/// Every object that combines a table's motion with sampling refuses two different paths: a whole frame, a
/// decision, and sampling.
#[test]
fn bounds_of_one_path_meet_no_sampling_of_the_other() {
    let gpu = gpu();
    let model = creature().expect("valid");
    let (skeleton, clip) = (&model.skeleton, &model.clips[0]);
    let set = ClipSet::new(&[clip]).expect("one skeleton");
    let (buffers, order) = (ClipBuffers::new(&gpu, &set).expect("uploaded"), Order::new(skeleton));
    let (slerp, nlerp) = (RotationPath::Slerp, RotationPath::Nlerp);
    let plays = [Instance::new(0, Wrap::Loop, 0.0, 1.0)];
    for (path, other) in [(slerp, nlerp), (nlerp, slerp)] {
        let crowd = |path| Crowd::new(&gpu, &set, &plays).expect("fits").with_path(path);
        let (own, foreign) = (crowd(path), crowd(other));
        let active = Active::new(&gpu, &order, &own).expect("fits");
        let [_, bounded, budget] = gates(skeleton, &set, clip, path);
        for gate in [bounded, budget] {
            let frame = |crowd| GatedFrame::new(&gpu, skeleton, &buffers, crowd, &gate).map(drop);
            assert!(frame(&own).is_ok(), "{path:?}, {}", gate.name());
            names_both(frame(&foreign), [path, other]);
            let state = GateState::new(&gpu, &own).expect("allocated");
            let decide = GatePass::new(&gpu, &gate).expect("compiled");
            let decided = |crowd| decide.prepare(&gpu, crowd, &state, &active).map(drop);
            assert!(decided(&own).is_ok(), "{path:?}, {}", gate.name());
            names_both(decided(&foreign), [path, other]);
        }
        let sample = SamplePass::new(&gpu, path).expect("compiled");
        assert!(sample.prepare_active(&gpu, &buffers, &own, &active.pairs).is_ok());
        names_both(sample.prepare(&gpu, &buffers, &foreign).map(drop), [path, other]);
        names_both(sample.prepare_active(&gpu, &buffers, &foreign, &active.pairs).map(drop), [path, other]);
    }
}

/// A gate's table is of a set's clips and a skeleton's bones, and serves no other crowd.
#[test]
fn gates_of_other_clips_or_bones_are_refused() {
    let gpu = gpu();
    let model = creature().expect("valid");
    let all = ClipSet::new(&model.clips.iter().collect::<Vec<_>>()).expect("one skeleton");
    let one = ClipSet::new(&[&model.clips[0]]).expect("one skeleton");
    let plays = [Instance::new(0, Wrap::Loop, 0.0, 1.0)];
    let crowd = Crowd::new(&gpu, &all, &plays).expect("fits");
    let buffers = ClipBuffers::new(&gpu, &all).expect("uploaded");
    for gate in gates(&model.skeleton, &one, &model.clips[0], RotationPath::Slerp) {
        let refused = GatedFrame::new(&gpu, &model.skeleton, &buffers, &crowd, &gate).map(drop);
        let Err(Error::Input(error)) = refused else { panic!("{refused:?} is no refusal") };
        assert_eq!((error.path.as_str(), error.value.as_str()), ("table.clips", "1"), "{}", gate.name());
    }
}

#[track_caller]
fn names_both(refused: Result<(), Error>, [path, other]: [RotationPath; 2]) {
    let Err(Error::Input(error)) = refused else { panic!("{refused:?} is no refusal") };
    assert_eq!((error.path.as_str(), error.value), ("crowd.path", format!("{other:?}")));
    assert!(error.bound.contains(&format!("{path:?}")), "{}", error.bound);
}

/// A device of the suite's adapter as another program opens it.
fn foreign() -> Gpu {
    let (_, adapter) = foreign_adapter();
    let opened = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()));
    let (device, queue) = opened.expect("a device");
    Gpu::from_wgpu(device, queue)
}
