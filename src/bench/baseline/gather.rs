//! How fast the bytes of sampling can be moved; `copy` moves as many, each its own.

use crate::Error;
use crate::bench::animation::{KEYS, Scene};
use crate::bench::terrain::copy_of;
use crate::bench::{Backend, Bench, Contender};
use crate::reference::baseline::gather::gather;

/// 1000 instances of 153 bones, 60 keys.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, 1000)?;
    let (pairs, sizes) = (scene.pairs(), [scene.set.bones(), KEYS]);
    let job = scene.gathered(gpu)?;
    let copied = copy_of(gpu, 16 * pairs)?;
    let values: &[[u32; 4]] = bytemuck::cast_slice(scene.set.values());
    let mut gathered = vec![[[0; 4]; 3]; pairs];
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Twin, || {
            gather(sizes, &scene.places, values, std::hint::black_box(&mut gathered))
        }),
    ];
    bench.case("1000 × 153, 60 keys", (pairs, "bone"), 128 * pairs as u64, contenders)
}
