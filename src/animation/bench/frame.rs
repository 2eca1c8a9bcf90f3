//! Whole frames: places, sampling and concatenation of a crowd, and the copies of their bytes.

use std::hint::black_box;

use super::plain_soa::PlainSoa;
use super::{ELAPSED, Scene};
use crate::Error;
use crate::animation::concat::reference::concat_into;
use crate::animation::concat::{ConcatJob, ConcatPass};
use crate::animation::place::reference::places_into;
use crate::animation::place::{PlaceJob, PlacePass};
use crate::animation::sample::SamplePass;
use crate::animation::sample::reference::sample_set_into;
use crate::asset::keyframe::Place;
use crate::asset::keyframe::RotationPath;
use crate::asset::transform::{AFFINE_IDENTITY, Affine, Transform};
use crate::baseline::gather::Reads;
use crate::gpu::{Gpu, Job};

/// A frame of the kernels.
pub struct DeviceFrame {
    place: PlaceJob,
    sample: Job,
    concat: ConcatJob,
    copies: [Job; 2],
}

impl DeviceFrame {
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, Error> {
        let place = PlacePass::new(gpu)?.prepare(gpu, &scene.clips, &scene.crowd)?;
        place.set(gpu, ELAPSED)?;
        Ok(Self {
            place,
            sample: SamplePass::new(gpu, RotationPath::Slerp)?.prepare(gpu, &scene.clips, &scene.crowd)?,
            concat: ConcatPass::new(gpu)?.prepare(gpu, &scene.skeleton, &scene.crowd)?,
            copies: [scene.gathered(gpu, Reads::Everything)?, scene.copied(gpu)?],
        })
    }

    pub fn set(&self, gpu: &Gpu) -> Result<(), Error> {
        self.place.set(gpu, ELAPSED)
    }

    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.place.record(encoder);
        self.sample.record(encoder);
        self.concat.record(encoder);
    }

    pub fn record_copies(&self, encoder: &mut wgpu::CommandEncoder) {
        self.copies.iter().for_each(|copy| copy.record(encoder));
    }
}

/// A frame of the twins.
pub struct TwinFrame {
    places: Vec<Place>,
    locals: Vec<Transform>,
    models: Vec<Affine>,
}

impl TwinFrame {
    pub fn new(scene: &Scene) -> Self {
        Self {
            places: scene.places.clone(),
            locals: vec![Transform::IDENTITY; scene.skeleton.len()],
            models: vec![AFFINE_IDENTITY; scene.pairs()],
        }
    }

    pub fn compute(&mut self, scene: &Scene) {
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
pub struct PlainFrame {
    plain: PlainSoa,
    places: Vec<Place>,
    locals: Vec<[f32; 8]>,
    models: Vec<Affine>,
}

impl PlainFrame {
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let plain = PlainSoa::new(&scene.skeleton, &scene.set)?;
        let (places, locals) = (scene.places.clone(), plain.locals());
        Ok(Self { plain, places, locals, models: vec![AFFINE_IDENTITY; scene.pairs()] })
    }

    pub fn compute(&mut self, scene: &Scene) {
        let Self { plain, places, locals, models } = self;
        places_into(&scene.set, &scene.instances, ELAPSED, places);
        for (place, models) in places.iter().zip(black_box(models).chunks_mut(scene.skeleton.len())) {
            plain.sample(*place, locals);
            plain.concat(locals, models);
        }
    }
}
