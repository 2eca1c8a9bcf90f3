//! Parity and benchmark cases of `kernels/skinning/pages.wgsl`.

use relievo::Error;
use relievo::ops::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::pages::reference::Pages;
use relievo::ops::skinning::pages::{NO_PAGE, PageBuffers, PagesPass};
use relievo::ops::skinning::vertex::Blend;

use crate::cases::animation::Draw;
use crate::cases::measure;
use crate::cases::skinning::{CROWDS, SHAPES, Scene, random_model, seen_of};
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases, compare};

/// A sequence of frames: name, and of 64 instances how many are seen.
const FRAMES: [(&str, u32); 7] = [
    ("the first", 30),
    ("others", 40),
    ("the same again", 0),
    ("few", 3),
    ("all in full", 64),
    ("none", 0),
    ("back", 50),
];

/// The cases cover instances that come and go, levels that become finer and coarser, no page to spare and not enough of
/// them, and numbers of instances around that of the lanes. Everything is compared to the bit: which page each cluster has,
/// how many each instance holds, what lies on the stack, and how many went short. Memory beyond must stay untouched.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = PagesPass::new(gpu)?;
    for (case, shape) in (0..).zip(SHAPES) {
        let model = random_model(case, shape)?;
        let (mesh, _) = MeshBuffers::new(gpu, &model, &model.meshes[0])?;
        let levels: Vec<u32> = mesh.levels.iter().map(|level| level.clusters).collect();
        let instances = [1, 63, 64, 65, 200][case as usize % 5];
        let crowd = SkinnedCrowd::new(gpu, &mesh, instances, Blend::Linear)?;
        let all = instances * mesh.clusters();
        // Every third case has too few.
        let pages = if case % 3 == 2 { all / 3 } else { all };
        let mut buffers = PageBuffers::new(gpu, &mesh, &crowd, pages as u32)?;
        let (table, held) = (Poisoned::new(gpu, all)?, Poisoned::new(gpu, instances)?);
        table.buffer.write(gpu, &vec![NO_PAGE; all])?;
        held.buffer.write(gpu, &vec![0; instances])?;
        (buffers.table, buffers.held) = (table.buffer.clone(), held.buffer.clone());
        let job = pass.prepare(gpu, &mesh, &crowd, &buffers)?;
        let mut reference = Pages::new(instances, mesh.clusters(), pages as u32);
        let mut draw = Draw::new(case ^ 0x9a9e);
        let mut lods = vec![InstanceLod::UNSEEN; instances];
        for (name, seen) in FRAMES {
            next(&mut lods, &mut draw, name, seen, levels.len() as u32);
            crowd.instance_lods.write(gpu, &lods)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            reference.deal(&lods, &levels);
            let name = format!("{} clusters × {instances}, {pages} pages, {name}", mesh.clusters());
            cases.exact(format!("{name}: pages"), &table, &reference.table).await?;
            cases.exact(format!("{name}: held"), &held, &reference.held).await?;
            let mut found = buffers.state.read(gpu).await?;
            let mut expected = vec![reference.free.len() as u32, reference.short];
            found.extend(&buffers.stack.read(gpu).await?[..reference.free.len()]);
            expected.extend(&reference.free);
            cases.add(format!("{name}: free"), compare::exact(&found, &expected));
        }
    }
    Ok(())
}

/// The levels of detail of the next frame.
fn next(lods: &mut [InstanceLod], draw: &mut Draw, name: &str, seen: u32, levels: u32) {
    for lod in lods.iter_mut() {
        match name {
            "the same again" => {}
            "all in full" => *lod = InstanceLod::FULL,
            _ if draw.word() % 64 < seen => {
                // Beyond the last level too.
                *lod = InstanceLod { mesh_lod: draw.word() % (levels + 2), ..InstanceLod::FULL };
            }
            _ => *lod = InstanceLod::UNSEEN,
        }
    }
}

/// Measures crowds in which nothing changes, as in most frames.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
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
        gpu.submit("first", |encoder| job.record(encoder))?;
        let levels: Vec<u32> = scene.mesh.levels.iter().map(|level| level.clusters).collect();
        let mut reference = Pages::new(instances, clusters, count);
        reference.deal(&lods, &levels);
        // The kernel reads an InstanceLod and what the instance holds.
        let case = format!("{instances} instances, unchanged");
        measure(bench, case, instances, "instance", 4 * instances, &|encoder| job.record(encoder), || {
            let mut pages = reference.clone();
            pages.deal(&lods, &levels);
            pages
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lod(mesh_lod: u32) -> InstanceLod {
        InstanceLod { mesh_lod, ..InstanceLod::FULL }
    }

    /// Known answers: pages stay where they are, and are dealt out from the top of the stack.
    #[test]
    fn pages_stay_while_they_are_needed() {
        let mut pages = Pages::new(3, 4, 9);
        let levels = [4, 2];
        pages.deal(&[lod(0), InstanceLod::UNSEEN, lod(1)], &levels);
        let none = NO_PAGE;
        assert_eq!(pages.table, [0, 1, 2, 3, none, none, none, none, 4, 5, none, none]);
        pages.deal(&[lod(1), lod(0), lod(1)], &levels);
        assert_eq!(pages.table, [0, 1, none, none, 2, 3, 6, 7, 4, 5, none, none]);
        assert_eq!((&pages.held[..], &pages.free[..], pages.short), (&[2, 4, 2][..], &[8][..], 0));
        pages.deal(&[lod(0), lod(0), lod(0)], &levels);
        assert_eq!(pages.table, [0, 1, 8, none, 2, 3, 6, 7, 4, 5, none, none]);
        assert_eq!((pages.free.len(), pages.short), (0, 2));
        pages.deal(&[InstanceLod::UNSEEN; 3], &levels);
        assert!(pages.table.iter().all(|page| *page == NO_PAGE) && pages.free.len() == 9);
    }
}
