//! Benchmark cases of `baseline/copy`: the copy kernel against `limit`, the device's own
//! `copy_buffer_to_buffer`.

use crate::Error;
use crate::baseline::copy::reference::copy;
use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};

/// Measures sizes from within the caches to beyond them.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = CopyPass::new(gpu)?;
    for mebibytes in [1, 16, 64, 128] {
        let words = mebibytes << 18;
        let (source, destination) =
            (Buffer::new(gpu, "source", words)?, Buffer::new(gpu, "destination", words)?);
        let job = pass.prepare(gpu, words, CopyBuffers { source: &source, destination: &destination })?;
        let (from, mut to) = (vec![1_u32; words], vec![0_u32; words]);
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::recorded(Backend::Limit, |encoder| {
                encoder.copy_buffer_to_buffer(source.raw(), 0, destination.raw(), 0, 4 * words as u64);
            }),
            Contender::host(Backend::Reference, || {
                copy(std::hint::black_box(&from), std::hint::black_box(&mut to))
            }),
        ];
        bench.case(format!("{mebibytes} MiB"), (words, "word"), 8 * words as u64, contenders)?;
    }
    Ok(())
}
