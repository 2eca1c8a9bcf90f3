//! A crowd under animation level of detail, recorded into an encoder of your own without allocation or wait in
//! a frame. Prints how many bones each frame interpolates.
//!
//! `cargo run --release --example crowd`

use relievo::asset::keyframe::RotationPath;
use relievo::asset::mesh::bone_radii;
use relievo::gpu::{Gpu, Options};
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::frame::GatedFrame;
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::{BoundTable, ClipSet, Frame, Gate, Lod, Projection};
use relievo_samples::creature;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // In your program: `Gpu::from_wgpu(device, queue)`.
    let gpu = Gpu::headless(&Options::default())?;

    println!("{}", gpu.adapter());

    // At load time: a model (or `Model::from_file`), its clips, and the gate's table.
    let model = creature()?;
    let clips: Vec<_> = model.clips.iter().collect();
    let set = ClipSet::new(&clips)?;
    let bone_radii = bone_radii(model.skeleton.len(), &model.skins, &model.meshes);
    let table = BoundTable::new(&model.skeleton, &set, &clips, &bone_radii, RotationPath::Slerp)?;

    // A thousand instances, each at a time of its own in the clip, 10 to 110 m away.
    let count = 1000;
    let play = |at: usize| Instance::new(at as u32 % 3, Wrap::Loop, 0.618 * at as f32, 1.0);
    let instances: Vec<_> = (0..count).map(play).collect();
    let buffers = ClipBuffers::new(&gpu, &set)?;
    let crowd = Crowd::new(&gpu, &set, &instances)?;

    // Once: pipelines and bind groups.
    let gate = Gate::Bounded(table.clone());
    let frame = GatedFrame::new(&gpu, &model.skeleton, &buffers, &crowd, &gate)?;

    // Every frame: the distance of each instance, and the pixels that may be missed.
    let projection = Projection::new(1080, 1.0, 0.1);
    let lods: Vec<Lod> = (0..count)
        .map(|at| {
            let center = [0.0, 0.0, 10.0 + 0.1 * at as f32];
            let metres = projection.allowed(center, table.radius(), 1.0);
            Lod { allowed: table.units(metres), ..Lod::FULL }
        })
        .collect();
    for number in 0..60 {
        let elapsed = number as f32 / 60.0;
        frame.state.write_lods(&gpu, &lods)?;
        frame.set(
            &gpu,
            &Frame { ticks: number, frame_ticks: 1, frame: number, ahead: 1.0 / 60.0 },
            elapsed,
        )?;
        let mut encoder = gpu.encoder("frame");
        frame.record(&mut encoder);
        // `crowd.model_matrices()` now holds the matrices of this frame: three rows per bone, to bind wherever
        // you draw.
        gpu.queue().submit([encoder.finish()]);
        // The readback waits for the device; a renderer would not do it.
        if number % 20 < 2 {
            let sampled = frame.active.pairs.dispatched.read_blocking(&gpu)?[3];
            println!("frame {number}: {sampled} of {} bones", crowd.pairs());
        }
    }
    Ok(())
}
