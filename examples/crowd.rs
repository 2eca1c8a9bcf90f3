//! A crowd under animation level of detail, recorded into an encoder of your own: no allocation and no wait a frame.
//! Prints how many bones each frame interpolates.
//!
//! `cargo run --release --example crowd`

use relievo::animation::compact::{Active, CompactPass, Stages};
use relievo::animation::concat::{ConcatPass, Walk};
use relievo::animation::crowd::{ClipBuffers, Crowd};
use relievo::animation::gate::{GatePass, Gating};
use relievo::animation::phase::PhasePass;
use relievo::animation::place::PlacePass;
use relievo::animation::sample::{RotationPath, SamplePass, Wrap};
use relievo::animation::{ClipSet, Frame, Gate, GateTable, Instance, Lens, Lod, Order, creature};
use relievo::gpu::{Gpu, Options};
use relievo::skinning::mesh::reaches;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Yours: `Gpu::from_wgpu(device, queue)`.
    let gpu = Gpu::headless(&Options::default())?;

    println!("{}", gpu.adapter());

    // At load time: a model (or `Model::from_file`), its clips, and what the gate has to know of them.
    let model = creature()?;
    let clips: Vec<_> = model.clips.iter().collect();
    let (set, order) = (ClipSet::new(&clips)?, Order::new(&model.skeleton));
    let reaches = reaches(model.skeleton.len(), &model.skins, &model.meshes);
    let table = GateTable::of_bounds(&model.skeleton, &set, &clips, &reaches, RotationPath::Slerp)?;

    // A thousand of them, each at a moment of its own, from 10 to 110 m away.
    let count = 1000;
    let play = |at: usize| Instance::new(at as u32 % 3, Wrap::Loop, 0.618 * at as f32, 1.0);
    let instances: Vec<_> = (0..count).map(play).collect();
    let buffers = ClipBuffers::new(&gpu, &set)?;
    let crowd = Crowd::new(&gpu, &set, &instances)?;
    let gating = Gating::new(&gpu, &table, &crowd)?;
    let active = Active::new(&gpu, &order, &crowd)?;

    // Once: pipelines and bind groups.
    let phase = PhasePass::new(&gpu)?.prepare(&gpu, &buffers, &crowd, &gating)?;
    let gate = GatePass::new(&gpu, Gate::Bounded)?.prepare(&gpu, &crowd, &gating, &active)?;
    let lists = CompactPass::new(&gpu)?.prepare(&gpu, &crowd, &active, Stages::of(&gpu, &active))?;
    let place = PlacePass::new(&gpu)?.prepare_active(&gpu, &buffers, &crowd, &gating, &active)?;
    let sample = SamplePass::new(&gpu, RotationPath::Slerp)?;
    let sample = sample.prepare_active(&gpu, &buffers, &crowd, &active.pairs)?;
    let concat = ConcatPass::new(&gpu, Walk::of(&gpu))?;
    let concat = concat.prepare_active(&gpu, &model.skeleton, &crowd, &active)?;

    // A frame: how far away each is, and how many pixels may be missed.
    let lens = Lens::new(1080, 1.0, 0.1);
    let lods: Vec<Lod> = (0..count)
        .map(|at| {
            let centre = [0.0, 0.0, 10.0 + 0.1 * at as f32];
            let metres = lens.allowed(centre, table.radius(), 1.0);
            Lod { allowed: table.units(metres), ..Lod::FULL }
        })
        .collect();
    for number in 0..60 {
        let elapsed = number as f32 / 60.0;
        gating.lods.write(&gpu, &lods)?;
        phase.set(&gpu, elapsed)?;
        gate.set(&gpu, &Frame { ticks: number, frame_ticks: 1, frame: number })?;
        place.set(&gpu, elapsed)?;
        let mut encoder = gpu.encoder("frame");
        phase.record(&mut encoder);
        gate.record(&mut encoder);
        lists.record(&mut encoder);
        place.record(&mut encoder);
        sample.record(&mut encoder);
        concat.record(&mut encoder);
        // `crowd.models` holds the palettes now: three rows a bone, to bind wherever you draw.
        gpu.queue().submit([encoder.finish()]);
        // Looking waits for the device; a renderer would not.
        if number % 20 < 2 {
            let sampled = active.pairs.dispatched.read_blocking(&gpu)?[3];
            println!("frame {number}: {sampled} of {} bones", crowd.pairs());
        }
    }
    Ok(())
}
