//! The state of gates on the device.

use super::crowd::Crowd;
use super::gate_table::{GateTable, Kind, check_path};
use super::lod::Lod;
use crate::asset::keyframe::RotationPath;
use crate::gpu::{Buffer, Gpu};
use crate::shared::animation::gate_state::ClipClock;
use crate::{Error, InputError};

/// The state of a crowd by which gates decide. The caller may read and bind all buffers.
#[derive(Debug, Clone)]
pub struct GateState {
    /// One level of detail per instance, written by the host; full detail at first.
    pub lods: Buffer<Lod>,
    /// The clip clocks that [`crate::animation::clip_clock::ClipClockPass`] writes.
    pub clip_clocks: Buffer<ClipClock>,
    /// For each instance: the last clip + 1, with the highest bit set if layers were above it; a hash of what
    /// these layers played; and, as bits, the last time inside the clip and the time ahead. Zeros mean that no
    /// pose is stored.
    pub history: Buffer<[u32; 4]>,
    /// For each slot of each instance, the sum of motion when it was last sampled.
    pub sampled: Buffer<u32>,
    /// For each slot of each instance, what it leaves of the error budget, where that is needed later.
    pub(crate) remaining: Buffer<u32>,
    /// For each clip the bones that it moves.
    pub(crate) animated_bones: Buffer<u32>,
    /// The rows of the table.
    pub(crate) table: Buffer<[u32; 2]>,
    pub(crate) words: u32,
    pub(crate) stride: u32,
    pub(crate) first_above: u32,
    pub(crate) kind: Kind,
    path: Option<RotationPath>,
}

impl GateState {
    /// Uploads a table and allocates the state of a crowd.
    ///
    /// # Errors
    /// [`InputError`] for a table with another number of bones; [`GpuError`](crate::gpu::GpuError).
    pub fn new(gpu: &Gpu, table: &GateTable, crowd: &Crowd) -> Result<Self, Error> {
        if table.bones() != crowd.bones {
            let bound = format!("must be {}, as the crowd's", crowd.bones);
            return Err(InputError::new("table.bones", table.bones(), bound).into());
        }
        let instances = crowd.len();
        Ok(Self {
            lods: Buffer::from_slice(gpu, "lods", &vec![Lod::FULL; instances])?,
            clip_clocks: Buffer::new(gpu, "clip_clocks", instances)?,
            history: Buffer::new(gpu, "history", instances)?,
            sampled: Buffer::new(gpu, "sampled", crowd.pairs())?,
            remaining: Buffer::new(
                gpu,
                "remaining",
                if table.kind() == Kind::Bounds { crowd.pairs() } else { 0 },
            )?,
            animated_bones: Buffer::from_slice(gpu, "animated_bones", table.animated_bones())?,
            table: Buffer::from_slice(gpu, "gate table", table.rows())?,
            words: table.words() as u32,
            stride: table.stride() as u32,
            first_above: table.above(0),
            kind: table.kind(),
            path: table.path(),
        })
    }

    /// Refuses a table of a kind that the gate cannot use, and one of another rotation path than the crowd's.
    pub(crate) fn check(&self, needed: Option<Kind>, crowd: &Crowd) -> Result<(), InputError> {
        needed.map_or(Ok(()), |needed| self.kind.check(needed))?;
        check_path(self.path, crowd.path())
    }
}
