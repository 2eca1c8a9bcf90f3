//! The GPU pass of `kernels/terrain/hydraulic.wgsl`, one or two cycles per dispatch.

use super::reference::Flow;
use super::{Hydraulic, HydraulicParams};
use crate::Error;
use crate::gpu::bindings::terrain::hydraulic as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::terrain::blocks::Blocks;
use crate::terrain::config::check_terrain_scale;
use crate::terrain::fields::Fields;

/// What a thread makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Cycles of a dispatch, 1 or 2.
    pub cycles: u32,
    /// Rows of samples, at least 1.
    pub rows: u32,
}

impl Shape {
    /// Hardware runs many short threads best, with few registers.
    pub const HARDWARE: Self = Self { cycles: 1, rows: 4 };

    /// On software adapters loads and stores take most of the time, and two cycles of a dispatch share them.
    pub const SOFTWARE: Self = Self { cycles: 2, rows: 43 };
}

/// What erosion reads and writes.
#[derive(Debug, Clone, Copy)]
pub struct HydraulicBuffers<'a> {
    /// Read and written: the windows.
    pub windows: &'a Fields,
    /// Written: fields with room for as many windows that are a sample smaller on every side.
    pub other: &'a Fields,
    /// Written: scratch for water and sediment, with room for the samples of `other`.
    pub flows: &'a Buffer<Flow>,
    /// As `flows`.
    pub other_flows: &'a Buffer<Flow>,
}

/// Applies hydraulic erosion.
#[derive(Debug, Clone)]
pub struct HydraulicPass {
    /// The kernels that make one cycle, and two: the last one makes as many as a dispatch makes if it can.
    kernels: Vec<Kernel>,
    rows: u32,
}

impl HydraulicPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        let is_software = gpu.tuning().wants_long_threads();
        Self::with_shape(gpu, if is_software { Shape::SOFTWARE } else { Shape::HARDWARE })
    }

    /// As [`HydraulicPass::new`], with threads of this shape.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn with_shape(gpu: &Gpu, shape: Shape) -> Result<Self, Error> {
        let kernel = |cycles| bindings::kernel(gpu, &bindings::Constants { cycles });
        let kernels = (1..=shape.cycles).map(kernel).collect::<Result<_, _>>()?;
        Ok(Self { kernels, rows: shape.rows })
    }

    /// The number of dispatches of so many cycles. The result of an even number lies in [`HydraulicBuffers::windows`], else in
    /// [`HydraulicBuffers::other`].
    pub fn dispatches(&self, iterations: u32) -> u32 {
        iterations.div_ceil(self.kernels.len() as u32)
    }

    /// The number of elements that [`HydraulicBuffers::flows`] needs for windows.
    pub fn flow_points(windows: &Fields) -> usize {
        windows.points(1)
    }

    /// Prepares all cycles. Their dispatches alternate between `windows` and `other` (see [`HydraulicPass::dispatches`]), and each
    /// cycle drops the outermost ring of samples. Windows are at most 2^30 − 1 high, in 1/65536 units, and so is the result.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for parameters out of bounds, for windows that have too few rings for the cycles, and for a buffer that
    /// is too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        hydraulic: Hydraulic,
        terrain_scale: f64,
        buffers: HydraulicBuffers<'_>,
    ) -> Result<Job, Error> {
        let HydraulicBuffers { windows, other, flows, other_flows } = buffers;
        hydraulic.validate()?;
        check_terrain_scale(terrain_scale)?;
        windows.check("windows", hydraulic.iterations)?;
        if hydraulic.iterations > 0 {
            let points = Self::flow_points(windows);
            other.heights.check_holds("other.heights", points)?;
            flows.check_holds("flows", points)?;
            other_flows.check_holds("other_flows", points)?;
        }
        let cycles = self.kernels.len() as u32;
        let steps = (0..self.dispatches(hydraulic.iterations)).map(|dispatch| {
            let sides = [(windows, flows), (other, other_flows)];
            let sides = if dispatch % 2 == 0 { sides } else { [sides[1], sides[0]] };
            let first = dispatch * cycles;
            let last = (first + cycles).min(hydraulic.iterations) - 1;
            let in_width = windows.cropped(first).width;
            let behind = hydraulic.params(terrain_scale, last, in_width);
            let params = HydraulicParams {
                settles: behind.settles,
                second_rain: behind.rain,
                ..hydraulic.params(terrain_scale, first, in_width)
            };
            let kernel = &self.kernels[(last - first) as usize];
            let made = windows.cropped(last + 1);
            let blocks = Blocks::of_squares(made.width, 4 * (last + 1 - first), self.rows, made.count);
            let group = bindings::Group {
                params: &Uniform::new(gpu, "hydraulic", &params)?,
                windows: sides[0].0.heights.slice(),
                outputs: sides[1].0.heights.slice(),
                flows: sides[0].1.slice(),
                flow_outputs: sides[1].1.slice(),
                blocks: &Uniform::new(gpu, "blocks", &blocks)?,
            };
            let groups = vec![group.bind(gpu, kernel)?];
            Ok(Step { kernel: kernel.clone(), groups, workgroups: blocks.workgroups(gpu, kernel) })
        });
        let steps = steps.collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "terrain/hydraulic", steps)?)
    }
}
