//! Benchmark cases of `skinning/select`: selection of clusters.

use crate::Error;
use crate::harness::{Backend, Bench, Contender};
use crate::skinning::bench::{CROWDS, Scene, seen_of};
use crate::skinning::buffers::ActiveClusters;
use crate::skinning::select::reference::{Now, Skinned, select};
use crate::skinning::select::{SKINNED_WORDS, SelectBuffers, SelectPass};
use crate::terrain::bench::copy_of;

/// Measures crowds in which one bone in eight is updated, with all instances seen or a quarter of them.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SelectPass::new(gpu)?;
    for (instances, seen) in CROWDS.map(|count| (count, 1)).into_iter().chain([(CROWDS[2], 4)]) {
        let scene = Scene::new(gpu, 4, 0, instances)?;
        let buffers = SelectBuffers::new(gpu, &scene.mesh, &scene.crowd)?;
        let active = ActiveClusters::new(gpu, &scene.mesh, &scene.crowd)?;
        let updated_bones = vec![0x0101_0101; instances * scene.mesh.mask_words];
        buffers.updated_bones.write(gpu, &updated_bones)?;
        let instance_lods = seen_of(instances, seen);
        scene.crowd.instance_lods.write(gpu, &instance_lods)?;
        let job = pass.prepare(gpu, &scene.mesh, &scene.crowd, &buffers, &active)?;
        let pairs = scene.clusters.len() * instances;
        let last: Vec<Skinned> =
            instance_lods.iter().map(|now| Skinned { instance_lod: *now, ..Skinned::nothing(0) }).collect();
        let words = scene.mesh.mask_words;
        // The kernel reads an InstanceLod and the remembered state and, for instances that are seen, a mask and
        // a set of bones.
        let read = 2 + SKINNED_WORDS + 2 * words / seen;
        let copied = copy_of(gpu, read * pairs / 2)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let now = Now { updated_bones: &updated_bones, instance_lods: &instance_lods, weights: &[] };
                drop(std::hint::black_box(select(&scene.clusters, &now, &last)));
            }),
        ];
        let name = if seen == 1 { "" } else { ", a quarter seen" };
        let case = format!("157 clusters × {instances}{name}");
        bench.case(case, (pairs, "cluster"), 4 * (read * pairs) as u64, contenders)?;
    }
    Ok(())
}
