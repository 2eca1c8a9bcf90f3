//! Parity of `kernels/animation/concat.wgsl`.

use super::{Draw, SIZES, random_crowd};
use crate::Error;
use crate::animation::concat::{CONCAT_BOUND, ConcatPass, Walk};
use crate::animation::crowd::{Crowd, packed};
use crate::animation::skeleton::Skeleton;
use crate::animation::transform::{Affine, Transform};
use crate::reference::animation::concat::concat;
use crate::verify::poison::Poisoned;
use crate::verify::{Cases, compare};

/// Random skeletons of every size and shape, mirrored and uneven scales; a chain and a star.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (skeleton, ..) = random_crowd(case as u32, bones, 1)?;
        add(cases, case as u32, "random", &skeleton, count)?;
    }
    for (name, straight) in [("chain", true), ("star", false)] {
        let (random, ..) = random_crowd(99, 200, 1)?;
        let mut bones = random.bones().to_vec();
        for (index, bone) in (0..).zip(&mut bones) {
            bone.parent = if straight { u32::checked_sub(index, 1) } else { (index > 0).then_some(0) };
        }
        add(cases, 99, name, &Skeleton::of_joints(bones)?, 5)?;
    }
    Ok(())
}

fn add(cases: &mut Cases<'_>, case: u32, name: &str, skeleton: &Skeleton, count: usize) -> Result<(), Error> {
    let gpu = cases.gpu;
    let bones = skeleton.len();
    let (_, set, instances) = random_crowd(case, bones, count)?;
    let mut crowd = Crowd::new(gpu, &set, &instances)?;
    let locals = random_locals(case, bones * count)?;
    crowd.locals.write(gpu, &locals.iter().map(packed).collect::<Vec<_>>())?;
    let expected: Vec<Affine> = locals.chunks(bones).flat_map(|locals| concat(skeleton, locals)).collect();
    let flat = |models: &[Affine]| models.as_flattened().as_flattened().to_vec();
    let largest = flat(&expected).iter().fold(1.0, |a: f32, b| a.max(b.abs()));
    let deepest = skeleton.depths().iter().max().map_or(1, |depth| depth + 1);
    let bound = CONCAT_BOUND * deepest as f32 * largest;
    for walk in [Walk::Levels, Walk::Whole] {
        let output = Poisoned::<Affine>::new(gpu, bones * count)?;
        crowd.models = output.buffer.clone();
        let job = ConcatPass::new(gpu, walk)?.prepare(gpu, skeleton, &crowd)?;
        gpu.run("verify", |encoder| job.record(encoder))?;
        let comparison =
            output.check(gpu, |actual| compare::absolute(&flat(actual), &flat(&expected), bound))?;
        cases.add(format!("{name}, {bones} bones × {count}, {walk:?}"), comparison);
    }
    Ok(())
}

/// Scales near 1, so that long chains stay in range.
fn random_locals(case: u32, count: usize) -> Result<Vec<Transform>, Error> {
    let mut draw = Draw::new(case ^ 0x10ca);
    let mut local = || {
        let translation = [0; 3].map(|_| draw.signed());
        let mut scale = [0; 3].map(|_| 1.0 + 0.02 * draw.signed());
        scale[0] *= if draw.word().is_multiple_of(8) { -1.0 } else { 1.0 };
        Transform { translation, rotation: draw.rotation(), scale }.checked("local")
    };
    Ok((0..count).map(|_| local()).collect::<Result<Vec<_>, _>>()?)
}
