//! Parity cases of `kernels/baseline/words.wgsl`, and with it of the hash.

use crate::Error;
use crate::baseline::words::WordsPass;
use crate::baseline::words::reference::words;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;

/// The cases cover sizes around workgroup boundaries, and keys of all kinds.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = WordsPass::new(gpu)?;
    let keys = [[0, 0], [u32::MAX; 2], [0x1319_8a2e, 0x0370_7344]];
    for (key, [width, rows]) in
        keys.into_iter().cycle().zip([[4, 1], [252, 1], [256, 3], [260, 7], [1024, 65], [64, 5000]])
    {
        let output = Poisoned::new(gpu, (width * rows) as usize)?;
        let job = pass.prepare(gpu, key, [width, rows], &output.buffer)?;
        gpu.run("verify", |encoder| job.record(encoder))?;
        let expected = words(key, width, rows);
        let name = format!("{width} × {rows} words, key {key:x?}");
        cases.add(name, output.check(gpu, |actual| exact(actual, &expected))?);
    }
    Ok(())
}
