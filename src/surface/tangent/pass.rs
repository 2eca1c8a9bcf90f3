//! `kernels/surface/tangent.wgsl`.

use encase::ShaderType;

use super::{Adjacency, Mesh};
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::{Error, InputError};

/// `TangentParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct TangentParams {
    pub vertices: u32,
}

/// A mesh on the device. Positions, normals and uv may be rewritten, by other kernels too, as long as positions
/// and uv keep [`Mesh`]'s bounds.
#[derive(Debug, Clone)]
pub struct TangentBuffers {
    /// One a vertex.
    pub positions: Buffer<[f32; 3]>,
    /// One a vertex.
    pub normals: Buffer<[f32; 3]>,
    /// One a vertex.
    pub uv: Buffer<[f32; 2]>,
    indices: Buffer<u32>,
    offsets: Buffer<u32>,
    corners: Buffer<u32>,
}

impl TangentBuffers {
    /// Checks and uploads a mesh, with its [`Adjacency`].
    ///
    /// # Errors
    /// [`InputError`] as [`Mesh::validate`]; [`GpuError`].
    pub fn new(gpu: &Gpu, mesh: &Mesh<'_>) -> Result<Self, Error> {
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

/// Computes tangent frames.
#[derive(Debug, Clone)]
pub struct TangentPass {
    kernel: Kernel,
}

impl TangentPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(gpu, &shaders::SURFACE_TANGENT, &[])? })
    }

    /// Prepares the frames of `mesh` into `tangents`: tangent x, y, z and handedness for each vertex. A vertex
    /// buffer too.
    ///
    /// # Errors
    /// [`InputError`] for fewer tangents than vertices; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &TangentBuffers,
        tangents: &Buffer<[f32; 4]>,
    ) -> Result<Job, Error> {
        let vertices = mesh.positions.len();
        if tangents.len() < vertices {
            let bound = format!("must be at least {vertices}, one a vertex");
            return Err(InputError::new("tangents.len", tangents.len(), bound).into());
        }
        let vertices = vertices as u32;
        let uniform = Uniform::new(gpu, "tangent", &TangentParams { vertices })?;
        let resources = [
            uniform.raw().as_entire_binding(),
            mesh.positions.raw().as_entire_binding(),
            mesh.normals.raw().as_entire_binding(),
            mesh.uv.raw().as_entire_binding(),
            mesh.indices.raw().as_entire_binding(),
            mesh.offsets.raw().as_entire_binding(),
            mesh.corners.raw().as_entire_binding(),
            tangents.raw().as_entire_binding(),
        ];
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: self.kernel.spread(gpu, vertices),
        };
        Ok(Job::new(gpu, "surface/tangent", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(tangent_params_layout: TangentParams = SURFACE_TANGENT "TangentParams");
}
