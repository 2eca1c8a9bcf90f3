//! `kernels/terrain/border.wgsl`, wave by wave.

use encase::ShaderType;

use super::{Neighbours, waves};
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `BorderParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct BorderParams {
    pub size: u32,
    pub width: u32,
    pub points: u32,
    pub start: u32,
}

/// Moves border samples of patches towards patches that exist already.
#[derive(Debug, Clone)]
pub struct BorderPass {
    kernel: Kernel,
}

impl BorderPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::TERRAIN_BORDER, &[])? })
    }

    /// Prepares the transition of `width` samples for patches of `size`² heights that lie in `heights` one
    /// after the other; `neighbours` are indices of earlier ones.
    ///
    /// # Errors
    /// [`InputError`] as [`waves`], and for a width outside 1..`size` or heights that are too short;
    /// [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        size: u32,
        width: u32,
        neighbours: &[Neighbours],
        heights: &Buffer<i32>,
    ) -> Result<Job, Error> {
        if width == 0 || width >= size {
            let bound = format!("must be at least 1 and below size = {size}");
            return Err(InputError::new("width", width, bound).into());
        }
        heights.check_holds("heights", neighbours.len() * (size as usize).pow(2))?;
        let waves = waves(neighbours)?;
        let around: Vec<[u32; 4]> = (neighbours.iter())
            .map(|around| around.map(|neighbour| neighbour.map_or(u32::MAX, |index| index as u32)))
            .collect();
        let around = Buffer::from_slice(gpu, "neighbours", &around)?;
        let order = Buffer::from_slice(gpu, "blend order", &waves.concat())?;
        let mut steps = Vec::new();
        let mut start = 0;
        for wave in &waves {
            let count = wave.len() as u32;
            let params = BorderParams { size, width, points: size * size, start };
            let uniform = Uniform::new(gpu, "border", &params)?;
            let resources = [
                uniform.raw().as_entire_binding(),
                heights.raw().as_entire_binding(),
                around.raw().as_entire_binding(),
                order.raw().as_entire_binding(),
            ];
            let groups = vec![self.kernel.bind(gpu, 0, &resources)?];
            let workgroups = [self.kernel.groups_for(size), size, count];
            steps.push(Step { kernel: self.kernel.clone(), groups, workgroups });
            start += count;
        }
        Ok(Job::new(gpu, "terrain/border", steps)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(border_params_layout: BorderParams = TERRAIN_BORDER "BorderParams");
}
