//! Parity cases of `kernels/baseline/gather.wgsl`.

use crate::Error;
use crate::animation::clip_set::ClipSet;
use crate::animation::crowd::{ClipBuffers, Crowd, Local};
use crate::animation::instance::Instance;
use crate::animation::instance::Wrap;
use crate::animation::verify::{Draw, SIZES, random_skeleton};
use crate::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use crate::asset::keyframe::KeyframeCursor;
use crate::baseline::gather::reference::{gather, gather_keys};
use crate::baseline::gather::{GatherPass, Reads};
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;

/// The cases cover numbers of bones and instances around workgroup boundaries, few keys and many, two clips,
/// and the keys of the first clip alone.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
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
            gpu.run("verify", |encoder| job.record(encoder))?;
            let mut expected = vec![[[0; 4]; 3]; bones * count];
            match reads {
                Reads::Everything => gather(&set, &instances, &cursors, &mut expected),
                Reads::Keys(keys) => gather_keys(&set, keys, &cursors, &mut expected),
            }
            let comparison = output.check(gpu, |actual| {
                exact(bytemuck::cast_slice::<_, u32>(actual), expected.as_flattened().as_flattened())
            })?;
            cases.add(format!("{bones} bones × {count}, {keys} keys, {reads:?}"), comparison);
        }
    }
    Ok(())
}

/// Two clips that have the same number of linear keys on every track, all at the same times.
///
/// # Errors
/// None in practice: the clips are valid.
pub fn evenly_keyed(draw: &mut Draw, bones: usize, keys: u32) -> Result<ClipSet, Error> {
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
