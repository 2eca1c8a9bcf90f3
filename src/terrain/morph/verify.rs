//! Parity cases of `kernels/terrain/morph.wgsl`.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::terrain::morph::reference::morph;
use crate::terrain::morph::{Morph, MorphBuffers, MorphPass};
use crate::terrain::verify::{LIMIT, random_heights};

/// The cases cover both ends and times between, lengths around workgroup boundaries, heights at the limit.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = MorphPass::new(gpu)?;
    for len in [1, 63, 64, 65, 5000, 300_000] {
        let (from, to) =
            (random_heights(len, len as usize, LIMIT), random_heights(len + 1, len as usize, LIMIT));
        let buffers = [Buffer::from_slice(gpu, "from", &from)?, Buffer::from_slice(gpu, "to", &to)?];
        for time in [0.0, 1.0 / 65_536.0, 0.25, 0.7, 1.0] {
            let output = Poisoned::new(gpu, from.len())?;
            let heights = Buffer::new(gpu, "heights", from.len())?;
            let job =
                pass.prepare(gpu, MorphBuffers { from: &buffers[0], to: &buffers[1], heights: &heights })?;
            let params = Morph { time };
            job.set(gpu, params)?;
            heights.write(gpu, &vec![crate::harness::poison::POISON as i32; from.len()])?;
            gpu.run("verify", |encoder| {
                job.record(encoder);
                encoder.copy_buffer_to_buffer(heights.raw(), 0, output.buffer.raw(), 0, 4 * u64::from(len));
            })?;
            let expected = morph(&from, &to, params.fixed_time());
            cases.add(
                format!("{len} heights at {time}"),
                output.check(gpu, |actual| exact(actual, &expected))?,
            );
        }
    }
    Ok(())
}
