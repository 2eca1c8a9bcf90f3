//! Concatenation of crowds, whole frames, and what the host adds.

use std::hint::black_box;

use super::plain_soa::PlainSoa;
use super::{CROWDS, ELAPSED, Scene};
use crate::Error;
use crate::animation::concat::{ConcatPass, Walk};
use crate::animation::crowd::packed;
use crate::animation::place::{Place, PlacePass};
use crate::animation::sample::{RotationPath, SamplePass};
use crate::animation::transform::{AFFINE_IDENTITY, Affine, Transform};
use crate::bench::{Backend, Bench, Contender};
use crate::reference::animation::concat::concat_into;
use crate::reference::animation::place::places_into;
use crate::reference::animation::sample::{sample_set, sample_set_into};

/// All bones of all instances: concatenation, then sampling and concatenation.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    for count in CROWDS {
        let scene = Scene::new(bench.gpu, count)?;
        alone(bench, &scene)?;
        both(bench, &scene)?;
    }
    Ok(())
}

fn alone(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (pairs, bones) = (scene.pairs(), scene.skeleton.len());
    let locals = sample_set(&scene.set, &scene.instances, &scene.places, RotationPath::Slerp);
    scene.crowd.locals.write(gpu, &locals.iter().map(packed).collect::<Vec<_>>())?;
    let job = ConcatPass::new(gpu, Walk::of(gpu))?.prepare(gpu, &scene.skeleton, &scene.crowd)?;
    let copied = scene.copied(gpu)?;
    let plain = PlainSoa::new(&scene.skeleton, &scene.set)?;
    let soa = scene.places.iter().map(|place| {
        let mut locals = plain.locals();
        plain.sample(*place, &mut locals);
        locals
    });
    let soa: Vec<_> = soa.collect();
    let mut models = [vec![AFFINE_IDENTITY; pairs], vec![AFFINE_IDENTITY; pairs]];
    let [of_twin, of_plain] = &mut models;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Twin, || concat_into(&scene.skeleton, &locals, black_box(of_twin))),
        Contender::host(Backend::PlainSoa, || {
            for (locals, models) in soa.iter().zip(black_box(&mut *of_plain).chunks_mut(bones)) {
                plain.concat(locals, models);
            }
        }),
    ];
    bench.case(format!("{} × 153", scene.instances.len()), (pairs, "bone"), 88 * pairs as u64, contenders)
}

/// A frame: places, sampling and concatenation in one submission. On the host, one instance after another.
fn both(bench: &mut Bench<'_>, scene: &Scene) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pairs = scene.pairs();
    let place = PlacePass::new(gpu)?.prepare(gpu, &scene.clips, &scene.crowd)?;
    place.set(gpu, ELAPSED)?;
    let sample = SamplePass::new(gpu, RotationPath::Slerp)?.prepare(gpu, &scene.clips, &scene.crowd)?;
    let concat = ConcatPass::new(gpu, Walk::of(gpu))?.prepare(gpu, &scene.skeleton, &scene.crowd)?;
    let (gathered, copied) = (scene.gathered(gpu)?, scene.copied(gpu)?);
    let mut frames = (TwinFrame::new(scene), PlainFrame::new(scene)?);
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| {
            place.record(encoder);
            sample.record(encoder);
            concat.record(encoder);
        }),
        Contender::recorded(Backend::Copy, |encoder| {
            gathered.record(encoder);
            copied.record(encoder);
        }),
        Contender::host(Backend::Twin, || frames.0.compute(scene)),
        Contender::host(Backend::PlainSoa, || frames.1.compute(scene)),
    ];
    let case = format!("{} × 153, both with sampling", scene.instances.len());
    bench.case(case, (pairs, "bone"), 216 * pairs as u64, contenders)
}

/// A frame of the twins.
struct TwinFrame {
    places: Vec<Place>,
    locals: Vec<Transform>,
    models: Vec<Affine>,
}

impl TwinFrame {
    fn new(scene: &Scene) -> Self {
        Self {
            places: scene.places.clone(),
            locals: vec![Transform::IDENTITY; scene.skeleton.len()],
            models: vec![AFFINE_IDENTITY; scene.pairs()],
        }
    }

    fn compute(&mut self, scene: &Scene) {
        let Self { places, locals, models } = self;
        places_into(&scene.set, &scene.instances, ELAPSED, places);
        let room = scene.set.timelines_a_clip();
        let instances = scene.instances.chunks(1).zip(places.chunks(room));
        for ((instance, places), models) in instances.zip(black_box(models).chunks_mut(scene.skeleton.len()))
        {
            sample_set_into(&scene.set, instance, places, RotationPath::Slerp, locals);
            concat_into(&scene.skeleton, locals, models);
        }
    }
}

/// A frame of the opponent.
struct PlainFrame {
    plain: PlainSoa,
    places: Vec<Place>,
    locals: Vec<[f32; 8]>,
    models: Vec<Affine>,
}

impl PlainFrame {
    fn new(scene: &Scene) -> Result<Self, Error> {
        let plain = PlainSoa::new(&scene.skeleton, &scene.set)?;
        let (places, locals) = (scene.places.clone(), plain.locals());
        Ok(Self { plain, places, locals, models: vec![AFFINE_IDENTITY; scene.pairs()] })
    }

    fn compute(&mut self, scene: &Scene) {
        let Self { plain, places, locals, models } = self;
        places_into(&scene.set, &scene.instances, ELAPSED, places);
        for (place, models) in places.iter().zip(black_box(models).chunks_mut(scene.skeleton.len())) {
            plain.sample(*place, locals);
            plain.concat(locals, models);
        }
    }
}
