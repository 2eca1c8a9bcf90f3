//! Benchmark cases of `skinning/morph`: morph targets of crowds.

use crate::Error;
use crate::harness::{Backend, Bench, Contender};
use crate::skinning::bench::{RING, Scene};
use crate::skinning::morph::MorphPass;
use crate::skinning::morph::reference::morph;
use crate::terrain::bench::copy_of;

/// Measures four targets that move a quarter of the vertices.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = MorphPass::new(gpu)?;
    for instances in [1, 100] {
        let scene = Scene::new(gpu, 1, 4, instances)?;
        scene.crowd.weights.write(gpu, &vec![0.5; 4 * instances])?;
        let job = pass.prepare(gpu, &scene.mesh, &scene.crowd)?;
        let all = RING * RING * instances;
        // The kernel reads a vertex, two offsets, a delta of 12 words and its weight, and writes a vertex.
        let words = 10 + 2 + 13 + 10;
        let copied = copy_of(gpu, words * all / 2)?;
        let reference = || {
            for _ in 0..instances {
                drop(std::hint::black_box(morph(&scene.model.meshes[0], &[0.5; 4])));
            }
        };
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, reference),
        ];
        bench.case(
            format!("4 targets, 10k × {instances}"),
            (all, "vertex"),
            (4 * words * all) as u64,
            contenders,
        )?;
    }
    Ok(())
}
