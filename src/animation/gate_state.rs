//! Device buffers with the state that gates keep between frames.

use super::crowd::Crowd;
use super::lod::{Lod, PackedLod};
use crate::gpu::{Buffer, Gpu, GpuError};
use crate::shared::animation::gate_state::ClipClock;

/// State of a crowd that a gate keeps from frame to frame. The caller may read and bind all buffers.
#[derive(Debug, Clone)]
pub struct GateState {
    /// Level of detail of each instance, written by the host ([`GateState::write_lods`]) or by a kernel. Initially full detail.
    pub lods: Buffer<PackedLod>,
    /// Clip clock of each instance, written by [`crate::animation::clip_clock::ClipClockPass`].
    pub clip_clocks: Buffer<ClipClock>,
    /// Four words per instance. If all are zero, no pose is stored. The words are:
    ///
    /// - the last clip index + 1, with the skeleton tier from bit 24 on, and with the highest bit set if layers above the base had
    ///   weight;
    /// - a hash of the clips of these layers;
    /// - the last time inside the clip, as the bits of an `f32`;
    /// - the look-ahead time inside the clip, as the bits of an `f32`.
    pub history: Buffer<[u32; 4]>,
    /// For each slot of each instance, the accumulated motion at the time of the slot's last sample.
    pub sampled: Buffer<u32>,
}

impl GateState {
    /// Allocates the state of a crowd that has not been sampled yet.
    ///
    /// # Errors
    /// [`GpuError`] if the device has no memory for the buffers.
    pub fn new(gpu: &Gpu, crowd: &Crowd) -> Result<Self, GpuError> {
        let instances = crowd.len();
        Ok(Self {
            lods: Buffer::from_slice(gpu, "lods", &vec![Lod::FULL.packed(); instances])?,
            clip_clocks: Buffer::new(gpu, "clip_clocks", instances)?,
            history: Buffer::new(gpu, "history", instances)?,
            sampled: Buffer::new(gpu, "sampled", crowd.pairs())?,
        })
    }

    /// Replaces the levels of detail of the first `lods.len()` instances. Later submissions use them.
    ///
    /// # Errors
    /// [`GpuError::Validation`] for more levels of detail than instances.
    pub fn write_lods(&self, gpu: &Gpu, lods: &[Lod]) -> Result<(), GpuError> {
        self.lods.write(gpu, &lods.iter().map(Lod::packed).collect::<Vec<_>>())
    }
}
