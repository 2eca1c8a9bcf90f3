//! Selection of clusters.

use super::{CROWDS, Scene};
use crate::Error;
use crate::bench::terrain::copy_of;
use crate::bench::{Backend, Bench, Contender};
use crate::reference::skinning::select::select;
use crate::skinning::buffers::ActiveClusters;
use crate::skinning::select::{SelectBuffers, SelectPass};
use crate::skinning::weights::Reduction;

/// One bone in eight moves.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SelectPass::new(gpu)?;
    for instances in CROWDS {
        let scene = Scene::new(gpu, 4, 0, instances)?;
        let buffers = SelectBuffers::new(gpu, &scene.mesh, &scene.crowd)?;
        let active = ActiveClusters::new(gpu, &scene.mesh, &scene.crowd)?;
        let moved = vec![0x0101_0101; instances * scene.mesh.mask_words];
        buffers.moved.write(gpu, &moved)?;
        let job = pass.prepare(gpu, &scene.mesh, &scene.crowd, &buffers, &active)?;
        let pairs = scene.clusters.len() * instances;
        let full = vec![Reduction::FULL; instances];
        let words = scene.mesh.mask_words;
        // A mask and a set of bones in, and two reductions.
        let copied = copy_of(gpu, (2 * words + 4) * pairs / 2)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Twin, || {
                drop(std::hint::black_box(select(&scene.clusters, &moved, &full, &full)));
            }),
        ];
        let bytes = (8 * words + 16) as u64 * pairs as u64;
        bench.case(format!("157 clusters × {instances}"), (pairs, "cluster"), bytes, contenders)?;
    }
    Ok(())
}
