//! Benchmarks of `kernels/terrain/`.

use crate::Error;
use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::gpu::{Buffer, Gpu, Job};
use crate::terrain::fields::Fields;
use crate::terrain::verify::random_heights;

/// The device's own copy of `words` words, rounded up to a multiple of four, as a baseline.
pub(crate) fn copy_of(gpu: &Gpu, words: usize) -> Result<Job, Error> {
    let words = words.next_multiple_of(4);
    let (source, destination) =
        (Buffer::new(gpu, "copy source", words)?, Buffer::new(gpu, "copy destination", words)?);
    CopyPass::new(gpu)?.prepare(gpu, words, CopyBuffers { source: &source, destination: &destination })
}

/// Plausible random heights for a batch of `points` samples, in 1/65536 units.
pub(crate) fn some_heights(points: usize) -> Vec<i32> {
    // A pattern of 4096 heights is repeated: drawing millions of heights one by one takes longer than the
    // benchmark.
    let pattern = random_heights(1, 4096, 1 << 22);
    pattern.into_iter().cycle().take(points).collect()
}

/// Plausible windows of `width`² samples, on the host and on the device.
pub(crate) fn some_windows(gpu: &Gpu, width: u32, count: u32) -> Result<(Vec<i32>, Fields), Error> {
    let host = some_heights((width * width * count) as usize);
    let windows = Fields::new(gpu, "windows", width, count)?;
    windows.heights.write(gpu, &host)?;
    Ok((host, windows))
}
