//! The GPU pass of `kernels/skinning/lod.wgsl`.

use std::mem::offset_of;

use glam::Vec4;

use super::{LodView, list_stride, list_words};
use crate::asset::transform::Affine;
use crate::gpu::bind::SeenAs;
use crate::gpu::bindings::skinning::lod as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::skinning::lod::{Arguments, Draw, LodParams};
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::picture::is_mirrored;
use crate::{Error, InputError};

impl SeenAs<Arguments> for u32 {}

impl LodParams {
    fn new(view: &LodView, instances: usize) -> Self {
        let begins = view.levels.distances();
        let begin = |at: usize| begins.get(at).copied().unwrap_or(f32::MAX);
        Self {
            planes: view.planes(),
            eye: view.eye.extend(view.fade_range.start),
            ahead: view.ahead().map_or(Vec4::ZERO, |ahead| ahead.extend(1.0)),
            bounding_sphere: view.center.extend(view.radius),
            fade_end: view.fade_range.end,
            steps: view.steps as f32,
            instances: instances as u32,
            max_influences: view.max_influences,
            distances: std::array::from_fn(|at| {
                Vec4::from_array(std::array::from_fn(|lane| begin(4 * at + lane)))
            }),
            coarser: begins.len() as u32,
            stride: list_stride(instances) as u32,
            side: if is_mirrored(&view.clip_from_world) { -1.0 } else { 1.0 },
        }
    }
}

/// Words of a level's arguments: those of its draw, and of its draw of mirrored instances.
const LEVEL_WORDS: usize = size_of::<Arguments>() / size_of::<u32>();

/// The byte offsets at which the two draws of a level begin.
pub(crate) fn draws_at(level: usize) -> [u64; 2] {
    [offset_of!(Arguments, listed), offset_of!(Arguments, mirrored)]
        .map(|draw| (size_of::<Arguments>() * level + draw) as u64)
}

/// The byte offsets of the numbers of instances of a level's two draws.
pub(crate) fn numbers_at(level: usize) -> [u64; 2] {
    draws_at(level).map(|draw| draw + offset_of!(Draw, instances) as u64)
}

/// What the decisions read and write.
#[derive(Debug, Clone, Copy)]
pub struct LodBuffers<'a> {
    /// The transform of each instance from the model's space into the world.
    pub placements: &'a Buffer<Affine>,
    /// Written: one for each instance.
    pub instance_lods: &'a Buffer<InstanceLod>,
    /// Written: for each level of the view the list of instances that are seen, all together [`list_words`] words.
    pub drawn: &'a Buffer<u32>,
    /// Written in part: two indirect indexed draws for each level, of five words each; the first is to show instances that are
    /// not mirrored, or all if both sides are seen, and the second those that are. Written are the second word, which
    /// is the number of instances in the level's list, and the seventh, which is the length of the list up to its last
    /// mirrored instance.
    pub arguments: &'a Buffer<u32>,
}

/// Decides visibility, fade and level of detail.
#[derive(Debug, Clone)]
pub struct LodPass {
    kernel: Kernel,
}

impl LodPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the decisions for all instances.
    ///
    /// # Errors
    /// [`InputError`] for a view out of range and for buffers that are too small; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, view: &LodView, buffers: LodBuffers<'_>) -> Result<LodJob, Error> {
        let LodBuffers { placements, instance_lods, drawn, arguments } = buffers;
        view.validate()?;
        let instances = placements.len();
        instance_lods.check_holds("instance_lods", instances)?;
        let levels = 1 + view.levels.distances().len();
        drawn.check_holds("drawn", list_words(instances, levels))?;
        arguments.check_holds("arguments", LEVEL_WORDS * levels)?;
        let uniform = Uniform::new(gpu, "lod", &LodParams::new(view, instances))?;
        let group = bindings::Group {
            params: &uniform,
            placements: placements.slice().cast(),
            instance_lods: instance_lods.slice(),
            drawn: drawn.slice(),
            arguments: arguments.slice().cast(),
        };
        let step = Step {
            groups: vec![group.bind(gpu, &self.kernel)?],
            workgroups: self.kernel.spread(gpu, instances as u32),
            kernel: self.kernel.clone(),
        };
        let job = Job::new(gpu, "skinning/lod", vec![step])?;
        Ok(LodJob { job, uniform, arguments: arguments.clone(), instances, levels })
    }
}

