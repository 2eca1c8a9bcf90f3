//! Whole frames under a gate on the device at hand, layers included, beside frames in full.

use relievo::animation::compact::{Active, CompactPass, Stages};
use relievo::animation::concat::{ConcatPass, Walk};
use relievo::animation::crowd::{ClipBuffers, Crowd};
use relievo::animation::gate::{GatePass, Gating};
use relievo::animation::phase::PhasePass;
use relievo::animation::place::PlacePass;
use relievo::animation::sample::{RotationPath, SamplePass, Wrap};
use relievo::animation::{ClipSet, Frame, Gate, GateTable, Instance, Layer, Lod, Order, creature};

use crate::harness::gpu;

/// Where nothing may be missed, a gated crowd is the full one: layers fade in and out, clips change, on both walks.
#[test]
fn a_gate_that_misses_nothing_changes_nothing() {
    let gpu = gpu();
    let model = creature().expect("valid");
    let clips: Vec<_> = model.clips.iter().collect();
    let (set, order) = (ClipSet::new(&clips).expect("one skeleton"), Order::new(&model.skeleton));
    let buffers = ClipBuffers::new(&gpu, &set).expect("uploaded");
    let reaches = vec![0.1; model.skeleton.len()];
    let table = GateTable::of_bounds(&model.skeleton, &set, &clips, &reaches, RotationPath::Slerp);
    let table = table.expect("fits");
    let plays = |clip: u32| -> Vec<Instance> {
        (0..5).map(|at| Instance::new(clip, Wrap::Loop, 0.2 * at as f32, 1.0 - 0.4 * at as f32)).collect()
    };
    let layers = [Layer::new(plays(2), vec![0.0, 0.5, 1.0, 0.0, 0.25])];
    for walk in [Walk::Levels, Walk::Whole] {
        let crowd = || Crowd::layered(&gpu, &set, &plays(0), &layers).expect("fits");
        let (lazy, full) = (crowd(), crowd());
        let gating = Gating::new(&gpu, &table, &lazy).expect("fits");
        gating.lods.write(&gpu, &[Lod::FULL; 5]).expect("written");
        let active = Active::new(&gpu, &order, &lazy).expect("fits");
        let (place, sample) = (PlacePass::new(&gpu), SamplePass::layered(&gpu, RotationPath::Slerp));
        let (place, sample) = (place.expect("compiled"), sample.expect("compiled"));
        let concat = ConcatPass::new(&gpu, walk).expect("compiled");
        let phase = PhasePass::new(&gpu).expect("compiled").prepare(&gpu, &buffers, &lazy, &gating);
        let gate =
            GatePass::new(&gpu, Gate::Bounded).expect("compiled").prepare(&gpu, &lazy, &gating, &active);
        let lists = CompactPass::new(&gpu).expect("compiled").prepare(&gpu, &lazy, &active, Stages::Three);
        let (phase, gate, lists) =
            (phase.expect("prepared"), gate.expect("prepared"), lists.expect("prepared"));
        let places = place.prepare_active(&gpu, &buffers, &lazy, &gating, &active).expect("prepared");
        let samples = sample.prepare_active(&gpu, &buffers, &lazy, &active.pairs).expect("prepared");
        let palettes = concat.prepare_active(&gpu, &model.skeleton, &lazy, &active).expect("prepared");
        let all_places = place.prepare(&gpu, &buffers, &full).expect("prepared");
        let all_samples = sample.prepare(&gpu, &buffers, &full).expect("prepared");
        let all_palettes = concat.prepare(&gpu, &model.skeleton, &full).expect("prepared");
        for number in 0..8_u32 {
            let elapsed = 0.15 * number as f32;
            if number == 3 {
                for crowd in [&lazy, &full] {
                    crowd.set_weights(&gpu, 1, &[1.0, 0.0, 0.0, 0.5, 0.0]).expect("fits");
                    crowd.instances.write_at(&gpu, 0, &plays(1)).expect("written");
                }
            }
            phase.set(&gpu, elapsed).expect("set");
            gate.set(&gpu, &Frame { ticks: number, frame_ticks: 1, frame: number }).expect("set");
            places.set(&gpu, elapsed).expect("set");
            all_places.set(&gpu, elapsed).expect("set");
            gpu.run("test", |encoder| {
                phase.record(encoder);
                gate.record(encoder);
                lists.record(encoder);
                places.record(encoder);
                samples.record(encoder);
                palettes.record(encoder);
                all_places.record(encoder);
                all_samples.record(encoder);
                all_palettes.record(encoder);
            })
            .expect("run");
            let [lazy, full] = [&lazy, &full].map(|crowd| crowd.models.read_blocking(&gpu).expect("read"));
            let pairs = lazy.as_flattened().as_flattened().iter().zip(full.as_flattened().as_flattened());
            let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 1e-5, "{walk:?}, frame {number}: {worst}");
        }
    }
}
