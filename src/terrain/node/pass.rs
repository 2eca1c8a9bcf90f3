//! The GPU pass of `kernels/terrain/node.wgsl`.

use super::NodeShape;
use crate::gpu::bindings::terrain::node as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::terrain::node::{BORDERS, INSIDE, NodeParams, ROWS};
use crate::{Error, InputError};

/// Makes nodes from regions of finer heights.
#[derive(Debug, Clone)]
pub struct NodePass {
    inside: Kernel,
    borders: Kernel,
}

/// Buffers of a batch of nodes.
#[derive(Debug, Clone, Copy)]
pub struct NodeBuffers<'a> {
    /// Read: finer heights, [`NodeShape::region_width`]² for each region.
    pub heights: &'a Buffer<i32>,
    /// Read: the tile that each region makes. Regions whose tile is beyond the end of `tiles` make facts alone, and those beyond the
    /// end of `facts` nothing.
    pub slots: &'a Buffer<u32>,
    /// Written: tiles of [`NodeShape::tile_width`]² heights.
    pub tiles: &'a Buffer<i32>,
    /// Written: [`NODE_FACTS`](super::NODE_FACTS) words for each tile. They must be 0 before ([`NodeFacts::from_words`](super::NodeFacts::from_words)).
    pub facts: &'a Buffer<u32>,
}

impl NodePass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |stage| bindings::kernel(gpu, &bindings::Constants { stage });
        Ok(Self { inside: kernel(INSIDE)?, borders: kernel(BORDERS)? })
    }

    /// Prepares a job that makes `count` nodes of one shape.
    ///
    /// # Errors
    /// [`InputError`] for a shape out of bounds and for buffers that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        shape: NodeShape,
        count: u32,
        buffers: NodeBuffers<'_>,
    ) -> Result<Job, Error> {
        InputError::check_within("shape.finer", shape.finer, 0..=4)?;
        InputError::check_within("shape.size", shape.size, 3..=4097)?;
        let NodeBuffers { heights, slots, tiles, facts } = buffers;
        let width = shape.region_width();
        heights.check_holds("heights", count as usize * (width as usize).pow(2))?;
        slots.check_holds("slots", count as usize)?;
        let params = NodeParams { width, count, size: shape.size, finer: shape.finer };
        let group = bindings::Group {
            params: &Uniform::new(gpu, "terrain nodes", &params)?,
            heights: heights.slice(),
            slots: slots.slice(),
            tiles: tiles.slice(),
            facts: facts.slice(),
        };
        let step = |kernel, threads| {
            Ok::<_, GpuError>(Step::covering(kernel, vec![group.bind(gpu, kernel)?], threads))
        };
        let inside = step(&self.inside, [width, width.div_ceil(ROWS), count])?;
        // One thread per finer sample that is less than a cell from a side.
        let border = ((shape.size - 1) << shape.finer) + 1;
        let borders = step(&self.borders, [border, 1 << shape.finer, 4 * count])?;
        Ok(Job::new(gpu, "terrain/node", vec![inside, borders])?)
    }
}