/// Prepared decisions.
#[derive(Debug, Clone)]
pub struct LodJob {
    job: Job,
    uniform: Uniform<LodParams>,
    arguments: Buffer<u32>,
    instances: usize,
    levels: usize,
}

impl LodJob {
    /// Sets the view of the next submission.
    ///
    /// # Errors
    /// [`InputError`] for a view out of range, and for one with more levels than the prepared view;
    /// [`GpuError`].
    pub fn set(&self, gpu: &Gpu, view: &LodView) -> Result<(), Error> {
        view.validate()?;
        let coarser = view.levels.distances().len();
        if coarser >= self.levels {
            let bound = format!("must be below {}, the levels that were prepared", self.levels);
            return Err(InputError::new("view.levels.len", coarser, bound).into());
        }
        Ok(self.uniform.write(gpu, &LodParams::new(view, self.instances))?)
    }

    /// Records the decisions.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        Self::record_together(encoder, [self]);
    }

    /// Records the decisions on several crowds, in one compute pass.
    pub fn record_together<'a>(
        encoder: &mut wgpu::CommandEncoder,
        all: impl IntoIterator<Item = &'a Self, IntoIter: Clone>,
    ) {
        let all = all.into_iter();
        // Clears the numbers of instances.
        for lod in all.clone() {
            for number in (0..lod.levels).flat_map(numbers_at) {
                encoder.clear_buffer(lod.arguments.raw(), number, Some(4));
            }
        }
        let descriptor = wgpu::ComputePassDescriptor { label: Some("skinning/lod"), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        all.for_each(|lod| lod.job.dispatch(&mut pass));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Options;
    use crate::skinning::FadeRange;
    use crate::skinning::lod::{LevelRanges, placed};
    use glam::{Mat4, Vec3};

    /// Lists of levels that a view no longer has become empty; more levels than there are lists are refused.
    #[test]
    fn views_may_have_fewer_levels() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let view = |distances: &[f32]| LodView {
            clip_from_world: Mat4::IDENTITY,
            eye: Vec3::ZERO,
            fade_range: FadeRange::NEVER,
            steps: 1,
            max_influences: 8,
            center: Vec3::ZERO,
            radius: 10.0,
            levels: LevelRanges::new(distances).expect("ascending"),
        };
        let placements = [0.5, 1.5, 2.5, 3.5].map(|x| placed(Vec3::X * x, 0.0, 1.0));
        let placements = Buffer::from_slice(&gpu, "placements", &placements).expect("uploaded");
        let instance_lods = Buffer::new(&gpu, "instance_lods", 4).expect("allocated");
        let drawn = Buffer::new(&gpu, "drawn", list_words(4, 3)).expect("allocated");
        let arguments = Buffer::new(&gpu, "arguments", 30).expect("allocated");
        let pass = LodPass::new(&gpu).expect("compiled");
        let buffers = LodBuffers {
            placements: &placements,
            instance_lods: &instance_lods,
            drawn: &drawn,
            arguments: &arguments,
        };
        let prepare = |view: &LodView| pass.prepare(&gpu, view, buffers);
        let lod = prepare(&view(&[1.0, 2.0])).expect("prepared");
        let seen = || {
            gpu.run("lod", |encoder| lod.record(encoder)).expect("run");
            let words = arguments.read_blocking(&gpu).expect("read");
            [words[1], words[11], words[21]]
        };
        assert_eq!(seen(), [1, 1, 2]);
        for (distances, counts) in [(&[3.0][..], [3, 1, 0]), (&[], [4, 0, 0]), (&[0.0, 3.0], [0, 3, 1])] {
            lod.set(&gpu, &view(distances)).expect("set");
            assert_eq!(seen(), counts);
        }
        let field = |error: Option<Error>| error.expect("refused").to_string();
        assert!(field(lod.set(&gpu, &view(&[0.0; 3])).err()).contains("view.levels.len = 3"));
        assert!(field(prepare(&view(&[0.0; 3])).err()).contains("drawn"));
    }
}
