//! Gate tables in device buffers.

use super::{AnimatedBones, BoundTable, ExpectationTable, PriorityTable, check_path};
use crate::InputError;
use crate::animation::crowd::Crowd;
use crate::asset::keyframe::RotationPath;
use crate::gpu::{Buffer, Gpu, GpuError};

/// A gate table on the device.
#[derive(Debug, Clone)]
pub(crate) struct TableBuffers {
    pub animated_bones: Buffer<u32>,
    pub rows: Buffer<[u32; 2]>,
    /// Number of table entries per row.
    pub stride: u32,
    /// Number of 32-bit words per instance that hold one bit per bone.
    pub words: u32,
    /// Number of clips.
    pub clips: u32,
    /// Number of skeleton tiers.
    pub tiers: u32,
    bones: usize,
    /// Rotation path that the motion was computed for; `None` for a table without motion.
    path: Option<RotationPath>,
}

impl TableBuffers {
    pub fn of_animated_bones(gpu: &Gpu, table: &AnimatedBones) -> Result<Self, GpuError> {
        // Placeholder row: gates that use only the animated bones read no entry.
        Self::new(gpu, table, &[[0; 2]], 0, None)
    }

    pub fn of_priorities(gpu: &Gpu, table: &PriorityTable) -> Result<Self, GpuError> {
        Self::new(gpu, table.animated_bones(), table.rows(), table.stride(), None)
    }

    pub fn of_bounds(gpu: &Gpu, table: &BoundTable) -> Result<Self, GpuError> {
        let bones = table.animated_bones();
        Self::new(gpu, bones, table.rows(), bones.bones(), Some(table.path()))
    }

    pub fn of_expectations(gpu: &Gpu, table: &ExpectationTable) -> Result<Self, GpuError> {
        let bones = table.animated_bones();
        Self::new(gpu, bones, table.rows(), bones.bones(), Some(table.path()))
    }

    fn new(
        gpu: &Gpu,
        bones: &AnimatedBones,
        rows: &[[u32; 2]],
        stride: usize,
        path: Option<RotationPath>,
    ) -> Result<Self, GpuError> {
        Ok(Self {
            animated_bones: Buffer::constant(gpu, "animated bones", bones.records())?,
            rows: Buffer::constant(gpu, "gate table", rows)?,
            stride: stride as u32,
            words: bones.words() as u32,
            clips: bones.clips() as u32,
            tiers: bones.tiers() as u32,
            bones: bones.bones(),
            path,
        })
    }

    /// Returns an error if the bones, clips or rotation path of `crowd` differ from the table's.
    pub fn check(&self, crowd: &Crowd) -> Result<(), InputError> {
        InputError::check_same("table.bones", self.bones, crowd.bones, "as the crowd's")?;
        InputError::check_same("table.clips", self.clips as usize, crowd.clips, "as the crowd's")?;
        check_path(self.path, crowd.path())
    }
}
