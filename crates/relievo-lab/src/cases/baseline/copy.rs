//! Parity and benchmark cases of `kernels/baseline/copy.wgsl`.
//!
//! In the benchmark, `limit` is the device's own `copy_buffer_to_buffer`.

use relievo::Error;
use relievo::gpu::Buffer;

use crate::baseline::copy::reference::copy;
use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::baseline::words::reference::words;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover lengths around workgroup boundaries.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = CopyPass::new(gpu)?;
    for len in [4, 8, 252, 256, 260, 65_536, 1_000_004] {
        let data = words([1, 2], len, 1);
        let source = Buffer::from_slice(gpu, "source", &data)?;
        let output = Poisoned::new(gpu, data.len())?;
        let buffers = CopyBuffers { source: &source, destination: &output.buffer };
        let job = pass.prepare(gpu, data.len(), buffers)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let mut expected = vec![0; data.len()];
        copy(&data, &mut expected);
        cases.add(format!("{len} words"), output.check(gpu, |actual| exact(actual, &expected)).await?);
    }
    Ok(())
}

/// Measures sizes from within the caches to beyond them.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
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
        bench.case(format!("{mebibytes} MiB"), words, "word", 8 * words as u64, contenders)?;
    }
    Ok(())
}
