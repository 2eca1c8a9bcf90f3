//! Parity and benchmark cases of `kernels/terrain/morph.wgsl`.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::terrain::morph::reference::morph;
use relievo::ops::terrain::morph::{HeightMorphPass, Morph, MorphBuffers};

use crate::cases::terrain::{LIMIT, check_exact, measure, random_heights, some_heights};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases};

/// The cases cover both ends and times between, lengths around workgroup boundaries, heights at the limit.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = HeightMorphPass::new(gpu)?;
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
            heights.write(gpu, &vec![POISON as i32; from.len()])?;
            gpu.submit("verify", |encoder| {
                job.record(encoder);
                encoder.copy_buffer_to_buffer(heights.raw(), 0, output.buffer.raw(), 0, 4 * u64::from(len));
            })?;
            let expected = morph(&from, &to, params.fixed_time());
            check_exact(cases, format!("{len} heights at {time}"), &output, &expected).await?;
        }
    }
    Ok(())
}

/// Measures as many points as a batch of 64 patches of 257² has: the kernel reads two words and writes one per point.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let points = 64 * 257 * 257;
    let (from, to) = (some_heights(points), some_heights(points));
    let buffers = [Buffer::from_slice(gpu, "from", &from)?, Buffer::from_slice(gpu, "to", &to)?];
    let heights = Buffer::new(gpu, "heights", points)?;
    let buffers = MorphBuffers { from: &buffers[0], to: &buffers[1], heights: &heights };
    let job = HeightMorphPass::new(gpu)?.prepare(gpu, buffers)?;
    let params = Morph { time: 0.3 };
    job.set(gpu, params)?;
    measure(
        bench,
        "257x257 batch 64",
        points,
        12,
        |encoder| job.record(encoder),
        || {
            drop(std::hint::black_box(morph(&from, &to, params.fixed_time())));
        },
    )
}
