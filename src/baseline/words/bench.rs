//! Benchmark cases of `baseline/words`: how fast random words are drawn and stored.

use crate::Error;
use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::baseline::words::WordsPass;
use crate::baseline::words::reference::words;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};

/// Measures one size of output.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let size = [1024_u32, 4096];
    let count = (size[0] * size[1]) as usize;
    let (source, output) = (Buffer::new(gpu, "source", count)?, Buffer::new(gpu, "words", count)?);
    let job = WordsPass::new(gpu)?.prepare(gpu, [1, 2], size, &output)?;
    let buffers = CopyBuffers { source: &source, destination: &output };
    let copied = CopyPass::new(gpu)?.prepare(gpu, count, buffers)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || drop(std::hint::black_box(words([1, 2], size[0], size[1])))),
    ];
    bench.case(format!("{} × {}", size[0], size[1]), (count, "word"), 4 * count as u64, contenders)
}
