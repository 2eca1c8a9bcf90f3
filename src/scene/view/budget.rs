//! A view's budget of triangles.

use std::sync::Arc;

use super::View;
use crate::gpu::{Buffer, Gpu, Staged, Uniform, Upload as _};
use crate::lod::budget::{BudgetBuffers, BudgetParams, BudgetPass, BudgetStage, BudgetStages, BudgetWork};
use crate::lod::{BudgetState, SelectView};
use crate::scene::Scene;
use crate::scene::layout::Layout;
use crate::scene::pacer::Pacer;
use crate::scene::quality::Quality;
use crate::{Error, InputError};

/// Device buffers of a budget of triangles, which several views may share.
#[derive(Debug)]
pub(in crate::scene) struct Budget {
    params: Uniform<BudgetParams>,
    pub state: Buffer<BudgetState>,
    work: Buffer<BudgetWork>,
}

impl Budget {
    fn new(gpu: &Gpu) -> Result<Self, Error> {
        Ok(Self {
            params: Uniform::new(gpu, "budget", &BudgetParams { limit: u32::MAX, blocks: 0 })?,
            state: Buffer::from_slice(gpu, "state of a budget", &[BudgetState::FREE])?,
            work: Buffer::new(gpu, "sums of a budget", 1)?,
        })
    }
}

/// A view's state of its budget of triangles.
#[derive(Debug, Default)]
pub(super) struct BudgetOfView {
    budget: Option<Arc<Budget>>,
    /// The controller that holds the frame time to the target [`Quality::milliseconds`](crate::scene::Quality::milliseconds).
    pacer: Option<Pacer>,
}

impl Scene {
    /// Gives several views one budget. Together they draw at most `triangles` triangles, and one factor makes their
    /// levels of detail coarser. Record all of these views in each frame. A view leaves the budget when its quality is
    /// set ([`View::set_quality`]).
    ///
    /// # Errors
    /// [`InputError`] for 0 triangles, and for a view of another scene; [`crate::gpu::GpuError`].
    pub fn share_budget(&self, views: &mut [&mut View], triangles: u32) -> Result<(), Error> {
        let quality = Quality { triangles: Some(triangles), ..Quality::default() };
        quality.validate()?;
        for (at, view) in views.iter().enumerate() {
            view.check(self, &format!("views[{at}]"))?;
        }
        let budget = Arc::new(Budget::new(self.gpu())?);
        for view in views {
            view.quality.triangles = Some(triangles);
            view.budget = BudgetOfView { budget: Some(budget.clone()), pacer: None };
            view.lists = None;
        }
        Ok(())
    }
}

impl View {
    /// Reports how long a frame with this view took, in milliseconds. The view then adapts its triangles to
    /// [`Quality::milliseconds`](crate::scene::Quality::milliseconds). Report either the time of the whole frame, or
    /// only the time of the work for the view's triangles. Call this once a frame. If the quality has no limit of time,
    /// the call does nothing.
    ///
    /// # Errors
    /// [`InputError`] for a time that is negative or not finite.
    pub fn frame_took(&mut self, milliseconds: f32) -> Result<(), InputError> {
        let bound = || "must be finite, and not negative";
        InputError::check((0.0..f32::INFINITY).contains(&milliseconds), "milliseconds", milliseconds, bound)?;
        if let Some(limit) = self.quality.milliseconds {
            self.budget.pacer.get_or_insert_default().took(milliseconds, limit);
        }
        Ok(())
    }

    /// The largest number of triangles that the view may draw at present; `None` without a limit.
    pub fn triangle_limit(&self) -> Option<u32> {
        let paced =
            self.budget.pacer.as_ref().and_then(Pacer::limit).filter(|_| self.quality.milliseconds.is_some());
        match (self.quality.triangles, paced) {
            (Some(limit), Some(paced)) => Some(limit.min(paced)),
            (limit, paced) => limit.or(paced),
        }
    }

    /// Adapts the budget to a new quality. `had` is whether the previous quality had a budget. The view leaves a shared
    /// budget.
    pub(super) fn budget_changed(&mut self, had: bool) {
        let is_shared = self.budget.budget.as_ref().is_some_and(|budget| Arc::strong_count(budget) > 1);
        if had != self.has_budget() || is_shared {
            self.budget = BudgetOfView::default();
            self.lists = None;
        }
    }

    pub(super) fn has_budget(&self) -> bool {
        self.quality.triangles.is_some() || self.quality.milliseconds.is_some()
    }

    /// The buffers of the view's budget. They are created if they do not exist.
    pub(super) fn budget_on(&mut self, gpu: &Gpu) -> Result<Arc<Budget>, Error> {
        if self.budget.budget.is_none() {
            self.budget.budget = Some(Arc::new(Budget::new(gpu)?));
        }
        Ok(self.budget.budget.clone().expect("made above"))
    }

    /// Whether two views share a budget. If `other` is this view, the result is whether the view has a budget.
    pub(in crate::scene) fn shares_budget_with(&self, other: &View) -> bool {
        match (&self.budget.budget, &other.budget.budget) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            _ => false,
        }
    }

    /// Stages the triangle limit, in units of 2^`unit` triangles.
    pub(super) fn stage_budget(&self, staged: &mut Staged, blocks: u32, unit: u32) -> Result<(), Error> {
        let Some(budget) = self.budget.budget.as_ref().filter(|_| self.has_budget()) else { return Ok(()) };
        let limit = self.triangle_limit().unwrap_or(u32::MAX) >> unit;
        Ok(staged.uniform(&budget.params, &BudgetParams { limit, blocks })?)
    }

    /// Adds a stage of the budget to a compute pass.
    pub(in crate::scene) fn dispatch_budget(&self, stage: BudgetStage, pass: &mut wgpu::ComputePass<'_>) {
        if let Some(stages) = self.lists.as_ref().and_then(|lists| lists.budget.as_ref()) {
            stages.dispatch(stage, pass);
        }
    }
}

/// Prepares the compute jobs of a view's budget.
pub(super) fn prepared(
    gpu: &Gpu,
    layout: &Layout,
    pass: &BudgetPass,
    view: &Uniform<SelectView>,
    metrics: &Buffer<u32>,
    decisions: &Buffer<u32>,
    budget: &Budget,
) -> Result<BudgetStages, Error> {
    let buffers = BudgetBuffers {
        view,
        objects: &layout.objects,
        block_objects: &layout.block_objects,
        metrics,
        decisions,
        state: &budget.state,
        work: &budget.work,
    };
    pass.prepare(gpu, &budget.params, buffers)
}
