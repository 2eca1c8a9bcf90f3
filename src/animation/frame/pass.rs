//! A frame of a crowd under a gate in one piece, from the time to palettes: `decide`, `place`, `sample`, `concat`, the
//! latter three for what is active alone, in one compute pass. Only in this order `bounded` keeps its promise: places are
//! looked up at the times that the gate saw.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::concat::{ConcatActiveJob, ConcatPass, Walk};
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::decide::{Choice, DecideJob, DecidePass, Dispatches};
use crate::animation::gate::Frame;
use crate::animation::gate_table::GateTable;
use crate::animation::gating::Gating;
use crate::animation::model_matrices::ModelMatrices;
use crate::animation::order::Order;
use crate::animation::place::{PlaceJob, PlacePass};
use crate::animation::sample::{SampleActiveJob, SamplePass};
use crate::asset::skeleton::Skeleton;
use crate::gpu::{Gpu, compute_pass};

/// Prepared frames: set the time, then record.
#[derive(Debug, Clone)]
pub struct GatedFrame {
    /// What the gate knows; levels of detail may be written between frames.
    pub gating: Gating,
    /// What the frame that was recorded last did.
    pub active: Active,
    model_matrices: ModelMatrices,
    decide: DecideJob,
    place: PlaceJob,
    sample: SampleActiveJob,
    concat: ConcatActiveJob,
}

impl GatedFrame {
    /// Compiles and prepares all of it for a crowd, in the ways that are fastest on this device. Rotations take the
    /// crowd's path.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for a crowd of another skeleton, and a table of other bones or clips, of another
    /// kind than the choice needs, or of motion along another path than the crowd's ([`Crowd::path`]), and for
    /// [`Gate::Bounded`](super::Gate::Bounded) over model matrices that dual quaternions were prepared to blend;
    /// [`GpuError`](crate::gpu::GpuError).
    pub fn new(
        gpu: &Gpu,
        skeleton: &Skeleton,
        clips: &ClipBuffers,
        crowd: &Crowd,
        table: &GateTable,
        choice: Choice,
    ) -> Result<Self, Error> {
        let gating = Gating::new(gpu, table, crowd)?;
        let active = Active::new(gpu, &Order::new(skeleton), crowd)?;
        let decide = DecidePass::new(gpu, choice, Dispatches::of(gpu, choice, &active))?;
        let sample = match crowd.layers {
            1 => SamplePass::new(gpu, crowd.path())?,
            _ => SamplePass::layered(gpu, crowd.path())?,
        };
        Ok(Self {
            decide: decide.prepare(gpu, clips, crowd, &gating, &active)?,
            place: PlacePass::new(gpu)?.prepare_active(gpu, clips, crowd, &gating, &active)?,
            sample: sample.prepare_active(gpu, clips, crowd, &active.pairs)?,
            concat: ConcatPass::new(gpu, Walk::of(gpu))?.prepare_active(gpu, skeleton, crowd, &active)?,
            model_matrices: crowd.model_matrices.with_updated_bones(&active.dirty),
            gating,
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
        self.place.set(gpu, elapsed)
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
        self.dispatch_concat(pass);
    }

    /// The frame's first part: which bones are active.
    pub fn dispatch_gate(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.decide.dispatch(pass);
    }

    /// The second part: places and samples of these.
    pub fn dispatch_sample(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.place.dispatch(pass);
        self.sample.dispatch(pass);
    }

    /// The third part: palettes of what lies below them.
    pub fn dispatch_concat(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.concat.dispatch(pass);
    }
}
