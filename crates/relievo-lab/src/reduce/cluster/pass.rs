//! The GPU pass of `kernels/mesh/cluster.wgsl`.

use glam::{IVec3, UVec3};
use relievo::gpu::bind::SeenAs;
use relievo::gpu::bindings::mesh::cluster as bindings;
use relievo::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use relievo::shared::mesh::cluster::{
    BLOCK, BLOCK_WORDS, CONNECT, ClusterParams, INSERT, MEAN, NEAREST, RECORD, REPRESENT, SCAN, SOURCE, SUM,
};
use relievo::{Error, InputError};

use crate::reduce::cluster::{ClusterCounts, Grid, MAX_VERTICES, Representative};

impl SeenAs<[u32; 4]> for Representative {}

/// A mesh, and where its clusters go.
#[derive(Debug, Clone, Copy)]
pub struct ClusterBuffers<'a> {
    /// One position per vertex. What is not finite counts as lying on a side of the grid.
    pub positions: &'a Buffer<[f32; 3]>,
    /// Three indices per triangle, each below the number of positions.
    pub indices: &'a Buffer<u32>,
    /// Written: the representatives; room for one a vertex. May be a vertex buffer with a stride of 16 bytes.
    pub representatives: &'a Buffer<Representative>,
    /// Written: three representatives for each triangle that stays; room for as many as `indices`. May be an index buffer.
    pub clustered: &'a Buffer<u32>,
    /// Written: one element. Its first 20 bytes are the arguments of `draw_indexed_indirect`.
    pub counts: &'a Buffer<ClusterCounts>,
}

/// Clusters meshes.
#[derive(Debug, Clone)]
pub struct ClusterPass {
    stages: [Kernel; STAGES.len()],
}

/// The stages in their order.
const STAGES: [u32; 8] = [INSERT, SUM, MEAN, NEAREST, SOURCE, SCAN, REPRESENT, CONNECT];

/// The clusters of a mesh, ready to be recorded.
#[derive(Debug, Clone)]
pub struct ClusterJob {
    job: Job,
    params: Uniform<ClusterParams>,
    /// What is cleared before.
    table: Buffer<u32>,
    records: Buffer<u32>,
    size: Size,
}

/// What the parameters say besides the grid.
#[derive(Debug, Clone, Copy)]
struct Size {
    vertices: u32,
    triangles: u32,
    /// Entries of the table, a power of two.
    entries: u32,
}

impl ClusterPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |stage: u32| bindings::kernel(gpu, &bindings::Constants { stage });
        let [a, b, c, d, e, f, g, h] = STAGES.map(kernel);
        Ok(Self { stages: [a?, b?, c?, d?, e?, f?, g?, h?] })
    }

    /// Prepares the clusters of the first `vertices` positions and the first `triangles` triangles. Allocates about 50 bytes
    /// a vertex.
    ///
    /// # Errors
    /// [`InputError`] as [`Grid::validate`], for buffers that are too small, and for more than [`MAX_VERTICES`]; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        grid: &Grid,
        [vertices, triangles]: [u32; 2],
        buffers: ClusterBuffers<'_>,
    ) -> Result<ClusterJob, Error> {
        let size = Size::new(vertices, triangles)?;
        buffers.positions.check_holds("positions", vertices as usize)?;
        buffers.indices.check_holds("indices", 3 * triangles as usize)?;
        buffers.representatives.check_holds("representatives", vertices as usize)?;
        buffers.clustered.check_holds("clustered", 3 * triangles as usize)?;
        buffers.counts.check_holds("counts", 1)?;
        let params = Uniform::new(gpu, "cluster", &size.params(grid)?)?;
        let table = Buffer::<u32>::new(gpu, "cluster table", 2 * size.entries as usize)?;
        let records = Buffer::<u32>::new(gpu, "cluster records", ((1 + RECORD) * vertices) as usize)?;
        let blocks = Buffer::<u32>::new(gpu, "cluster blocks", (BLOCK_WORDS * size.blocks()) as usize)?;
        let group = bindings::Group {
            params: &params,
            positions: buffers.positions.slice().cast(),
            indices: buffers.indices.slice(),
            table: table.slice(),
            records: records.slice(),
            blocks: blocks.slice(),
            representatives: buffers.representatives.slice().cast(),
            clustered: buffers.clustered.slice(),
            counts: buffers.counts.slice(),
        };
        let step = |(stage, kernel): (u32, &Kernel)| {
            let workgroups = match stage {
                SCAN => [1; 3],
                _ => kernel.spread(gpu, size.threads(stage)),
            };
            Ok(Step { groups: vec![group.bind(gpu, kernel)?], workgroups, kernel: kernel.clone() })
        };
        let steps = STAGES.into_iter().zip(&self.stages).map(step).collect::<Result<_, GpuError>>()?;
        let job = Job::new(gpu, "mesh/cluster", steps)?;
        Ok(ClusterJob { job, params, table, records, size })
    }
}

impl Size {
    fn new(vertices: u32, triangles: u32) -> Result<Self, InputError> {
        if vertices as usize > MAX_VERTICES {
            return Err(InputError::new("vertices", vertices, format!("must be at most {MAX_VERTICES}")));
        }
        // Three indices each in a binding of 2³² bytes at most.
        let most = u32::MAX / 12;
        if triangles > most {
            return Err(InputError::new("triangles", triangles, format!("must be at most {most}")));
        }
        Ok(Self { vertices, triangles, entries: (vertices + vertices / 4).next_power_of_two().max(64) })
    }

    fn blocks(&self) -> u32 {
        self.vertices.div_ceil(BLOCK) + self.triangles.div_ceil(BLOCK)
    }

    /// The number of threads that a stage needs at least.
    fn threads(&self, stage: u32) -> u32 {
        match stage {
            MEAN => self.vertices.max(self.blocks()),
            REPRESENT => self.vertices.div_ceil(BLOCK),
            CONNECT => self.triangles.div_ceil(BLOCK),
            _ => self.vertices,
        }
    }

    fn params(&self, grid: &Grid) -> Result<ClusterParams, InputError> {
        grid.validate()?;
        let grid = grid.quantized();
        Ok(ClusterParams {
            origin: IVec3::from(grid.origin),
            size: grid.size,
            extent: UVec3::from(grid.extent),
            exponent: grid.exponent,
            vertices: self.vertices,
            triangles: self.triangles,
            mask: self.entries - 1,
            shift: 32 - self.entries.ilog2(),
        })
    }
}

impl ClusterJob {
    /// Changes the grid, for what is recorded and submitted from now on.
    ///
    /// # Errors
    /// [`InputError`] as [`Grid::validate`]; [`GpuError`].
    pub fn set(&self, gpu: &Gpu, grid: &Grid) -> Result<(), Error> {
        Ok(self.params.write(gpu, &self.size.params(grid)?)?)
    }

    /// Records what clears the job's own memory, and all dispatches in one compute pass.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(self.table.raw(), 0, None);
        encoder.clear_buffer(self.records.raw(), 0, None);
        self.job.record(encoder);
    }
}
