//! The GPU pass of `kernels/surface/tangent.wgsl`.

use super::{Adjacency, TangentMesh};
use crate::gpu::bindings::surface::tangent as bindings;
use crate::gpu::{Buffer, Gpu, Job, Uniform, pass};
use crate::shared::surface::tangent::TangentParams;
use crate::{Error, InputError};

/// A mesh on the device, for computing tangents. The caller or other kernels may rewrite positions, normals and uv. Positions and
/// uv must stay within the bounds of [`TangentMesh`].
#[derive(Debug, Clone)]
pub struct TangentBuffers {
    /// One position per vertex.
    pub positions: Buffer<[f32; 3]>,
    /// One normal per vertex.
    pub normals: Buffer<[f32; 3]>,
    /// One pair of texture coordinates per vertex.
    pub uv: Buffer<[f32; 2]>,
    indices: Buffer<u32>,
    offsets: Buffer<u32>,
    corners: Buffer<u32>,
}

impl TangentBuffers {
    /// Checks a mesh and uploads it together with its [`Adjacency`].
    ///
    /// # Errors
    /// [`InputError`] if [`TangentMesh::validate`] fails; [`crate::gpu::GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, mesh: &TangentMesh<'_>) -> Result<Self, Error> {
        mesh.validate()?;
        let adjacency = Adjacency::new(mesh.positions.len(), mesh.indices);
        Ok(Self {
            positions: Buffer::from_slice(gpu, "positions", mesh.positions)?,
            normals: Buffer::from_slice(gpu, "normals", mesh.normals)?,
            uv: Buffer::from_slice(gpu, "uv", mesh.uv)?,
            indices: Buffer::from_slice(gpu, "indices", mesh.indices)?,
            offsets: Buffer::from_slice(gpu, "offsets", &adjacency.offsets)?,
            corners: Buffer::from_slice(gpu, "corners", &adjacency.corners)?,
        })
    }
}

pass! {
    /// Computes the tangent frames of a mesh on the GPU.
    pub struct TangentPass;
}

impl TangentPass {
    /// Prepares a job that computes the tangent frames of `mesh`. It writes tangent x, y, z and handedness for each vertex into
    /// `tangents`. The buffer can also serve as a vertex buffer.
    ///
    /// # Errors
    /// [`InputError`] if `tangents` is shorter than the number of vertices; [`crate::gpu::GpuError`] for errors of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &TangentBuffers,
        tangents: &Buffer<[f32; 4]>,
    ) -> Result<Job, Error> {
        let vertices = mesh.positions.len();
        let bound = || format!("must be at least {vertices}, one a vertex");
        InputError::check(tangents.len() >= vertices, "tangents.len", tangents.len(), bound)?;
        let vertices = vertices as u32;
        let uniform = Uniform::new(gpu, "tangent", &TangentParams { vertices })?;
        let group = bindings::Group {
            params: &uniform,
            positions: mesh.positions.slice().cast(),
            normals: mesh.normals.slice().cast(),
            texture_coordinates: mesh.uv.slice().cast(),
            indices: mesh.indices.slice(),
            offsets: mesh.offsets.slice(),
            corners: mesh.corners.slice(),
            tangents: tangents.slice(),
        };
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "surface/tangent", &self.kernel, group, vertices)?)
    }
}
