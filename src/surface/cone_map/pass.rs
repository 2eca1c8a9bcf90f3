//! The GPU pass of `kernels/surface/cone_map.wgsl`.

use glam::UVec2;

use crate::gpu::bindings::surface::cone_map as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::surface::cone_map::ConeParams;
use crate::surface::height_batch::{HeightBatch, with_remedy};
use crate::surface::height_pyramid::Pyramids;
use crate::{Error, InputError};

/// The cone maps of a batch, one after another.
#[derive(Debug, Clone)]
pub struct Cones {
    /// Highest corner and radius of each cell, in rows of `pitch`.
    pub cones: Buffer<[f32; 2]>,
    /// Cells along x and y.
    pub cells: [u32; 2],
    /// Cones per row, padded so that rows can be copied to a texture.
    pub pitch: u32,
    /// Number of maps.
    pub count: u32,
}

/// Computes cone maps.
#[derive(Debug, Clone)]
pub struct ConeMapPass {
    kernel: Kernel,
}

impl ConeMapPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Allocates the cone maps of a batch with these pyramids.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn output(&self, gpu: &Gpu, pyramids: &Pyramids) -> Result<Cones, GpuError> {
        let cells = pyramids.layout.cells;
        // Rows of a texture copy start at multiples of 256 bytes.
        let pitch = cells[0].next_multiple_of(32);
        let cones = Buffer::new(gpu, "cones", (pitch * cells[1]) as usize * pyramids.count as usize)
            .map_err(with_remedy)?;
        Ok(Cones { cones, cells, pitch, count: pyramids.count })
    }

    /// Prepares the cone maps of a batch from its pyramids, for their address mode.
    ///
    /// # Errors
    /// [`InputError`] when pyramids or cones do not belong to the batch; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        maps: &HeightBatch,
        pyramids: &Pyramids,
        cones: &Cones,
    ) -> Result<Job, Error> {
        pyramids.check(maps)?;
        let layout = pyramids.layout;
        if cones.cells != layout.cells || cones.count != maps.count {
            let value = format!("{:?} × {}", cones.cells, cones.count);
            let bound = format!("must be {:?} × {} as the pyramids", layout.cells, maps.count);
            return Err(InputError::new("cones", value, bound).into());
        }
        let params = ConeParams {
            size: UVec2::from(layout.size),
            cells: UVec2::from(layout.cells),
            pitch: layout.pitch,
            rows: layout.rows,
            cone_pitch: cones.pitch,
            address: pyramids.address.code(),
        };
        let uniform = Uniform::new(gpu, "cones", &params)?;
        let group = bindings::Group {
            params: &uniform,
            heights: maps.heights.slice(),
            pyramids: pyramids.nodes.slice(),
            cones: cones.cones.slice(),
        };
        let [x, y] = layout.cells.map(|cells| cells.div_ceil(8));
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![group.bind(gpu, &self.kernel)?],
            workgroups: [x, y, maps.count],
        };
        Ok(Job::new(gpu, "surface/cone_map", vec![step])?)
    }
}
