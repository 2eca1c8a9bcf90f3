//! `kernels/terrain/pad.wgsl`.

use encase::ShaderType;

use super::{Surround, validate};
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `PadParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct PadParams {
    pub size: u32,
    pub reach: u32,
}

/// Gathers windows from patches and their neighbours.
#[derive(Debug, Clone)]
pub struct PadPass {
    kernel: Kernel,
}

impl PadPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::TERRAIN_PAD, &[])? })
    }

    /// Prepares windows that reach `reach` samples beyond patches of `size`² heights, one for each of
    /// `surrounds`, from `patches` to `windows`.
    ///
    /// # Errors
    /// [`InputError`] when the reach is `size` or more, a surrounding lacks its own patch or names one beyond
    /// `patches`, or `windows` is too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        [size, reach]: [u32; 2],
        surrounds: &[Surround],
        patches: &Buffer<i32>,
        windows: &Buffer<i32>,
    ) -> Result<Job, Error> {
        validate(size, reach)?;
        let width = size + 2 * reach;
        check_surrounds(surrounds, patches.len() / (size as usize).pow(2).max(1))?;
        windows.check_holds("windows", surrounds.len() * (width as usize).pow(2))?;
        let around: Vec<u32> =
            (surrounds.iter().flatten()).map(|tile| tile.map_or(u32::MAX, |index| index as u32)).collect();
        let around = Buffer::from_slice(gpu, "surroundings", &around)?;
        let uniform = Uniform::new(gpu, "pad", &PadParams { size, reach })?;
        let resources = [
            uniform.raw().as_entire_binding(),
            patches.raw().as_entire_binding(),
            around.raw().as_entire_binding(),
            windows.raw().as_entire_binding(),
        ];
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: [self.kernel.groups_for(width), width, surrounds.len() as u32],
        };
        Ok(Job::new(gpu, "terrain/pad", vec![step])?)
    }
}

/// Checks that every patch is there itself, and that all of them are among `count`.
fn check_surrounds(surrounds: &[Surround], count: usize) -> Result<(), InputError> {
    for (index, around) in surrounds.iter().enumerate() {
        if around[4].is_none() {
            return Err(InputError::new(
                format!("surrounds[{index}][4]"),
                "none",
                "must be the patch itself",
            ));
        }
        if let Some(beyond) = around.iter().flatten().find(|patch| **patch >= count) {
            let bound = format!("must be below {count}, the patches in the buffer");
            return Err(InputError::new(format!("surrounds[{index}]"), beyond, bound));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(pad_params_layout: PadParams = TERRAIN_PAD "PadParams");
}
