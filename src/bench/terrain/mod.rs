//! Benchmarks of `kernels/terrain/`.

pub mod blend;
pub mod border;
pub mod despike;
pub mod height;
pub mod morph;
pub mod normals;
pub mod pad;
pub mod thermal;
pub mod wrap;

use crate::Error;
use crate::baseline::copy::CopyPass;
use crate::gpu::{Buffer, Gpu, Job};
use crate::verify::terrain::random_heights;

/// A copy of `words` words, rounded up to a vector, as a baseline.
pub(in crate::bench) fn copy_of(gpu: &Gpu, words: usize) -> Result<Job, Error> {
    let words = words.next_multiple_of(4);
    let (source, destination) =
        (Buffer::new(gpu, "copy source", words)?, Buffer::new(gpu, "copy destination", words)?);
    CopyPass::new(gpu)?.prepare(gpu, words, &source, &destination)
}

/// Plausible heights of a batch.
fn some_heights(points: usize) -> Vec<i32> {
    // A pattern is repeated: drawing millions of heights one by one takes longer than the benchmark.
    let pattern = random_heights(1, 4096, 1 << 22);
    pattern.into_iter().cycle().take(points).collect()
}
