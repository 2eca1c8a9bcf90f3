//! A complete frame of a crowd under a gate, from the time to model matrices, in one compute pass. The steps are `clip_clock`,
//! `gate` (or `budget`) and `compact`, then `keyframe_cursor`, `sample` and `local_to_model` for active bones. The error bound of
//! [`Gate::Bounded`] needs this order: cursors must use the times that the gate used.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::clip_clock::{ClipClockJob, ClipClockPass};
use crate::animation::compact::{CompactJob, CompactPass};
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::gate::{Frame, Gate, GateJob, GatePass};
use crate::animation::gate_state::GateState;
use crate::animation::keyframe_cursor::{KeyframeCursorJob, KeyframeCursorPass};
use crate::animation::local_to_model::LocalToModelPass;
use crate::animation::model_matrices::ModelMatrices;
use crate::animation::order::Order;
use crate::animation::sample::SamplePass;
use crate::asset::skeleton::Skeleton;
use crate::gpu::{Gpu, Job, Upload, compute_pass};

/// A prepared frame of a crowd under a gate. In each frame, set the time, then record.
#[derive(Debug, Clone)]
pub struct GatedFrame {
    /// State that the gate keeps from frame to frame. The caller may write levels of detail between frames.
    pub state: GateState,
    /// Work lists of the last recorded frame.
    pub active: Active,
    model_matrices: ModelMatrices,
    /// Whether bones may be sampled ahead of the frame's time.
    leads: bool,
    clip_clock: ClipClockJob,
    gate: GateJob,
    lists: CompactJob,
    cursor: KeyframeCursorJob,
    sample: Job,
    local_to_model: Job,
}

impl GatedFrame {
    /// Compiles and prepares all passes of a frame. Rotations use the crowd's rotation path between keys.
    ///
    /// # Errors
    /// [`GpuError`](crate::gpu::GpuError) for errors of the device; [`InputError`](crate::InputError) in these cases:
    ///
    /// - the crowd is of another skeleton, or `clips` is not the crowd's clip set;
    /// - the gate's bones, clips or rotation path ([`Crowd::path`]) differ from the crowd's;
    /// - the gate is [`Gate::Bounded`], and the model matrices were prepared for dual quaternion blending.
    pub fn new(
        gpu: &Gpu,
        skeleton: &Skeleton,
        clips: &ClipBuffers,
        crowd: &Crowd,
        gate: &Gate,
    ) -> Result<Self, Error> {
        let state = GateState::new(gpu, crowd)?;
        let active = Active::new(gpu, &Order::new(skeleton), crowd)?;
        let sample = match crowd.layers {
            1 => SamplePass::new(gpu, crowd.path())?,
            _ => SamplePass::layered(gpu, crowd.path())?,
        };
        Ok(Self {
            leads: matches!(gate, Gate::Bounded(_)),
            clip_clock: ClipClockPass::new(gpu)?.prepare(gpu, clips, crowd, &state)?,
            gate: GatePass::new(gpu, gate)?.prepare(gpu, crowd, &state, &active)?,
            lists: CompactPass::new(gpu)?.prepare(gpu, crowd, &active)?,
            cursor: KeyframeCursorPass::new(gpu)?.prepare_active(gpu, clips, crowd, &state, &active)?,
            sample: sample.prepare_active(gpu, clips, crowd, &active.pairs)?,
            local_to_model: LocalToModelPass::new(gpu)?.prepare_active(gpu, skeleton, crowd, &active)?,
            model_matrices: crowd.model_matrices.with_updated_bones(&active.updated_bones),
            state,
            active,
        })
    }

    /// Input of skinning: handle to the crowd's model matrices, with a record of the bones that the frame updated.
    pub fn model_matrices(&self) -> &ModelMatrices {
        &self.model_matrices
    }

    /// Sets the gate's clock values and the time in seconds for the next submission. At `elapsed` 0, each instance is at the clip
    /// time `start`. Every few minutes, restart `elapsed` at 0 and give the instances new starts, because `f32` seconds lose
    /// precision.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) if a time is not within ±[`MAX_SECONDS`](crate::animation::instance::MAX_SECONDS);
    /// [`GpuError`](crate::gpu::GpuError) for errors of the device.
    pub fn set(&self, gpu: &Gpu, frame: &Frame, elapsed: f32) -> Result<(), Error> {
        self.set_through(&mut &*gpu, frame, elapsed)
    }

    /// Does the same as [`GatedFrame::set`], but writes through `upload`. With [`Staged`](crate::gpu::Staged) writes, one
    /// submission may contain several frames.
    ///
    /// # Errors
    /// Same as [`GatedFrame::set`].
    pub fn set_through(&self, upload: &mut impl Upload, frame: &Frame, elapsed: f32) -> Result<(), Error> {
        self.clip_clock.set_through(upload, elapsed, if self.leads { frame.ahead } else { 0.0 })?;
        self.gate.set_through(upload, frame)?;
        self.cursor.set_through(upload, elapsed)
    }

    /// Records the frame in a compute pass of its own. After the pass has run, the crowd's model matrices are valid for the set
    /// time.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, "animation"));
    }

    /// Records the frame in an open compute pass.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.dispatch_gate(pass);
        self.dispatch_sample(pass);
        self.dispatch_local_to_model(pass);
    }

    /// Records part 1 of 3 of the frame: the choice of active bones. It also notifies the readers of [`Active::updated_bones`].
    pub fn dispatch_gate(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.clip_clock.dispatch(pass);
        self.gate.dispatch(pass);
        self.lists.dispatch(pass);
    }

    /// Records part 2 of 3 of the frame: keyframe cursors and samples of the active bones.
    pub fn dispatch_sample(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.cursor.dispatch(pass);
        self.sample.dispatch(pass);
    }

    /// Records part 3 of 3 of the frame: model matrices of the active bones and all their descendants.
    pub fn dispatch_local_to_model(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.local_to_model.dispatch(pass);
    }
}
