//! Parity and benchmark cases of `kernels/baseline/words.wgsl`, and with it of the hash.

use relievo::Error;
use relievo::gpu::Buffer;

use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::baseline::words::WordsPass;
use crate::baseline::words::reference::words;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover sizes around workgroup boundaries, and keys of all kinds.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = WordsPass::new(gpu)?;
    let keys = [[0, 0], [u32::MAX; 2], [0x1319_8a2e, 0x0370_7344]];
    for (key, [width, rows]) in
        keys.into_iter().cycle().zip([[4, 1], [252, 1], [256, 3], [260, 7], [1024, 65], [64, 5000]])
    {
        let output = Poisoned::new(gpu, (width * rows) as usize)?;
        let job = pass.prepare(gpu, key, [width, rows], &output.buffer)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let expected = words(key, width, rows);
        let name = format!("{width} × {rows} words, key {key:x?}");
        cases.add(name, output.check(gpu, |actual| exact(actual, &expected)).await?);
    }
    Ok(())
}

/// Measures one size of output.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
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
    bench.case(format!("{} × {}", size[0], size[1]), count, "word", 4 * count as u64, contenders)
}
