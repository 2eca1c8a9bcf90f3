//! The GPU pass of `kernels/terrain/node_normals.wgsl`.

use crate::gpu::bindings::terrain::node_normals as bindings;
use crate::gpu::{Buffer, Gpu, Job, Step, Uniform, pass};
use crate::shared::terrain::node_normals::NodeNormalsParams;
use crate::terrain::config::HEIGHT_ONE;
use crate::terrain::node::{NODE_MARGIN, NodeShape};
use crate::{Error, InputError};

pass! {
    /// Computes normals of nodes at twice the nodes' resolution.
    pub struct NodeNormalsPass;
}

/// Buffers of a batch of nodes.
#[derive(Debug, Clone, Copy)]
pub struct NodeNormalsBuffers<'a> {
    /// Read: finer heights, [`NodeShape::region_width`]² for each region.
    pub heights: &'a Buffer<i32>,
    /// Read: the node that each region makes; nodes beyond the end of `normals` are not written.
    pub slots: &'a Buffer<u32>,
    /// Written: [`NodeShape::normals_width`]² words for each node ([`packed_normal`](super::reference::packed_normal)).
    pub normals: &'a Buffer<u32>,
}

impl NodeNormalsPass {
    /// Prepares a job for `count` nodes of one shape. `spacing` is the distance between samples of the regions, in world units.
    ///
    /// # Errors
    /// [`InputError`] for a shape without finer heights and for buffers that are too short; [`crate::gpu::GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        shape: NodeShape,
        spacing: f64,
        count: u32,
        buffers: NodeNormalsBuffers<'_>,
    ) -> Result<Job, Error> {
        InputError::check_within("shape.finer", shape.finer, 1..=4)?;
        let NodeNormalsBuffers { heights, slots, normals } = buffers;
        let width = shape.region_width();
        heights.check_holds("heights", count as usize * (width as usize).pow(2))?;
        slots.check_holds("slots", count as usize)?;
        let (size, step) = (shape.normals_width(), 1 << (shape.finer - 1));
        let run = (2.0 * f64::from(step) * spacing * HEIGHT_ONE) as f32;
        let params = NodeNormalsParams { width, size, first: NODE_MARGIN << shape.finer, step, run };
        let group = bindings::Group {
            params: &Uniform::new(gpu, "normals of nodes", &params)?,
            heights: heights.slice(),
            slots: slots.slice(),
            normals: normals.slice(),
        };
        let groups = vec![group.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, [size, size, count]);
        Ok(Job::new(gpu, "terrain/node_normals", vec![step])?)
    }
}
