//! The GPU pass of `kernels/terrain/normals.wgsl`.

use crate::Error;
use crate::gpu::bindings::terrain::normals as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::terrain::normals::NormalsParams;
use crate::terrain::blocks::Columns;
use crate::terrain::config::{HEIGHT_ONE, check_terrain_scale};
use crate::terrain::fields::Fields;

/// Computes the slopes and unit normals of height fields.
#[derive(Debug, Clone)]
pub struct NormalsPass {
    kernel: Kernel,
    columns: Columns,
}

impl NormalsPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Self::with_columns(gpu, Columns::of(gpu.tuning()))
    }

    /// As [`NormalsPass::new`], with the given columns.
    pub fn with_columns(gpu: &Gpu, columns: Columns) -> Result<Self, GpuError> {
        let constants = bindings::Constants { quads: columns.quads, downwards: columns.order.downwards };
        Ok(Self { kernel: bindings::kernel(gpu, &constants)?, columns })
    }

    /// Prepares the slopes of `windows`, whose samples are `terrain_scale` world units apart. For every sample
    /// but those of the outermost ring, `gradients` receives the central differences in 1/65536 units, and
    /// `normals` three components (x, up, z).
    /// # Errors
    /// [`crate::InputError`] for a spacing out of bounds, for windows with nothing inside the outermost ring,
    /// and for outputs that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        terrain_scale: f64,
        windows: &Fields,
        gradients: &Buffer<[i32; 2]>,
        normals: &Buffer<f32>,
    ) -> Result<Job, Error> {
        check_terrain_scale(terrain_scale)?;
        windows.check("windows", 1)?;
        gradients.check_holds("gradients", windows.points(1))?;
        normals.check_holds("normals", 3 * windows.points(1))?;
        let blocks = self.columns.blocks_of_whole_vectors(windows);
        let run = (2.0 * terrain_scale * HEIGHT_ONE) as f32;
        let points = windows.points(1) as u32;
        let params = NormalsParams { blocks, in_width: windows.width, points, run };
        let uniform = Uniform::new(gpu, "normals", &params)?;
        let group = bindings::Group {
            params: &uniform,
            windows: windows.heights.slice().cast(),
            gradients: gradients.slice().cast(),
            normals: normals.slice().cast(),
        };
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![group.bind(gpu, &self.kernel)?],
            workgroups: blocks.workgroups(gpu, &self.kernel),
        };
        Ok(Job::new(gpu, "terrain/normals", vec![step])?)
    }
}
