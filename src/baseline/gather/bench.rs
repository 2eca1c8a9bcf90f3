//! Benchmark cases of `baseline/gather`: the time in which the bytes of sampling can be moved. `copy` moves the
//! same number of bytes, with each read and written once.

use std::hint::black_box;

use crate::Error;
use crate::animation::bench::{KEYS, Scene};
use crate::baseline::gather::Reads;
use crate::baseline::gather::reference::{gather, gather_keys};
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;

/// Measures 1000 instances of 153 bones and 60 keys, twice: with all that sampling reads, and with the keys
/// alone.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, 1000)?;
    let pairs = scene.pairs();
    let copied = copy_of(gpu, 16 * pairs)?;
    let (job, keys) =
        (scene.gathered(gpu, Reads::Everything)?, scene.gathered(gpu, Reads::Keys(KEYS as u32))?);
    let mut gathered = vec![[[0; 4]; 3]; pairs];
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            gather(&scene.set, &scene.instances, &scene.cursors, black_box(&mut gathered));
        }),
    ];
    bench.case("1000 × 153, 60 keys", (pairs, "bone"), 128 * pairs as u64, contenders)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &keys),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            gather_keys(&scene.set, KEYS as u32, &scene.cursors, black_box(&mut gathered));
        }),
    ];
    bench.case("1000 × 153, keys alone", (pairs, "bone"), 128 * pairs as u64, contenders)
}
