//! Parity and benchmark cases of `kernels/baseline/gather.wgsl`.
//!
//! The benchmark says how fast the bytes of sampling can be moved. `copy` moves the same number of bytes, with each read and
//! written once.

use std::hint::black_box;

use relievo::Error;
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::keyframe::KeyframeCursor;
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd, Local};
use relievo::ops::animation::instance::{Instance, Wrap};

use crate::baseline::gather::reference::{gather, gather_keys};
use crate::baseline::gather::{GatherPass, Reads};
use crate::cases::animation::scene::{KEYS, Scene};
use crate::cases::animation::{Draw, SIZES, random_skeleton};
use crate::cases::terrain::copy_of;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover numbers of bones and instances around workgroup boundaries, few keys and many, two clips,
/// and the keys of the first clip alone.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    for (case, ([bones, count], keys)) in SIZES.into_iter().zip([2, 3, 60].into_iter().cycle()).enumerate() {
        let mut draw = Draw::new(case as u32);
        let set = evenly_keyed(&mut draw, bones, keys)?;
        let mut cursor = || KeyframeCursor { key: draw.word() % (keys - 1), fraction: draw.signed().abs() };
        let cursors: Vec<KeyframeCursor> = (0..count).map(|_| cursor()).collect();
        let instances: Vec<_> =
            (0..count as u32).map(|i| Instance::new(i % 2, Wrap::Loop, 0.0, 1.0)).collect();
        let clips = ClipBuffers::new(gpu, &set)?;
        for reads in [Reads::Everything, Reads::Keys(keys)] {
            let mut crowd = Crowd::new(gpu, &set, &instances)?;
            crowd.cursors.write(gpu, &cursors)?;
            let output = Poisoned::<Local>::new(gpu, bones * count)?;
            crowd.locals = output.buffer.clone();
            let job = GatherPass::new(gpu, reads)?.prepare(gpu, &clips, &crowd)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let mut expected = vec![[[0; 4]; 3]; bones * count];
            match reads {
                Reads::Everything => gather(&set, &instances, &cursors, &mut expected),
                Reads::Keys(keys) => gather_keys(&set, keys, &cursors, &mut expected),
            }
            let comparison = output
                .check(gpu, |actual| {
                    exact(bytemuck::cast_slice::<_, u32>(actual), expected.as_flattened().as_flattened())
                })
                .await?;
            cases.add(format!("{bones} bones × {count}, {keys} keys, {reads:?}"), comparison);
        }
    }
    Ok(())
}

/// Two clips that have the same number of linear keys on every track, all at the same times.
///
/// # Errors
/// None in practice: the clips are valid.
pub(crate) fn evenly_keyed(draw: &mut Draw, bones: usize, keys: u32) -> Result<ClipSet, Error> {
    let skeleton = random_skeleton(0, bones)?;
    let mut track = || {
        let values = (0..keys).map(|_| draw.rotation()).collect();
        let times = (0..keys).map(|key| key as f32).collect();
        Some(Keys { times, values, interpolation: Interpolation::Linear })
    };
    let mut clip = |name| {
        let bone = |_| BoneKeys { translation: track(), rotation: track(), scale: track() };
        Clip::new(name, &skeleton, &(0..bones).map(bone).collect::<Vec<_>>(), 0.0)
    };
    Ok(ClipSet::new(&[&clip("first")?, &clip("second")?])?)
}

/// Measures 1000 instances of 153 bones and 60 keys, twice: with all that sampling reads, and with the keys
/// alone.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
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
    bench.case("1000 × 153, 60 keys", pairs, "bone", 128 * pairs as u64, contenders)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &keys),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            gather_keys(&scene.set, KEYS as u32, &scene.cursors, black_box(&mut gathered));
        }),
    ];
    bench.case("1000 × 153, keys alone", pairs, "bone", 128 * pairs as u64, contenders)
}
