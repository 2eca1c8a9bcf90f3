//! Benchmark cases of `skinning/pages`: dealing out pages.

use crate::Error;
use crate::harness::{Backend, Bench, Contender};
use crate::skinning::bench::{CROWDS, Scene, seen_of};
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::pages::reference::Pages;
use crate::skinning::pages::{PageBuffers, PagesPass};
use crate::terrain::bench::copy_of;

/// Measures crowds in which nothing changes, as in most frames.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = PagesPass::new(gpu)?;
    // Pages for half of the largest crowd exceed a binding.
    for instances in &CROWDS[..2] {
        let instances = *instances;
        let scene = Scene::new(gpu, 4, 0, instances)?;
        let lods: Vec<InstanceLod> = seen_of(instances, 2);
        scene.crowd.instance_lods.write(gpu, &lods)?;
        let clusters = scene.mesh.clusters();
        let count = (instances * clusters / 2) as u32 + clusters as u32;
        let pages = PageBuffers::new(gpu, &scene.mesh, &scene.crowd, count)?;
        let job = pass.prepare(gpu, &scene.mesh, &scene.crowd, &pages)?;
        gpu.run("first", |encoder| job.record(encoder))?;
        let levels: Vec<u32> = scene.mesh.levels.iter().map(|level| level.clusters).collect();
        let mut reference = Pages::new(instances, clusters, count);
        reference.deal(&lods, &levels);
        // The kernel reads an InstanceLod and what the instance holds.
        let copied = copy_of(gpu, 2 * instances)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let mut pages = reference.clone();
                pages.deal(&lods, &levels);
                drop(std::hint::black_box(pages));
            }),
        ];
        let case = format!("{instances} instances, unchanged");
        bench.case(case, (instances, "instance"), 16 * instances as u64, contenders)?;
    }
    Ok(())
}
