//! Benchmark cases of `kernels/lod/single.wgsl`.

use super::reference::{draws, entries};
use super::verify::Given;
use super::{SingleBuffers, SinglePass};
use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::lod::SceneDraw;
use crate::terrain::bench::copy_of;

/// Measures a thousand draws and a hundred thousand.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SinglePass::new(gpu)?;
    for count in [1_000, 100_000] {
        let given = Given::new(count);
        let buffers = SingleBuffers {
            singles: &Buffer::from_slice(gpu, "singles", &given.singles)?,
            decisions: &Buffer::from_slice(gpu, "decisions", &given.decisions)?,
            arguments: &Buffer::from_slice(gpu, "arguments", &given.arguments)?,
            draws: &Buffer::<SceneDraw>::new(gpu, "draws", count)?,
            entries: &Buffer::new(gpu, "entries", count)?,
        };
        let job = pass.prepare(gpu, buffers, count as u32)?;
        // Three words and a decision are read, a draw of five is read and written, and an entry written.
        let words = 15 * count;
        let copied = copy_of(gpu, words / 2)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                drop(std::hint::black_box(draws(&given.singles, &given.decisions, &given.arguments)));
                drop(std::hint::black_box(entries(&given.singles, &given.decisions)));
            }),
        ];
        bench.case(format!("{count} draws"), (count, "draw"), 4 * words as u64, contenders)?;
    }
    Ok(())
}
