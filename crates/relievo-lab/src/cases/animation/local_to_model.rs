//! Parity and benchmark cases of `kernels/animation/local_to_model.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::skeleton::Skeleton;
use relievo::asset::transform::{AFFINE_IDENTITY, Affine, Transform};
use relievo::ops::animation::active::Active;
use relievo::ops::animation::compact::CompactPass;
use relievo::ops::animation::compact::reference::compact;
use relievo::ops::animation::crowd::{Crowd, packed};
use relievo::ops::animation::gate::reference::ChosenBones;
use relievo::ops::animation::local_to_model::reference::{
    local_to_model, local_to_model_into, local_to_model_updated,
};
use relievo::ops::animation::local_to_model::{LOCAL_TO_MODEL_BOUND, LocalToModelPass};
use relievo::ops::animation::model_matrices::ModelMatrices;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::sample::reference::sample_set;

use crate::cases::animation::frame::{DeviceFrame, PlainFrame, ReferenceFrame};
#[cfg(not(target_arch = "wasm32"))]
use crate::cases::animation::host;
use crate::cases::animation::plain_soa::PlainSoa;
use crate::cases::animation::scene::{CROWDS, Scene};
use crate::cases::animation::{Draw, SIZES, random_crowd};
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender, compare};

/// The cases cover random skeletons of every size and shape, with mirrored and uneven scales; a chain and a
/// star; all bones, and only those below active ones. All other bones must keep their matrices to the bit.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (skeleton, ..) = random_crowd(case as u32, bones, 1)?;
        add(cases, case as u32, "random", &skeleton, count).await?;
        add_updated(cases, case as u32, &skeleton, count).await?;
    }
    for (name, straight) in [("chain", true), ("star", false)] {
        let (random, ..) = random_crowd(99, 200, 1)?;
        let mut bones = random.bones().to_vec();
        for (index, bone) in (0..).zip(&mut bones) {
            bone.parent = if straight { u32::checked_sub(index, 1) } else { (index > 0).then_some(0) };
        }
        add(cases, 99, name, &Skeleton::of_joints(bones)?, 5).await?;
    }
    Ok(())
}

async fn add(
    cases: &mut Cases<'_>,
    case: u32,
    name: &str,
    skeleton: &Skeleton,
    count: usize,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let bones = skeleton.len();
    let (_, set, instances) = random_crowd(case, bones, count)?;
    let mut crowd = Crowd::new(gpu, &set, &instances)?;
    let locals = random_locals(case, bones * count)?;
    crowd.locals.write(gpu, &locals.iter().map(packed).collect::<Vec<_>>())?;
    let expected: Vec<Affine> =
        locals.chunks(bones).flat_map(|locals| local_to_model(skeleton, locals)).collect();
    let bound = bound(skeleton, &expected);
    let output = Poisoned::<Affine>::new(gpu, bones * count)?;
    crowd.model_matrices = ModelMatrices::new(&output.buffer);
    let job = LocalToModelPass::new(gpu)?.prepare(gpu, skeleton, &crowd)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let near = |actual: &[Affine]| compare::absolute(flat(actual), flat(&expected), bound);
    cases.check(format!("{name}, {bones} bones × {count}"), &output, near).await
}

fn flat(model_matrices: &[Affine]) -> &[f32] {
    model_matrices.as_flattened().as_flattened()
}

/// How far matrices may be from the expected ones.
fn bound(skeleton: &Skeleton, expected: &[Affine]) -> f32 {
    let largest = flat(expected).iter().fold(1.0, |a: f32, b| a.max(b.abs()));
    let deepest = skeleton.depths().iter().max().map_or(1, |depth| depth + 1);
    LOCAL_TO_MODEL_BOUND * deepest as f32 * largest
}

