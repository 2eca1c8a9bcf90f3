//! The GPU pass of `kernels/surface/height_pyramid.wgsl`.

use glam::UVec2;

use super::PyramidLayout;
use crate::gpu::bindings::surface::height_pyramid as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Step, Uniform, pass};
use crate::shared::surface::height_pyramid::PyramidParams;
use crate::surface::height_batch::{HeightMapBatch, REMEDY};
use crate::surface::map::Address;
use crate::{Error, InputError};

/// Max-mip pyramids of a batch of height maps on the device, one pyramid after another.
#[derive(Debug, Clone)]
pub struct Pyramids {
    /// Nodes of all pyramids, [`PyramidLayout::len`] per pyramid. [`PyramidLayout::index`] gives the index of a node within its
    /// pyramid.
    pub nodes: Buffer<f32>,
    /// Memory layout of each pyramid.
    pub layout: PyramidLayout,
    /// Address mode that the pyramids are computed for.
    pub address: Address,
    /// Number of pyramids.
    pub count: u32,
}

impl Pyramids {
    /// Allocates the pyramids of a batch of height maps.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, maps: &HeightMapBatch, address: Address) -> Result<Self, GpuError> {
        let layout = PyramidLayout::new(maps.size, address);
        let nodes = Buffer::new(gpu, "pyramids", layout.len() * maps.count as usize)
            .map_err(|error| error.with_remedy(REMEDY))?;
        Ok(Self { nodes, layout, address, count: maps.count })
    }

    /// Returns an error if the pyramids differ from a batch of height maps in size or number.
    pub(crate) fn check(&self, maps: &HeightMapBatch) -> Result<(), InputError> {
        if self.layout.size != maps.size {
            let bound = format!("must be {:?} texels, as the height maps'", maps.size);
            return Err(InputError::new("pyramids.layout.size", format!("{:?}", self.layout.size), bound));
        }
        InputError::check_same("pyramids.count", self.count, maps.count, "as the height maps'")
    }
}

pass! {
    /// Computes max-mip pyramids on the GPU, with one dispatch per level.
    pub struct HeightPyramidPass;
}

impl HeightPyramidPass {
    /// Prepares a job that computes the pyramids of a batch of height maps.
    ///
    /// # Errors
    /// [`InputError`] if the pyramids differ from the batch in size or number; [`GpuError`] for errors of the device.
    pub fn prepare(&self, gpu: &Gpu, maps: &HeightMapBatch, pyramids: &Pyramids) -> Result<Job, Error> {
        pyramids.check(maps)?;
        let layout = pyramids.layout;
        let step = |level| {
            let params = PyramidParams {
                size: UVec2::from(layout.size),
                cells: UVec2::from(layout.cells),
                pitch: layout.pitch,
                rows: layout.rows,
                address: pyramids.address.code(),
                level,
            };
            let group = bindings::Group {
                params: &Uniform::new(gpu, "pyramid", &params)?,
                heights: maps.heights.slice(),
                pyramids: pyramids.nodes.slice(),
            };
            let [columns, rows] = layout.nodes(level);
            let groups = vec![group.bind(gpu, &self.kernel)?];
            Ok(Step::covering(&self.kernel, groups, [columns, rows, maps.count]))
        };
        let steps = (0..layout.levels).map(step).collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "surface/height_pyramid", steps)?)
    }
}
