//! Benchmark cases of `skinning/palette`: palettes of crowds.

use crate::Error;
use crate::animation::ModelMatrices;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::skinning::bench::{BONES, CROWDS, Scene};
use crate::skinning::palette::PalettePass;
use crate::skinning::palette::reference::palette;
use crate::skinning::verify::random_matrices;
use crate::terrain::bench::copy_of;

/// Measures palettes for linear blending.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = PalettePass::new(gpu)?;
    for instances in CROWDS {
        let scene = Scene::new(gpu, 1, 0, instances)?;
        let matrices = random_matrices(1, 2 * BONES, instances);
        let model_matrices = ModelMatrices::new(&Buffer::from_slice(gpu, "model matrices", &matrices)?);
        let job = pass.prepare(gpu, &scene.mesh, &model_matrices, &scene.crowd)?;
        let pairs = BONES * instances;
        // The kernel reads two matrices and an index, and writes a matrix.
        let copied = copy_of(gpu, 37 * pairs / 2)?;
        let reference = || {
            for model_matrices in matrices.chunks(2 * BONES) {
                drop(std::hint::black_box(palette(&scene.model.skins[0], model_matrices)));
            }
        };
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, reference),
        ];
        bench.case(
            format!("{BONES} bones × {instances}"),
            (pairs, "bone"),
            148 * pairs as u64,
            contenders,
        )?;
    }
    Ok(())
}
