//! Benchmarks of whole frames: cursors, sampling and concatenation of a crowd, and copies of the same bytes.

use std::hint::black_box;

use relievo::Error;
use relievo::asset::keyframe::{KeyframeCursor, RotationPath};
use relievo::asset::transform::{AFFINE_IDENTITY, Affine, Transform};
use relievo::gpu::{Gpu, Job};
use relievo::ops::animation::keyframe_cursor::reference::cursors_into;
use relievo::ops::animation::keyframe_cursor::{KeyframeCursorJob, KeyframeCursorPass};
use relievo::ops::animation::local_to_model::LocalToModelPass;
use relievo::ops::animation::local_to_model::reference::local_to_model_into;
use relievo::ops::animation::sample::SamplePass;
use relievo::ops::animation::sample::reference::sample_set_into;

use crate::baseline::gather::Reads;
use crate::cases::animation::plain_soa::PlainSoa;
use crate::cases::animation::scene::{ELAPSED, Scene};

/// A frame computed by the kernels.
pub(crate) struct DeviceFrame {
    cursor: KeyframeCursorJob,
    sample: Job,
    local_to_model: Job,
    copies: [Job; 2],
}

impl DeviceFrame {
    pub(crate) fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, Error> {
        let cursor = KeyframeCursorPass::new(gpu)?.prepare(gpu, &scene.clips, &scene.crowd)?;
        cursor.set(gpu, ELAPSED)?;
        Ok(Self {
            cursor,
            sample: SamplePass::new(gpu, RotationPath::Slerp)?.prepare(gpu, &scene.clips, &scene.crowd)?,
            local_to_model: LocalToModelPass::new(gpu)?.prepare(gpu, &scene.skeleton, &scene.crowd)?,
            copies: [scene.gathered(gpu, Reads::Everything)?, scene.copied(gpu)?],
        })
    }

    pub(crate) fn set(&self, gpu: &Gpu) -> Result<(), Error> {
        self.cursor.set(gpu, ELAPSED)
    }

    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.cursor.record(encoder);
        self.sample.record(encoder);
        self.local_to_model.record(encoder);
    }

    pub(crate) fn record_copies(&self, encoder: &mut wgpu::CommandEncoder) {
        self.copies.iter().for_each(|copy| copy.record(encoder));
    }
}

/// A frame computed by the references.
pub(crate) struct ReferenceFrame {
    cursors: Vec<KeyframeCursor>,
    locals: Vec<Transform>,
    model_matrices: Vec<Affine>,
}

impl ReferenceFrame {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self {
            cursors: scene.cursors.clone(),
            locals: vec![Transform::IDENTITY; scene.skeleton.len()],
            model_matrices: vec![AFFINE_IDENTITY; scene.pairs()],
        }
    }

    pub(crate) fn compute(&mut self, scene: &Scene) {
        let Self { cursors, locals, model_matrices } = self;
        cursors_into(&scene.set, &scene.instances, ELAPSED, cursors);
        let room = scene.set.timelines_a_clip();
        let instances = scene.instances.chunks(1).zip(cursors.chunks(room));
        for ((instance, cursors), model_matrices) in
            instances.zip(black_box(model_matrices).chunks_mut(scene.skeleton.len()))
        {
            sample_set_into(&scene.set, instance, cursors, RotationPath::Slerp, locals);
            local_to_model_into(&scene.skeleton, locals, model_matrices);
        }
    }
}

/// A frame computed by plain structure-of-arrays code.
pub(crate) struct PlainFrame {
    plain: PlainSoa,
    cursors: Vec<KeyframeCursor>,
    locals: Vec<[f32; 8]>,
    model_matrices: Vec<Affine>,
}

impl PlainFrame {
    pub(crate) fn new(scene: &Scene) -> Result<Self, Error> {
        let plain = PlainSoa::new(&scene.skeleton, &scene.set)?;
        let (cursors, locals) = (scene.cursors.clone(), plain.locals());
        Ok(Self { plain, cursors, locals, model_matrices: vec![AFFINE_IDENTITY; scene.pairs()] })
    }

    pub(crate) fn compute(&mut self, scene: &Scene) {
        let Self { plain, cursors, locals, model_matrices } = self;
        cursors_into(&scene.set, &scene.instances, ELAPSED, cursors);
        for (cursor, model_matrices) in
            cursors.iter().zip(black_box(model_matrices).chunks_mut(scene.skeleton.len()))
        {
            plain.sample(*cursor, locals);
            plain.local_to_model(locals, model_matrices);
        }
    }
}
