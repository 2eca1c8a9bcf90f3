//! Recording a frame of a scene, and listing its draws.

use crate::animation::Frame;
use crate::gpu::Staged;
use crate::lod::budget::BudgetStage;
use crate::lod::transition::Transition;
use crate::lod::{SceneInstance, SelectView};
use crate::scene::character::TICKS;
use crate::scene::drawable::{Drawable, DrawnObject, DrawnView, SortedDraws, SortedPart};
use crate::scene::drive::Poses;
use crate::scene::object::{self, Object};
use crate::scene::order::Ordered;
use crate::scene::stage::Stage;
use crate::scene::statistics::SceneCounts;
use crate::scene::view::lists::{SortedLists, ViewPasses};
use crate::scene::view::{Moment, View};
use crate::scene::{FRAMES_IN_FLIGHT, Passes, Scene};
use crate::{Error, InputError};

/// The caller's function that records passes after bones are sampled and before model matrices are computed.
pub(super) type Between<'a> =
    &'a mut dyn FnMut(&mut wgpu::CommandEncoder, &mut Poses<'_>) -> Result<(), InputError>;

impl Scene {
    /// Discards all recordings that the device has not executed, and starts everything afresh, as [`Scene::refresh`] does.
    ///
    /// If an encoder was dropped without submission, the device misses the changes recorded in that encoder.
    /// [`Scene::record`] detects this and calls this function itself. Call it yourself if you keep encoders that you will
    /// not submit. Their recordings no longer count as in flight after the call.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// A frame that is recorded but never submitted.
    ///
    /// ```no_run
    /// # use relievo::scene::{Scene, View};
    /// # fn example(scene: &mut Scene, view: &mut View, mut kept: wgpu::CommandEncoder) -> Result<(), relievo::Error> {
    /// scene.record(&mut kept, &mut [view])?;
    /// // … `kept` stays alive and is not submitted.
    /// scene.invalidate()?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn invalidate(&mut self) -> Result<(), Error> {
        self.is_broken = false;
        self.staging.invalidate();
        self.pose_staging.invalidate();
        self.staged = Staged::default();
        if let Some(counts) = &mut self.counts {
            counts.invalidate(&self.gpu)?;
        }
        if let Some(timer) = &mut self.timer {
            timer.invalidate(&self.gpu)?;
        }
        if let Some(watch) = &mut self.watch {
            watch.invalidate(&self.gpu)?;
        }
        self.refresh()
    }

    /// Makes the next frame sample and skin everything visible in full, and upload every instance again. The picture then
    /// equals the picture of a newly created scene.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn refresh(&mut self) -> Result<(), Error> {
        for object in self.objects.iter_mut() {
            object.refresh(&self.gpu, &self.layouts_of_groups)?;
        }
        self.attachments.start_afresh();
        self.layout = None;
        Ok(())
    }

    /// Sets whether the scene keeps placements, vertices and levels of the last frame, from the next frame on. The default
    /// is false. [`Layer::Velocity`](crate::render::Layer::Velocity) needs this history. The history has a cost: skinned
    /// vertices take 1.4 times the memory, a moving instance is skinned once more after it stops, and host changes are
    /// uploaded twice. After a switch, all characters are sampled and skinned afresh.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// Motion vectors for temporal anti-aliasing.
    ///
    /// ```no_run
    /// # use relievo::gpu::Gpu;
    /// # use relievo::render::{Renderer, TargetFormat};
    /// # use relievo::scene::Scene;
    /// # fn example(gpu: &Gpu, scene: &mut Scene) -> Result<(), relievo::Error> {
    /// scene.keep_motion_history(true)?;
    /// let mut motion = Renderer::new(gpu, &TargetFormat::velocity())?; // draws Layer::Velocity
    /// motion.prepare(scene)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn keep_motion_history(&mut self, keeps: bool) -> Result<(), Error> {
        if std::mem::replace(&mut self.keeps_last, keeps) == keeps {
            return Ok(());
        }
        self.objects.iter_mut().for_each(|object| object.keep_last(keeps));
        self.refresh()
    }

    /// Records a frame: pending changes, then visibility and levels of detail per view, then poses and vertices of all
    /// visible characters. Draw afterwards, in passes of the same encoder or of encoders that are submitted later.
    ///
    /// In one call, pass every view that the frame draws. Characters are posed and skinned once, for the instances that
    /// these views see, at the finest level that any of the views needs. The views may differ from frame to frame.
    /// [`Renderer::draw`](crate::render::Renderer::draw) refuses a view that the last frame left out: the view's lists may
    /// refer to vertices whose memory was reused.
    ///
    /// Each call records one frame, even if one submission holds several frames. A draw uses the last frame that was
    /// recorded before it. At most [`FRAMES_IN_FLIGHT`] recordings may await execution. A recording counts until the device
    /// has executed it and wgpu has detected this, in a later submission or in [`wgpu::Device::poll`]. You may drop an
    /// encoder instead: the next recording then starts afresh ([`Scene::invalidate`]). Submit recordings in order, because
    /// each relies on changes in earlier recordings. For an empty scene, nothing is recorded or drawn.
    ///
    /// # Errors
    /// [`InputError`] if `views` is empty, for a view of another scene or without a camera, if [`FRAMES_IN_FLIGHT`]
    /// recordings await execution, and for an encoder of another [`wgpu::Instance`]. [`crate::gpu::GpuError`], also if the
    /// device was lost.
    ///
    /// wgpu panics for an encoder of another instance. The panic is caught, but the program's panic hook sees it.
    ///
    /// # Examples
    ///
    /// A split screen: both halves are recorded in one call.
    ///
    /// ```no_run
    /// # use relievo::render::{Layer, Renderer};
    /// # use relievo::scene::{Scene, View};
    /// # fn example(
    /// #     scene: &mut Scene,
    /// #     renderer: &Renderer,
    /// #     left: &mut View,
    /// #     right: &mut View,
    /// #     mut encoder: wgpu::CommandEncoder,
    /// #     begin: impl Fn(&mut wgpu::CommandEncoder) -> wgpu::RenderPass<'static>,
    /// # ) -> Result<(), relievo::Error> {
    /// scene.record(&mut encoder, &mut [left, right])?;
    /// let mut pass = begin(&mut encoder); // the program's own attachments
    /// pass.set_viewport(0.0, 0.0, 960.0, 1080.0, 0.0, 1.0);
    /// renderer.draw(&mut pass, scene, left, Layer::Color)?;
    /// pass.set_viewport(960.0, 0.0, 960.0, 1080.0, 0.0, 1.0);
    /// renderer.draw(&mut pass, scene, right, Layer::Color)?;
    /// drop(pass);
    /// scene.gpu().queue().submit([encoder.finish()]);
    /// # Ok(())
    /// # }
    /// ```
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        views: &mut [&mut View],
    ) -> Result<(), Error> {
        self.record_frame(encoder, views, None)
    }

    /// Records a frame. The function `between`, if given, runs after bones are sampled and before model matrices are
    /// computed.
    pub(super) fn record_frame(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        views: &mut [&mut View],
        between: Option<Between<'_>>,
    ) -> Result<(), Error> {
        self.gpu.check_loss()?;
        self.check(views)?;
        self.gpu.check_encoder(encoder)?;
        if self.is_empty() {
            self.uploaded = 0;
            return Ok(());
        }
        if self.is_broken || self.staging.has_dropped() {
            self.invalidate()?;
        }
        for object in self.objects.iter_mut() {
            object.settle(self.now);
            object.arrive(self.step);
        }
        let sent = self.upload()?;
        self.provide(views)?;
        if let Err(error) = self.fit(views).and_then(|()| self.stage(views)) {
            // Some changes were taken from their queues without being staged, so the next frame would miss them.
            self.is_broken = true;
            return Err(error);
        }
        let gpu = self.gpu.clone();
        self.uploaded = sent + self.staged.len();
        if !self.staging.record(&gpu, encoder, &mut self.staged)? {
            self.is_broken = true;
            let bound =
                format!("must be below {FRAMES_IN_FLIGHT}: submit what was recorded, or call invalidate()");
            return Err(InputError::new("recordings", self.staging.busy(), bound).into());
        }
        self.objects.iter_mut().for_each(|object| object.kind.record(encoder));
        let staged = self.record_stages(encoder, views, between);
        if staged.is_ok() {
            self.count(encoder, views);
            views.iter_mut().for_each(|view| view.recorded(self.frames, self.now));
        }
        self.frames += 1;
        // The device has all staged changes only if all stages were recorded.
        self.is_broken = staged.is_err();
        staged?;
        // If the time is not advanced again, no time passes between this frame and the next.
        self.step = 0.0;
        Ok(())
    }

    /// Records all stages. If the stages are timed, each has its own compute pass. Otherwise all stages share one pass,
    /// which `between`, if given, splits in two.
    fn record_stages(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        views: &[&mut View],
        mut between: Option<Between<'_>>,
    ) -> Result<(), Error> {
        self.forget_written();
        if let Some(timer) = &mut self.timer {
            timer.begin(encoder, self.frames);
        }
        let timed = |stage: Stage| self.timer.as_ref().and_then(|timer| timer.stage(stage as usize));
        let runs: &[&[Stage]] = match (timed(Stage::Select).is_some(), between.is_some()) {
            (true, _) => &Stage::EACH,
            (false, true) => &Stage::HALVES,
            (false, false) => &Stage::WHOLE,
        };
        for run in runs {
            if run[0] == Stage::LocalToModel
                && let Some(between) = between.take()
            {
                let mut poses = Poses::new(&self.gpu, &mut self.objects, &mut self.pose_staging);
                between(encoder, &mut poses)?;
                poses.finish(encoder)?;
            }
            let timestamp_writes = if run.len() == 1 { timed(run[0]) } else { None };
            let label = Some(if run.len() == 1 { run[0].label() } else { "scene" });
            let descriptor = wgpu::ComputePassDescriptor { label, timestamp_writes };
            let mut pass = encoder.begin_compute_pass(&descriptor);
            run.iter().for_each(|stage| self.dispatch(*stage, views, &mut pass));
        }
        Ok(())
    }

    fn dispatch(&self, stage: Stage, views: &[&mut View], pass: &mut wgpu::ComputePass<'_>) {
        if stage == Stage::Select {
            views.iter().for_each(|view| view.dispatch_select(pass));
            for stage in BudgetStage::EACH {
                for (at, view) in views.iter().enumerate() {
                    let is_other = || !views[..at].iter().any(|other| other.shares_budget_with(view));
                    if stage.is_of_each_view() || is_other() {
                        view.dispatch_budget(stage, pass);
                    }
                }
            }
            views.iter().for_each(|view| view.dispatch(pass));
        }
        self.objects.iter().for_each(|object| object.kind.dispatch(stage, pass));
        if stage == Stage::LocalToModel {
            views.iter().for_each(|view| view.dispatch_attached(pass));
        }
    }

    /// Records commands that copy statistics and watched bones to readback buffers.
    fn count(&mut self, encoder: &mut wgpu::CommandEncoder, views: &mut [&mut View]) {
        if let Some(counts) = &mut self.counts {
            counts.record(encoder, self.frames, &self.objects);
        }
        if let (Some(watch), Some(layout)) = (&mut self.watch, &self.layout) {
            watch.record(encoder, self.frames, self.now, &self.objects, layout);
        }
        for view in views {
            view.count(encoder, self.frames, &self.objects);
        }
    }

    /// The drawables of all objects and of their successors, each with the transition between its object's levels of detail.
    pub(crate) fn drawables(&self) -> impl Iterator<Item = (&dyn Drawable, Transition)> {
        self.objects.iter().flat_map(|object| {
            let transition = object.level_of_detail.transition();
            let next = object.successor.iter().flat_map(|next| next.drawables());
            object.drawables().chain(next).map(move |drawable| (drawable, transition))
        })
    }

    fn is_empty(&self) -> bool {
        self.objects.iter().next().is_none()
    }

    /// The data for drawing a view and all shown objects; `None` for a scene without objects.
    pub(crate) fn drawn<'a>(
        &'a self,
        view: &'a View,
    ) -> Result<Option<(DrawnView<'a>, Vec<DrawnObject<'a>>)>, InputError> {
        view.check(self, "view")?;
        if self.is_empty() {
            return Ok(None);
        }
        let (Some(lists), Some(recorded)) = (&view.lists, view.last_recorded()) else {
            return Err(InputError::new("view", "not recorded", "must be recorded before it is drawn"));
        };
        let bound = || "must be among the views of the last Scene::record";
        InputError::check(view.is_of_frame(self.frames), "view", "left out of the last frame", bound)?;
        if self.layout.as_ref().is_none_or(|layout| lists.version != layout.version) {
            let bound = "must be recorded again, since objects were added, removed or grew, or the scene started afresh";
            return Err(InputError::new("view", "out of date", bound));
        }
        let drawn = DrawnView {
            group: &lists.group,
            lists: &lists.lists,
            arguments: &lists.arguments,
            mirrors: recorded.mirrors,
            reversed: recorded.reversed,
            keeps_last: self.keeps_last,
            is_shadowed: self.is_shadowed,
        };
        let mut objects = Vec::new();
        let own = recorded.sides.iter().zip(&lists.in_view);
        let shown = self.objects.iter().zip(own).filter(|(object, _)| object.is_drawn());
        for (object, (sides, in_view)) in shown {
            let (number, sides) = (object.handle, *sides);
            let view_group = in_view.as_ref().map(|in_view| in_view.group());
            let transition = object.level_of_detail.transition();
            for chunk in &object.chunks {
                for (drawable, lod) in chunk.drawables.iter().zip(&chunk.lods) {
                    let drawable = &**drawable;
                    objects.push(DrawnObject { number, drawable, lod, sides, transition, view_group });
                }
            }
        }
        Ok(Some((drawn, objects)))
    }

    /// The instances that a view draws one by one, from back to front; `None` if the view has no such draws.
    pub(crate) fn sorted_draws<'a>(&'a self, view: &'a View) -> Option<SortedDraws<'a>> {
        let lists = view.lists.as_ref()?;
        let SortedLists { draws, entries, .. } = lists.sorted.as_ref()?;
        let objects: Vec<&Object> = self.objects.iter().collect();
        let mut parts = Vec::new();
        for Ordered { object, instance, .. } in &lists.order {
            let Some(object) = objects.get(*object).filter(|object| object.is_drawn()) else { continue };
            let placed = object.instances.all().get(*instance as usize);
            let is_mirrored = placed.is_some_and(SceneInstance::is_mirrored);
            let Some(chunk) = object.chunk_of(*instance) else { continue };
            let transition = object.level_of_detail.transition();
            let instance = (*instance as usize - chunk.slots.start) as u32;
            for single in &chunk.sorted {
                let drawable = &*chunk.drawables[single.drawable];
                let Some(part) = drawable.part(single.part) else { continue };
                let draw = single.first + instance;
                parts.push(SortedPart { drawable, part, draw, is_mirrored, transition });
            }
        }
        Some(SortedDraws { draws, entries, parts })
    }

    fn check(&self, views: &[&mut View]) -> Result<(), InputError> {
        InputError::check(!views.is_empty(), "views", "none", || "must be at least one")?;
        views.iter().enumerate().try_for_each(|(at, view)| view.check(self, &format!("views[{at}]")))?;
        if views.iter().any(|view| view.camera().is_none()) {
            return Err(InputError::new("view.camera", "none", "must be set before a frame is recorded"));
        }
        Ok(())
    }

    /// Allocates pages of skinned vertices for the instances that the views see.
    fn provide(&mut self, views: &[&mut View]) -> Result<(), Error> {
        let blocks = self.layout.as_ref().map_or(0, |layout| layout.blocks);
        let seen = views.iter().map(|view| Ok(view.select_view(blocks, true)?.1));
        let seen = seen.collect::<Result<Vec<SelectView>, InputError>>()?;
        // Beside other objects, which the device coarsens, an object that coarsens itself takes half of the triangles.
        let others = u32::from(self.objects.iter().count() > 1);
        let limit = |view: &&mut View| Some((view.triangle_limit()? >> others).max(1));
        let limits: Vec<Option<u32>> = views.iter().map(limit).collect();
        for object in self.objects.iter_mut() {
            if object.provide(&self.gpu, &self.layouts_of_groups, &seen, &limits, self.now)? {
                self.layout = None;
            }
        }
        Ok(())
    }

    /// Allocates buffers for objects and views after an object was added or grew.
    fn fit(&mut self, views: &mut [&mut View]) -> Result<(), Error> {
        if self.layout.is_none() {
            self.layouts += 1;
            let layout = object::laid_out(&self.gpu, &mut self.objects, self.layouts, self.keeps_last)?;
            self.objects.iter_mut().for_each(|object| object.instances.change_all());
            self.layout = Some(layout);
        }
        let Some(layout) = &self.layout else { return Ok(()) };
        for object in self.objects.iter_mut() {
            object.fit(&self.gpu, layout, &self.passes.assign, self.budget, &mut self.staged)?;
        }
        self.attachments.fit(&self.gpu, &self.objects, layout, &mut self.staged, self.frames)?;
        for view in views {
            let Passes { select, decide, budget, list, sorted, .. } = &self.passes;
            let passes = ViewPasses { select, decide, budget, list, sorted };
            view.fit(&self.gpu, layout, passes, &self.layouts_of_groups, &self.objects)?;
            view.fit_attached(&self.gpu, &self.passes.attach, &self.attachments, &self.objects, layout)?;
            view.fit_counts(&self.gpu, self.counted.then_some(&layout.counted))?;
        }
        if self.counted && self.counts.as_ref().is_none_or(|counts| counts.version != layout.version) {
            self.counts = Some(SceneCounts::new(&self.gpu, layout.version, &self.objects)?);
        }
        Ok(())
    }

    fn stage(&mut self, views: &mut [&mut View]) -> Result<(), Error> {
        let Some(layout) = &self.layout else { return Ok(()) };
        let seen = views.iter().map(|view| Ok(view.select_view(layout.blocks, true)?.1));
        let seen = seen.collect::<Result<Vec<SelectView>, InputError>>()?;
        for (view, selected) in views.iter_mut().zip(&seen) {
            view.order(self.objects.iter(), selected);
        }
        for (at, view) in views.iter_mut().enumerate() {
            let sides = self.objects.iter().map(|object| object.instances.sides());
            let now = Moment { frame: self.frames, time: self.now, number: at };
            view.stage(&mut self.staged, layout, &self.light, sides, now)?;
        }
        let ticks = |seconds: f64| (seconds * TICKS).round() as i64 as u32;
        let last = std::mem::replace(&mut self.last_staged, self.now).min(self.now);
        let frame_ticks = ticks(self.now).wrapping_sub(ticks(last));
        let frame =
            Frame { ticks: ticks(self.now), frame_ticks, frame: self.frames as u32, ahead: self.step };
        for object in self.objects.iter_mut() {
            object.stage(&mut self.staged, layout, &frame, self.now)?;
        }
        Ok(())
    }
}
