//! The GPU pass of `kernels/animation/bounds.wgsl`.

use super::{Bounds, check_bone_radii};
use crate::animation::crowd::Crowd;
use crate::gpu::bind::SeenAs;
use crate::gpu::bindings::animation::bounds as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::animation::bounds::{BoundsParams, THREADS};
use crate::{Error, InputError};

impl SeenAs<[f32; 4]> for Bounds {}

/// The threads that handle the bones of one instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Threads {
    /// A workgroup, which gives enough threads to hardware.
    Workgroup,
    /// A single thread, without barriers, which are slow on adapters with few processors.
    Whole,
}

impl Threads {
    /// The faster choice for this kind of adapter.
    pub fn of(gpu: &Gpu) -> Self {
        if gpu.tuning().wants_long_threads() { Self::Whole } else { Self::Workgroup }
    }
}

/// Computes the bounds of instances.
#[derive(Debug, Clone)]
pub struct BoundsPass {
    kernel: Kernel,
    threads: Threads,
}

impl BoundsPass {
    /// Compiles the pipeline that is fastest on this kind of adapter.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Self::with_threads(gpu, Threads::of(gpu))
    }

    /// Compiles the pipeline for what takes the bones of an instance together.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn with_threads(gpu: &Gpu, threads: Threads) -> Result<Self, GpuError> {
        let whole = threads == Threads::Whole;
        Ok(Self { kernel: bindings::kernel(gpu, &bindings::Constants { whole })?, threads })
    }

    /// Prepares the bounds of a crowd's instances from its model matrices, with one radius per bone in metres.
    ///
    /// # Errors
    /// [`InputError`] for radii that do not match the crowd, for 2²⁶ instances or more, and for a buffer with
    /// less than one box per instance; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        crowd: &Crowd,
        bone_radii: &[f32],
        bounds: &Buffer<Bounds>,
    ) -> Result<Job, Error> {
        check_bone_radii(bone_radii, crowd.bones)?;
        bounds.check_holds("bounds", crowd.len())?;
        if crowd.len() >= 1 << 26 {
            return Err(InputError::new("crowd.len", crowd.len(), "must be below 2^26").into());
        }
        let params = BoundsParams { instances: crowd.len() as u32, bones: crowd.bones as u32 };
        let uniform = Uniform::new(gpu, "bounds", &params)?;
        let bone_radii = Buffer::from_slice(gpu, "bone_radii", bone_radii)?;
        let group = bindings::Group {
            params: &uniform,
            model_matrices: crowd.model_matrices.buffer().slice().cast(),
            bone_radii: bone_radii.slice(),
            bounds: bounds.slice().cast(),
        };
        let threads = match self.threads {
            Threads::Workgroup => THREADS * params.instances,
            Threads::Whole => params.instances,
        };
        let step = Step {
            groups: vec![group.bind(gpu, &self.kernel)?],
            workgroups: self.kernel.spread(gpu, threads),
            kernel: self.kernel.clone(),
        };
        Ok(Job::new(gpu, "animation/bounds", vec![step])?)
    }
}
