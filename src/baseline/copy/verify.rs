//! Parity cases of `kernels/baseline/copy.wgsl`.

use crate::Error;
use crate::baseline::copy::reference::copy;
use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::baseline::words::reference::words;
use crate::gpu::Buffer;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;

/// The cases cover lengths around workgroup boundaries.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = CopyPass::new(gpu)?;
    for len in [4, 8, 252, 256, 260, 65_536, 1_000_004] {
        let data = words([1, 2], len, 1);
        let source = Buffer::from_slice(gpu, "source", &data)?;
        let output = Poisoned::new(gpu, data.len())?;
        let buffers = CopyBuffers { source: &source, destination: &output.buffer };
        let job = pass.prepare(gpu, data.len(), buffers)?;
        gpu.run("verify", |encoder| job.record(encoder))?;
        let mut expected = vec![0; data.len()];
        copy(&data, &mut expected);
        cases.add(format!("{len} words"), output.check(gpu, |actual| exact(actual, &expected))?);
    }
    Ok(())
}
