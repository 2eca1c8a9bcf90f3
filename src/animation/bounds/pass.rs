//! The GPU pass of `kernels/animation/bounds.wgsl`.

use super::{MotionBounds, check_bone_radii};
use crate::animation::crowd::Crowd;
use crate::gpu::bind::SeenAs;
use crate::gpu::bindings::animation::bounds as bindings;
use crate::gpu::{Buffer, Gpu, Job, Uniform, pass};
use crate::shared::animation::bounds::{BoundsParams, THREADS};
use crate::{Error, InputError};

impl SeenAs<[f32; 4]> for MotionBounds {}

pass! {
    /// Computes the bounding box of each animated instance on the GPU.
    pub struct BoundsPass;
}

impl BoundsPass {
    /// Prepares a job that computes the bounds of a crowd's instances from their model matrices. `bone_radii` has one radius per
    /// bone, in metres.
    ///
    /// # Errors
    /// [`InputError`] for invalid radii, for a number of radii other than the number of bones, for 2²⁶ instances or more, and if
    /// `bounds` is too small for one box per instance; [`crate::gpu::GpuError`] for errors of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        bone_radii: &[f32],
        bounds: &Buffer<MotionBounds>,
    ) -> Result<Job, Error> {
        check_bone_radii(bone_radii, crowd.bones)?;
        bounds.check_holds("bounds", crowd.len())?;
        InputError::check(crowd.len() < 1 << 26, "crowd.len", crowd.len(), || "must be below 2^26")?;
        let params = BoundsParams { instances: crowd.len() as u32, bones: crowd.bones as u32 };
        let uniform = Uniform::new(gpu, "bounds", &params)?;
        let bone_radii = Buffer::from_slice(gpu, "bone_radii", bone_radii)?;
        let group = bindings::Group {
            params: &uniform,
            model_matrices: crowd.model_matrices.buffer().slice().cast(),
            bone_radii: bone_radii.slice(),
            bounds: bounds.slice().cast(),
        };
        let (group, threads) = (group.bind(gpu, &self.kernel)?, THREADS * params.instances);
        Ok(Job::spread(gpu, "animation/bounds", &self.kernel, group, threads)?)
    }
}
