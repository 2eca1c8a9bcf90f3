//! Benchmark cases of `kernels/lod/select.wgsl`.

use crate::Error;
use crate::gpu::{Buffer, Uniform};
use crate::harness::{Backend, Bench, Contender};
use crate::lod::select::reference::select;
use crate::lod::select::{SelectBuffers, SelectPass};
use crate::lod::verify::{Blocks, frame, random_instances};
use crate::lod::{OBJECT_LISTS, SelectView};
use crate::terrain::bench::copy_of;

/// Measures scenes of one object, seen by a perspective.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SelectPass::new(gpu)?;
    let [(_, view), ..] = frame()?;
    for blocks in [16, 1_600] {
        let Blocks { objects, block_objects } = Blocks::new(0, &[blocks - 1]);
        let view = SelectView { blocks, ..view };
        let count = 64 * blocks as usize;
        let instances: Vec<_> = random_instances(1, 1024).into_iter().cycle().take(count).collect();
        let decisions = Buffer::new(gpu, "decisions", count)?;
        let buffers = SelectBuffers {
            view: &Uniform::new(gpu, "view", &view)?,
            objects: &Buffer::from_slice(gpu, "objects", &objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &block_objects)?,
            instances: &Buffer::from_slice(gpu, "instances", &instances)?,
            allowed: &Buffer::new(gpu, "allowed", count)?,
            decisions: &decisions,
            rows: &Buffer::new(gpu, "rows", 3 * count)?,
            counts: &Buffer::new(gpu, "counts", (OBJECT_LISTS * blocks) as usize)?,
        };
        let job = pass.prepare(gpu, buffers)?;
        gpu.run("bench", |encoder| job.record(encoder))?;
        let seen = decisions.read_blocking(gpu)?.iter().filter(|decision| **decision > 0).count();
        // The kernel reads 18 of an instance's words and writes two, and the rows of those that are seen.
        let words = 20 * count + 12 * seen;
        let copied = copy_of(gpu, words / 2)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let selected = instances.iter().map(|instance| select(&view, &objects[0], instance));
                drop(std::hint::black_box(selected.collect::<Vec<_>>()));
            }),
        ];
        let case = format!("{count} instances, {seen} seen");
        bench.case(case, (count, "instance"), 4 * words as u64, contenders)?;
    }
    Ok(())
}
