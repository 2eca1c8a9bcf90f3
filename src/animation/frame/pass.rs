//! A frame of a crowd under a gate in one piece, from the time to palettes: `decide`, `cursor`, `sample`, `local_to_model`, the
//! latter three for what is active alone, in one compute pass. Only in this order `bounded` keeps its promise: places are
//! looked up at the times that the gate saw.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::decide::{Choice, DecideJob, DecidePass, Dispatches};
use crate::animation::gate::Frame;
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::GateTable;
use crate::animation::keyframe_cursor::{KeyframeCursorJob, KeyframeCursorPass};
use crate::animation::local_to_model::{LocalToModelActiveJob, LocalToModelPass, Walk};
use crate::animation::model_matrices::ModelMatrices;
use crate::animation::order::Order;
use crate::animation::sample::{SampleActiveJob, SamplePass};
use crate::asset::skeleton::Skeleton;
use crate::gpu::{Gpu, compute_pass};

/// Prepared frames: set the time, then record.
#[derive(Debug, Clone)]
pub struct GatedFrame {
    /// What the gate knows; levels of detail may be written between frames.
    pub gate_state: GateState,
    /// What the frame that was recorded last did.
    pub active: Active,
    model_matrices: ModelMatrices,
    decide: DecideJob,
    cursor: KeyframeCursorJob,
    sample: SampleActiveJob,
    local_to_model: LocalToModelActiveJob,
}

impl GatedFrame {
    /// Compiles and prepares all of it for a crowd, in the ways that are fastest on this device. Rotations take the
    /// crowd's path.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a crowd of another skeleton, and a table of other bones or clips, of another
    /// kind than the choice needs, or of motion along another path than the crowd's ([`Crowd::path`]), and for
    /// [`Gate::Bounded`](crate::animation::gate::Gate::Bounded) over model matrices that dual quaternions were prepared to blend;
    /// [`GpuError`](crate::gpu::GpuError).
    pub fn new(
        gpu: &Gpu,
        skeleton: &Skeleton,
        clips: &ClipBuffers,
        crowd: &Crowd,
        table: &GateTable,
        choice: Choice,
    ) -> Result<Self, Error> {
        let gate_state = GateState::new(gpu, table, crowd)?;
        let active = Active::new(gpu, &Order::new(skeleton), crowd)?;
        let decide = DecidePass::new(gpu, choice, Dispatches::of(gpu, choice, &active))?;
        let sample = match crowd.layers {
            1 => SamplePass::new(gpu, crowd.path())?,
            _ => SamplePass::layered(gpu, crowd.path())?,
        };
        Ok(Self {
            decide: decide.prepare(gpu, clips, crowd, &gate_state, &active)?,
            cursor: KeyframeCursorPass::new(gpu)?.prepare_active(gpu, clips, crowd, &gate_state, &active)?,
            sample: sample.prepare_active(gpu, clips, crowd, &active.pairs)?,
            local_to_model: LocalToModelPass::new(gpu, Walk::of(gpu))?
                .prepare_active(gpu, skeleton, crowd, &active)?,
            model_matrices: crowd.model_matrices.with_updated_bones(&active.updated_bones),
            gate_state,
            active,
        })
    }

    /// What skinning takes: the crowd's model matrices, the bones that a frame updates, and the gate that decides so.
    pub fn model_matrices(&self) -> &ModelMatrices {
        &self.model_matrices
    }

    /// Chooses frame and time of the next submission: seconds since the instances' starts, which should follow the clock
    /// every few minutes: `f32` seconds grow coarse.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for seconds that are not finite; [`GpuError`](crate::gpu::GpuError).
    pub fn set(&self, gpu: &Gpu, frame: &Frame, elapsed: f32) -> Result<(), Error> {
        self.decide.set(gpu, frame, elapsed)?;
        self.cursor.set(gpu, elapsed)
    }

    /// As [`DecideJob::set_budget`].
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) where a gate decides; [`GpuError`](crate::gpu::GpuError).
    pub fn set_budget(&self, gpu: &Gpu, most: u32) -> Result<(), Error> {
        self.decide.set_budget(gpu, most)
    }

    /// Records the frame: afterwards the crowd's model matrices are those of the time.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.dispatch(&mut compute_pass(encoder, "animation"));
    }

    /// Adds the frame to a compute pass that is being recorded.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.dispatch_gate(pass);
        self.dispatch_sample(pass);
        self.dispatch_local_to_model(pass);
    }

    /// The frame's first part: which bones are active.
    pub fn dispatch_gate(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.decide.dispatch(pass);
    }

    /// The second part: places and samples of these.
    pub fn dispatch_sample(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.cursor.dispatch(pass);
        self.sample.dispatch(pass);
    }

    /// The third part: palettes of what lies below them.
    pub fn dispatch_local_to_model(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.local_to_model.dispatch(pass);
    }
}
