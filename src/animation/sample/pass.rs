//! The GPU pass of `kernels/animation/sample.wgsl`.

use crate::animation::active::ActivePairs;
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::asset::keyframe::{KeyframeCursor, RotationPath};
use crate::gpu::bind::SeenAs;
use crate::gpu::bindings::animation::sample as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Job, Kernel, Step, Uniform};
use crate::shared::animation::sample::SampleParams;
use crate::{Error, InputError};

impl SeenAs<[u32; 2]> for KeyframeCursor {}

/// Samples the local transforms of a crowd's bones on the GPU.
#[derive(Debug, Clone)]
pub struct SamplePass {
    // Two kernels: the first for clip sets without splines, the second for sets with splines.
    all: [Kernel; 2],
    compacted: [Kernel; 2],
    is_layered: bool,
    path: RotationPath,
}

impl SamplePass {
    /// Compiles the pipelines for crowds with one layer. `path` is the rotation path between keys.
    ///
    /// # Errors
    /// [`GpuError`] for shader compilation errors of the driver.
    pub fn new(gpu: &Gpu, path: RotationPath) -> Result<Self, GpuError> {
        Self::compile(gpu, path, false)
    }

    /// Compiles the pipelines for crowds with any number of layers. `path` is the rotation path between keys. Between layers,
    /// rotations are always blended along the chord.
    ///
    /// # Errors
    /// [`GpuError`] for shader compilation errors of the driver.
    pub fn layered(gpu: &Gpu, path: RotationPath) -> Result<Self, GpuError> {
        Self::compile(gpu, path, true)
    }

    fn compile(gpu: &Gpu, path: RotationPath, is_layered: bool) -> Result<Self, GpuError> {
        let nlerp = path == RotationPath::Nlerp;
        let kernel = |compacted, splines| {
            bindings::kernel(gpu, &bindings::Constants { compacted, layered: is_layered, nlerp, splines })
        };
        let kernels = |compacted| Ok::<_, GpuError>([kernel(compacted, false)?, kernel(compacted, true)?]);
        Ok(Self { all: kernels(false)?, compacted: kernels(true)?, is_layered, path })
    }

    /// Prepares a job that samples every bone of every instance, at the crowd's keyframe cursors.
    ///
    /// # Errors
    /// [`InputError`] if the crowd has several layers and the pass is not [`SamplePass::layered`], and if the crowd has another
    /// rotation path ([`Crowd::path`]); [`GpuError`] for errors of the device.
    pub fn prepare(&self, gpu: &Gpu, clips: &ClipBuffers, crowd: &Crowd) -> Result<Job, Error> {
        self.check(crowd)?;
        let pairs = Buffer::new(gpu, "no pairs", 0)?;
        let dispatched = Buffer::from_slice(gpu, "no pairs", &[0; 4])?;
        let kernel = &self.all[usize::from(clips.has_splines)];
        let group = bind(kernel, gpu, clips, crowd, [&pairs, &dispatched])?;
        Ok(Job::spread(gpu, "animation/sample", kernel, group, crowd.pairs() as u32)?)
    }

    /// Prepares a job that samples the active (instance, bone) pairs. All other local transforms stay unchanged.
    ///
    /// # Errors
    /// [`InputError`] for the errors of [`SamplePass::prepare`], and if `active` belongs to another crowd; [`GpuError`] for
    /// errors of the device.
    pub fn prepare_active(
        &self,
        gpu: &Gpu,
        clips: &ClipBuffers,
        crowd: &Crowd,
        active: &ActivePairs,
    ) -> Result<Job, Error> {
        self.check(crowd)?;
        active.check_crowd(crowd)?;
        let kernel = &self.compacted[usize::from(clips.has_splines)];
        let group = bind(kernel, gpu, clips, crowd, [&active.pairs, &active.dispatched])?;
        let step = Step::indirect(kernel, group, active.dispatched.raw(), 0);
        Ok(Job::new(gpu, "animation/sample", vec![step])?)
    }

    fn check(&self, crowd: &Crowd) -> Result<(), InputError> {
        if crowd.path() != self.path {
            let bound = format!("must be {:?}, as the sampling pass's: Crowd::with_path", self.path);
            return Err(InputError::new("crowd.path", format!("{:?}", crowd.path()), bound));
        }
        if self.is_layered || crowd.layers == 1 {
            return Ok(());
        }
        Err(InputError::new("crowd.layers", crowd.layers, "must be 1, or the pass SamplePass::layered"))
    }
}

fn bind(
    kernel: &Kernel,
    gpu: &Gpu,
    clips: &ClipBuffers,
    crowd: &Crowd,
    [pairs, dispatched]: [&Buffer<u32>; 2],
) -> Result<Group, GpuError> {
    let params = SampleParams {
        bones: crowd.bones as u32,
        timelines: clips.timelines_a_clip as u32,
        pairs: crowd.pairs() as u32,
        instances: crowd.len() as u32,
        layers: crowd.layers as u32,
    };
    let uniform = Uniform::new(gpu, "sample", &params)?;
    let group = bindings::Group {
        params: &uniform,
        instances: crowd.instances.slice(),
        tracks: clips.tracks.slice(),
        values: clips.values.slice(),
        cursors: crowd.cursors.slice().cast(),
        pairs: pairs.slice(),
        dispatched: dispatched.slice().cast(),
        locals: crowd.locals.slice().cast(),
        layer_weights: crowd.layer_weights.slice(),
    };
    group.bind(gpu, kernel)
}