async fn add_updated(
    cases: &mut Cases<'_>,
    case: u32,
    skeleton: &Skeleton,
    count: usize,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let (bones, order) = (skeleton.len(), Order::new(skeleton));
    let (_, set, instances) = random_crowd(case, bones, count)?;
    let [before, locals] = [case + 100, case].map(|case| random_locals(case, bones * count));
    let (before, locals) = (before?, locals?);
    let stale: Vec<Affine> =
        before.chunks(bones).flat_map(|locals| local_to_model(skeleton, locals)).collect();
    let mut draw = Draw::new(case ^ 0xd127);
    // A third of the instances have no active bone, a third a few, and a third all but a few.
    let mut bits = vec![0; count * order.words()];
    for (instance, words) in bits.chunks_mut(order.words()).enumerate() {
        for slot in (0..bones).filter(|_| instance % 3 > 0) {
            let is_active = draw.word().is_multiple_of(50) == (instance % 3 == 1);
            words[slot / 32] |= u32::from(is_active) << (slot % 32);
        }
    }
    let mut expected = stale.clone();
    let chosen = ChosenBones { ahead: vec![0; bits.len()], bits };
    let work = compact(&order, &chosen);
    for ((updated_bones, locals), model_matrices) in
        work.updated_bones.chunks(order.words()).zip(locals.chunks(bones)).zip(expected.chunks_mut(bones))
    {
        local_to_model_updated(&order, updated_bones, locals, model_matrices);
    }
    let is_kept = |pair: usize, actual: &[Affine]| {
        let slot =
            order.slots.iter().position(|slot| slot.bone as usize == pair % bones).expect("every bone");
        let word = work.updated_bones[pair / bones * order.words() + slot / 32];
        word >> (slot % 32) & 1 == 1 || actual[pair] == stale[pair]
    };
    let mut crowd = Crowd::new(gpu, &set, &instances)?;
    crowd.locals.write(gpu, &locals.iter().map(packed).collect::<Vec<_>>())?;
    let output = Poisoned::<Affine>::new(gpu, bones * count)?;
    output.buffer.write(gpu, &stale)?;
    crowd.model_matrices = ModelMatrices::new(&output.buffer);
    let active = Active::new(gpu, &order, &crowd)?;
    active.bits.write(gpu, &chosen.bits)?;
    // Bones that frames before updated are not updated again.
    active.updated_bones.write(gpu, &vec![u32::MAX; chosen.bits.len()])?;
    let lists = CompactPass::new(gpu)?.prepare(gpu, &crowd, &active)?;
    let job = LocalToModelPass::new(gpu)?.prepare_active(gpu, skeleton, &crowd, &active)?;
    gpu.submit("verify", |encoder| {
        lists.record(encoder);
        job.record(encoder);
    })?;
    let bound = bound(skeleton, &expected);
    let near = |actual: &[Affine]| match (0..stale.len()).find(|pair| !is_kept(*pair, actual)) {
        Some(pair) => compare::Comparison::failed(stale.len(), format!("pair {pair} is clean, and changed")),
        None => compare::absolute(flat(actual), flat(&expected), bound),
    };
    cases.check(format!("updated bones, {bones} bones × {count}"), &output, near).await
}

/// Scales are close to 1, so that long chains stay in range.
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

/// Measures concatenation of all bones of all instances, then whole frames, then the parts of a frame by the
/// host's clock.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    for count in CROWDS {
        let scene = Scene::new(bench.gpu, count)?;
        alone(bench, &scene)?;
        both(bench, &scene)?;
    }
    #[cfg(not(target_arch = "wasm32"))]
    host::cases(bench, &Scene::new(bench.gpu, CROWDS[1])?)?;
    Ok(())
}

fn alone(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (pairs, bones) = (scene.pairs(), scene.skeleton.len());
    let locals = sample_set(&scene.set, &scene.instances, &scene.cursors, RotationPath::Slerp);
    scene.crowd.locals.write(gpu, &locals.iter().map(packed).collect::<Vec<_>>())?;
    let job = LocalToModelPass::new(gpu)?.prepare(gpu, &scene.skeleton, &scene.crowd)?;
    let copied = scene.copied(gpu)?;
    let plain = PlainSoa::new(&scene.skeleton, &scene.set)?;
    let soa = scene.cursors.iter().map(|cursor| {
        let mut locals = plain.locals();
        plain.sample(*cursor, &mut locals);
        locals
    });
    let soa: Vec<_> = soa.collect();
    let mut model_matrices = [vec![AFFINE_IDENTITY; pairs], vec![AFFINE_IDENTITY; pairs]];
    let [of_reference, of_plain] = &mut model_matrices;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            local_to_model_into(&scene.skeleton, &locals, black_box(of_reference))
        }),
        Contender::host(Backend::PlainSoa, || {
            for (locals, model_matrices) in soa.iter().zip(black_box(&mut *of_plain).chunks_mut(bones)) {
                plain.local_to_model(locals, model_matrices);
            }
        }),
    ];
    bench.case(format!("{} × 153", scene.instances.len()), pairs, "bone", 88 * pairs as u64, contenders)
}

/// A frame: cursors, sampling and concatenation in one submission. On the host, one instance after another.
fn both(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let frame = DeviceFrame::new(bench.gpu, scene)?;
    let (mut reference, mut plain) = (ReferenceFrame::new(scene), PlainFrame::new(scene)?);
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| frame.record(encoder)),
        Contender::recorded(Backend::Copy, |encoder| frame.record_copies(encoder)),
        Contender::host(Backend::Reference, || reference.compute(scene)),
        Contender::host(Backend::PlainSoa, || plain.compute(scene)),
    ];
    let (case, pairs) = (format!("{} × 153, both with sampling", scene.instances.len()), scene.pairs());
    bench.case(case, pairs, "bone", 216 * pairs as u64, contenders)
}
