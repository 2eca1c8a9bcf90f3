//! Benchmark cases of `terrain/border`: B's transition area.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_heights};
use crate::terrain::border::reference::border;
use crate::terrain::border::{BorderPass, neighbours};
use crate::terrain::fields::Fields;

/// Measures a grid of 8 × 8 patches. `copy` moves whole patches, though a kernel must only touch the strips along borders that
/// have a neighbour: a tenth of the samples here, in 15 dispatches, one after the other.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (size, width) = (257_u32, 16);
    let patches: Vec<_> = (0..64).map(|i| [i % 8, i / 8]).collect();
    let around = neighbours(&patches);
    let points = (size * size) as usize;
    let mut host = some_heights(points * patches.len());
    let fields = Fields { heights: Buffer::from_slice(gpu, "heights", &host)?, width: size, count: 64 };
    let job = BorderPass::new(gpu)?.prepare(gpu, width, &around, &[fields])?;
    let copied = copy_of(gpu, host.len())?;
    let (total, bytes) = (host.len(), 8 * host.len() as u64);
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            for (index, around) in around.iter().enumerate() {
                let (earlier, rest) = host.split_at_mut(index * points);
                let around = around.map(|at| at.map(|at| &earlier[at * points..(at + 1) * points]));
                border(&mut rest[..points], size as usize, width, around);
            }
        }),
    ];
    bench.case(format!("{size}x{size} batch 64, 16 samples"), (total, "point"), bytes, contenders)
}
