//! Benchmark cases of `kernels/lod/list.wgsl`.

use crate::Error;
use crate::animation::verify::Draw;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::lod::list::reference::lists;
use crate::lod::list::{ListBuffers, ListPass};
use crate::lod::select::reference::counts;
use crate::lod::verify::Blocks;
use crate::lod::{BLOCK, OBJECT_LISTS};
use crate::terrain::bench::copy_of;

/// Measures one object of which a third is seen in lists of all levels, and a hundred of them.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = ListPass::new(gpu)?;
    for (name, sizes) in [("1 object", vec![16]), ("1 object", vec![1_600]), ("100 objects", vec![16; 100])] {
        let blocks = Blocks::new(0, &sizes);
        let all = blocks.block_objects.len();
        let count = BLOCK as usize * all;
        let mut draw = Draw::new(1);
        let decision = |_| (draw.word() % (3 * OBJECT_LISTS)).saturating_sub(2 * OBJECT_LISTS - 1);
        let decisions: Vec<u32> = (0..count).map(decision).collect();
        let fresh = Buffer::from_slice(gpu, "fresh counts", &counts(&decisions))?;
        let sums = Buffer::new(gpu, "counts", OBJECT_LISTS as usize * all)?;
        let buffers = ListBuffers {
            objects: &Buffer::from_slice(gpu, "objects", &blocks.objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &blocks.block_objects)?,
            decisions: &Buffer::from_slice(gpu, "decisions", &decisions)?,
            counts: &sums,
            lists: &Buffer::new(gpu, "lists", blocks.list_words())?,
            arguments: &Buffer::new(gpu, "arguments", blocks.draws())?,
        };
        let job = pass.prepare(gpu, buffers, blocks.objects.len() as u32, all as u32)?;
        let seen = decisions.iter().filter(|decision| **decision > 0).count();
        // The kernel reads the counts twice and writes them, reads the decisions, and writes an index of each that is seen.
        // It overwrites the counts, so they are copied anew each time, and that is a part of its time.
        let words = 5 * OBJECT_LISTS as usize * all + count + seen;
        let copied = copy_of(gpu, words / 2)?;
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| {
                encoder.copy_buffer_to_buffer(fresh.raw(), 0, sums.raw(), 0, fresh.bytes());
                job.record(encoder);
            }),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let all = blocks.objects.iter().map(|object| lists(object, &decisions));
                drop(std::hint::black_box(all.collect::<Vec<_>>()));
            }),
        ];
        bench.case(
            format!("{count} instances, {name}"),
            (count, "instance"),
            4 * words as u64,
            contenders,
        )?;
    }
    Ok(())
}
