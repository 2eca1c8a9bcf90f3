//! Benchmark cases of `animation/bounds`: bounds of crowds.

use crate::Error;
use crate::animation::bench::{CROWDS, Scene};
use crate::animation::bounds::reference::bounds;
use crate::animation::bounds::{BoundsPass, Share, bone_radii};
use crate::animation::keyframe_cursor::reference::cursors;
use crate::animation::local_to_model::reference::local_to_model;
use crate::animation::sample::reference::sample_set;
use crate::asset::keyframe::RotationPath;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures all instances, from their model matrices.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = BoundsPass::new(gpu, Share::of(gpu))?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let found = cursors(&scene.set, &scene.instances, 0.4);
        let locals = sample_set(&scene.set, &scene.instances, &found, RotationPath::Slerp);
        let bones = scene.skeleton.len();
        let model_matrices: Vec<_> =
            locals.chunks(bones).flat_map(|locals| local_to_model(&scene.skeleton, locals)).collect();
        scene.crowd.model_matrices.buffer().write(gpu, &model_matrices)?;
        let bone_radii = bone_radii(&scene.skeleton);
        let job = pass.prepare(gpu, &scene.crowd, &bone_radii, &Buffer::new(gpu, "bounds", count)?)?;
        // The kernel reads the model matrices and writes 8 words per instance.
        let words = 12 * scene.pairs() + 8 * count;
        let copied = copy_of(gpu, words / 2)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                drop(std::hint::black_box(bounds(&model_matrices, &bone_radii)));
            }),
        ];
        bench.case(format!("{count} × 153"), (count, "instance"), 4 * words as u64, contenders)?;
    }
    Ok(())
}
