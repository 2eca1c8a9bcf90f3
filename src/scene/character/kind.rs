//! Characters as a kind of object.

use std::any::Any;

use glam::DVec3;

use super::{Character, Runtime, Shared};
use crate::animation::Frame;
use crate::gpu::{Gpu, Staged};
use crate::scene::chunk::Chunk;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::Looks;
use crate::scene::object_kind::{
    Fitted, Made, MakeOn, Making, ObjectKind, OnDevice, Placed, Provided, Replaced, SeenBy,
};
use crate::scene::ray::Surface;
use crate::scene::stage::Stage;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::{Error, InputError};

impl ObjectKind for Character {
    fn name(&self) -> &'static str {
        "a character"
    }

    fn sphere_of(&self, index: u32) -> Option<BoundingSphere> {
        Some(self.sphere_as_played(index))
    }

    fn spawned(&mut self, index: u32) -> Option<BoundingSphere> {
        Some(self.play_first(index))
    }

    fn despawned(&mut self, index: u32) {
        self.let_go(index);
    }

    fn renew(&mut self, target: MakeOn<'_>, chunks: &mut Vec<Chunk>) -> Result<(), Error> {
        let MakeOn { gpu, layouts, capacity, .. } = target;
        let model = &self.merged.model;
        let runtimes = Runtime::all(gpu, model, &self.shared, &self.room(capacity))?;
        *chunks = Self::chunks(gpu, layouts, chunks, &runtimes)?;
        self.runtimes = runtimes;
        self.start_afresh(capacity);
        Ok(())
    }

    fn made_on<'a>(&'a self, target: MakeOn<'a>) -> Making<'a> {
        let MakeOn { gpu, layouts, looks, capacity } = target;
        Box::pin(async move {
            let model = &self.merged.model;
            let shared = self.shared.on(gpu, model)?;
            let runtimes = Runtime::all(gpu, model, &shared, &self.room(capacity))?;
            let first = self.first_chunk(gpu, layouts, looks.unwrap_or(&Looks::NONE), &runtimes)?;
            let chunks = Self::chunks(gpu, layouts, &[first], &runtimes)?;
            Ok(OnDevice { chunks, other: Box::new((shared, runtimes)) })
        })
    }

    fn adopt(&mut self, other: Box<dyn Made>) {
        let other: Box<dyn Any> = other;
        if let Ok(made) = other.downcast::<(Shared, Vec<Runtime>)>() {
            (self.shared, self.runtimes) = *made;
            self.start_afresh(self.plays.len());
        }
    }

    fn follow(&mut self, last: &mut dyn ObjectKind) {
        if let Some(last) = last.downcast_mut::<Self>() {
            self.take_state(last);
        }
    }

    fn keep_last(&mut self, keeps: bool) {
        self.keeps_last = keeps;
    }

    /// Ends fades of layers that have reached their target weight by scene time `now`.
    fn settle(&mut self, now: f64) -> Vec<u32> {
        self.end_fades(now)
    }

    /// Allocates pages for the skinned vertices of visible instances. If memory is short, levels of detail become coarser.
    fn provide(
        &mut self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        seen: &SeenBy<'_>,
        chunks: &mut Vec<Chunk>,
    ) -> Result<Provided, Error> {
        let provided = self.provide_pages(gpu, seen)?;
        match provided.replaced {
            Replaced::Nothing => {}
            Replaced::Buffers => self.rebind(gpu, layouts, chunks)?,
            Replaced::Chunks => *chunks = Self::chunks(gpu, layouts, chunks, &self.runtimes)?,
        }
        Ok(provided)
    }

    fn fit(&mut self, gpu: &Gpu, fitted: &Fitted<'_>, staged: &mut Staged) -> Result<(), Error> {
        self.fit_driven(gpu, staged)?;
        if fitted.is_new { self.fit_levels(gpu, fitted) } else { Ok(()) }
    }

    fn stage(&mut self, staged: &mut Staged, frame: &Frame, now: f64) -> Result<(), Error> {
        self.stage_played(staged, frame, now)
    }

    fn dispatch(&self, stage: Stage, pass: &mut wgpu::ComputePass<'_>) {
        self.runtimes.iter().for_each(|runtime| runtime.dispatch(stage, pass));
    }

    fn surfaces(&self, index: u32, now: f64) -> Result<Vec<Surface<'_>>, InputError> {
        self.posed_surfaces(index, now)
    }

    /// A box around one ball per bone. Each ball holds the vertices that follow the bone.
    fn wide_box(&self, instance: &Placed) -> Result<Option<[DVec3; 2]>, InputError> {
        Ok(Some(self.bounds(&self.pose(instance.index, instance.now)?, instance.place)))
    }

    fn is_bounded(&self) -> bool {
        self.keeps_bound()
    }

    fn needs_skeleton(&self, index: u32) -> bool {
        self.needs_skeleton(index)
    }

    /// Whether the host wrote bones of the instance in the last frame. Written bones may leave the clip's bounding sphere.
    fn may_leave_sphere(&self, index: u32) -> bool {
        self.is_written(index)
    }
}
