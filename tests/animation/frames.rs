//! Whole frames under a gate on the device, with layers, compared with frames in full.

use relievo::Error;
use relievo::animation::active::Active;
use relievo::animation::compact::Stages;
use relievo::animation::crowd::{ClipBuffers, Crowd};
use relievo::animation::decide::{DecidePass, Dispatches};
use relievo::animation::frame::GatedFrame;
use relievo::animation::gate_state::GateState;
use relievo::animation::instance::Instance;
use relievo::animation::instance::Wrap;
use relievo::animation::keyframe_cursor::KeyframeCursorPass;
use relievo::animation::local_to_model::{LocalToModelPass, Walk};
use relievo::animation::order::Order;
use relievo::animation::sample::SamplePass;
use relievo::animation::{Choice, ClipSet, Frame, Gate, GateTable, Layer, Lod};
use relievo::asset::Affine;
use relievo::asset::keyframe::RotationPath;
use relievo::gpu::{Gpu, GpuError};
use relievo::samples::creature;

use crate::harness::gpu;

const BOUNDED: Choice = Choice::Gate(Gate::Bounded);

fn frame(number: u32) -> Frame {
    Frame { ticks: number, frame_ticks: 1, frame: number, ahead: 1.0 / 60.0 }
}

/// The largest difference of two entries.
fn furthest(a: &[Affine], b: &[Affine]) -> f32 {
    let pairs = a.as_flattened().as_flattened().iter().zip(b.as_flattened().as_flattened());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// If nothing may be missed, a gated crowd equals the full one: layers fade in and out, clips change, on both
/// walks.
#[test]
fn a_gate_that_misses_nothing_changes_nothing() {
    let gpu = gpu();
    let model = creature().expect("valid");
    let clips: Vec<_> = model.clips.iter().collect();
    let (set, order) = (ClipSet::new(&clips).expect("one skeleton"), Order::new(&model.skeleton));
    let buffers = ClipBuffers::new(&gpu, &set).expect("uploaded");
    let bone_radii = vec![0.1; model.skeleton.len()];
    let table = GateTable::of_bounds(&model.skeleton, &set, &clips, &bone_radii, RotationPath::Slerp);
    let table = table.expect("fits");
    let plays = |clip: u32| -> Vec<Instance> {
        (0..5).map(|at| Instance::new(clip, Wrap::Loop, 0.2 * at as f32, 1.0 - 0.4 * at as f32)).collect()
    };
    let layers = [Layer::new(plays(2), vec![0.0, 0.5, 1.0, 0.0, 0.25])];
    for walk in [Walk::Levels, Walk::Whole] {
        let crowd = || Crowd::layered(&gpu, &set, &plays(0), &layers).expect("fits");
        let (lazy, full) = (crowd(), crowd());
        let gate_state = GateState::new(&gpu, &table, &lazy).expect("fits");
        gate_state.lods.write(&gpu, &[Lod::FULL; 5]).expect("written");
        let active = Active::new(&gpu, &order, &lazy).expect("fits");
        let (cursor, sample) =
            (KeyframeCursorPass::new(&gpu), SamplePass::layered(&gpu, RotationPath::Slerp));
        let (cursor, sample) = (cursor.expect("compiled"), sample.expect("compiled"));
        let local_to_model = LocalToModelPass::new(&gpu, walk).expect("compiled");
        let decide = DecidePass::new(&gpu, BOUNDED, Dispatches::Each).expect("compiled");
        let decide = decide.prepare(&gpu, &buffers, &lazy, &gate_state, &active).expect("prepared");
        let cursors = cursor.prepare_active(&gpu, &buffers, &lazy, &gate_state, &active).expect("prepared");
        let samples = sample.prepare_active(&gpu, &buffers, &lazy, &active.pairs).expect("prepared");
        let palettes =
            local_to_model.prepare_active(&gpu, &model.skeleton, &lazy, &active).expect("prepared");
        let all_cursors = cursor.prepare(&gpu, &buffers, &full).expect("prepared");
        let all_samples = sample.prepare(&gpu, &buffers, &full).expect("prepared");
        let all_palettes = local_to_model.prepare(&gpu, &model.skeleton, &full).expect("prepared");
        for number in 0..8_u32 {
            let elapsed = 0.15 * number as f32;
            if number == 3 {
                for crowd in [&lazy, &full] {
                    crowd.set_weights(&gpu, 1, &[1.0, 0.0, 0.0, 0.5, 0.0]).expect("fits");
                    crowd.instances.write_at(&gpu, 0, &plays(1)).expect("written");
                }
            }
            decide.set(&gpu, &frame(number), elapsed).expect("set");
            cursors.set(&gpu, elapsed).expect("set");
            all_cursors.set(&gpu, elapsed).expect("set");
            gpu.run("test", |encoder| {
                decide.record(encoder);
                cursors.record(encoder);
                samples.record(encoder);
                palettes.record(encoder);
                all_cursors.record(encoder);
                all_samples.record(encoder);
                all_palettes.record(encoder);
            })
            .expect("run");
            let [lazy, full] =
                [&lazy, &full].map(|crowd| crowd.model_matrices().read_blocking(&gpu).expect("read"));
            let worst = furthest(&lazy, &full);
            assert!(worst < 1e-5, "{walk:?}, frame {number}: {worst}");
        }
    }
}

/// The state after a gated frame of a crowd of characters, every second one at half detail: active bits and
/// matrices.
fn played(gpu: &Gpu, choice: Choice) -> (Vec<u32>, Vec<Affine>) {
    let model = creature().expect("valid");
    let set = ClipSet::new(&[&model.clips[0]]).expect("one skeleton");
    let (skeleton, clips, path) = (&model.skeleton, [&model.clips[0]], RotationPath::Slerp);
    let bone_radii = vec![0.1; skeleton.len()];
    let table = match choice {
        BOUNDED => GateTable::of_bounds(skeleton, &set, &clips, &bone_radii, path),
        Choice::Gate(_) => GateTable::of_animated_bones(&Order::new(skeleton), &set, &clips),
        Choice::Budget(_) => GateTable::of_expectations(skeleton, &set, &clips, &bone_radii, path),
    };
    let table = table.expect("fits");
    let buffers = ClipBuffers::new(gpu, &set).expect("uploaded");
    let plays: Vec<_> = (0..40).map(|at| Instance::new(0, Wrap::Loop, 0.1 * at as f32, 1.0)).collect();
    let crowd = Crowd::new(gpu, &set, &plays).expect("fits");
    let prepared = GatedFrame::new(gpu, skeleton, &buffers, &crowd, &table, choice);
    let prepared = prepared.expect("prepared");
    let allowed = table.units(0.01);
    let lod = |at: u32| Lod { omega: 65536 / (1 + at % 2), allowed, ..Lod::FULL };
    prepared.gate_state.lods.write(gpu, &(0..40).map(lod).collect::<Vec<_>>()).expect("written");
    for number in 0..4 {
        prepared.set(gpu, &frame(number), number as f32 / 8.0).expect("set");
        gpu.run("test", |encoder| prepared.record(encoder)).expect("run");
    }
    let bits = prepared.active.bits.read_blocking(gpu).expect("read");
    (bits, crowd.model_matrices().read_blocking(gpu).expect("read"))
}

/// A device that another program opened, with WebGPU's default limits, decides in several dispatches, with the
/// same result.
#[test]
fn devices_with_default_limits_play_the_same_frames() {
    let (own, foreign) = (gpu(), foreign());
    for choice in [Choice::Gate(Gate::Uniform), BOUNDED, Choice::Budget(1000)] {
        let [(bits, models), (same_bits, same_models)] = [&own, &foreign].map(|gpu| played(gpu, choice));
        assert!(bits.iter().any(|word| *word != 0), "{choice:?}: nothing was active");
        assert_eq!(bits, same_bits, "{choice:?}");
        assert!(furthest(&models, &same_models) < 1e-5, "{choice:?}");
    }
    let refused = DecidePass::new(&foreign, BOUNDED, Dispatches::One).expect_err("too many buffers");
    assert!(matches!(refused, GpuError::Limit { available: 8, .. }), "{refused}");
}

/// Every object that combines a table's motion with sampling refuses two different paths: a whole frame, a
/// decision, and sampling.
#[test]
fn bounds_of_one_path_meet_no_sampling_of_the_other() {
    let gpu = gpu();
    let model = creature().expect("valid");
    let clips = [&model.clips[0]];
    let set = ClipSet::new(&clips).expect("one skeleton");
    let (skeleton, bone_radii) = (&model.skeleton, vec![0.1; model.skeleton.len()]);
    let (buffers, order) = (ClipBuffers::new(&gpu, &set).expect("uploaded"), Order::new(skeleton));
    let (slerp, nlerp) = (RotationPath::Slerp, RotationPath::Nlerp);
    let plays = [Instance::new(0, Wrap::Loop, 0.0, 1.0)];
    for (path, other) in [(slerp, nlerp), (nlerp, slerp)] {
        let crowd = |path| Crowd::new(&gpu, &set, &plays).expect("fits").with_path(path);
        let (own, foreign) = (crowd(path), crowd(other));
        let active = Active::new(&gpu, &order, &own).expect("fits");
        let bounds = GateTable::of_bounds(skeleton, &set, &clips, &bone_radii, path).expect("fits");
        let expected = GateTable::of_expectations(skeleton, &set, &clips, &bone_radii, path).expect("fits");
        for (table, choice) in [(&bounds, BOUNDED), (&expected, Choice::Budget(9))] {
            let frame = |crowd| GatedFrame::new(&gpu, skeleton, &buffers, crowd, table, choice).map(|_| ());
            assert!(frame(&own).is_ok(), "{path:?}, {choice:?}");
            names_both(frame(&foreign), [path, other]);
            // A decision for a crowd other than the gate's.
            let gate_state = GateState::new(&gpu, table, &own).expect("fits");
            let decide = DecidePass::new(&gpu, choice, Dispatches::Each).expect("compiled");
            let decided = |crowd| decide.prepare(&gpu, &buffers, crowd, &gate_state, &active).map(|_| ());
            assert!(decided(&own).is_ok(), "{path:?}, {choice:?}");
            names_both(decided(&foreign), [path, other]);
        }
        let sample = SamplePass::new(&gpu, path).expect("compiled");
        assert!(sample.prepare_active(&gpu, &buffers, &own, &active.pairs).is_ok());
        names_both(sample.prepare(&gpu, &buffers, &foreign).map(|_| ()), [path, other]);
        names_both(sample.prepare_active(&gpu, &buffers, &foreign, &active.pairs).map(|_| ()), [path, other]);
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
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let all = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let name = gpu().adapter().name.clone();
    let adapter = all.into_iter().find(|adapter| adapter.get_info().name == name).expect("the suite's");
    let opened = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()));
    let (device, queue) = opened.expect("a device");
    Gpu::from_wgpu(device, queue)
}

/// One dispatch is chosen only for small crowds on software adapters, and never for a budget.
#[test]
fn small_crowds_on_processors_are_decided_in_one_dispatch() {
    let gpu = gpu();
    let model = creature().expect("valid");
    let set = ClipSet::new(&[&model.clips[0]]).expect("one skeleton");
    let chosen = |instances: usize, choice| {
        let plays = vec![Instance::new(0, Wrap::Loop, 0.0, 1.0); instances];
        let crowd = Crowd::new(&gpu, &set, &plays).expect("fits");
        let active = Active::new(&gpu, &Order::new(&model.skeleton), &crowd).expect("fits");
        assert_eq!(Stages::of(&gpu, &active) == Stages::One, instances < 1000 && gpu.adapter().is_software());
        Dispatches::of(&gpu, choice, &active)
    };
    let has_room = gpu.device().limits().max_storage_buffers_per_shader_stage >= 19;
    let small = if gpu.adapter().is_software() && has_room { Dispatches::One } else { Dispatches::Each };
    assert_eq!(chosen(100, BOUNDED), small);
    assert_eq!(chosen(1000, BOUNDED), Dispatches::Each);
    assert_eq!(chosen(100, Choice::Budget(5)), Dispatches::Each);
}
