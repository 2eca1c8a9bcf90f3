//! Checks of a shader's resources against the device's limits.

use super::shaders::{BindingKind, Shader, Stage};
use super::{Gpu, GpuError};

/// Advice in the error for a device that was created with smaller limits.
const REMEDY: &str = "create the device with WebGPU's default limits (`wgpu::Limits::default()`)";

impl Gpu {
    /// Checks the number of a shader's resources per stage, and its workgroup size, against the device's limits.
    ///
    /// # Errors
    /// [`GpuError::Limit`] that names the exceeded limit.
    pub(super) fn check_limits(&self, shader: &'static Shader) -> Result<(), GpuError> {
        let limits = self.device.limits();
        let check = |limit, needed: u32, available: u32| match needed <= available {
            true => Ok(()),
            false => Err(GpuError::Limit {
                pass: shader.name,
                limit,
                needed: needed.into(),
                available: available.into(),
                remedy: REMEDY,
            }),
        };
        let groups = shader.bindings.iter().map(|binding| binding.group + 1).max().unwrap_or(0);
        check("maxBindGroups", groups, limits.max_bind_groups)?;
        for stage in [Stage::Vertex, Stage::Fragment, Stage::Compute] {
            let [mut storage, mut uniform, mut textures, mut samplers] = [0; 4];
            for binding in shader.bindings.iter().filter(|binding| binding.stages.contains(&stage)) {
                use BindingKind as Kind;
                *match binding.kind {
                    Kind::StorageRead | Kind::StorageReadWrite => &mut storage,
                    Kind::Uniform => &mut uniform,
                    Kind::TextureArray | Kind::Texture => &mut textures,
                    Kind::LoadedTexture | Kind::DepthTexture => &mut textures,
                    Kind::Sampler | Kind::ComparisonSampler => &mut samplers,
                } += 1;
            }
            let allowed = limits.max_storage_buffers_per_shader_stage;
            check("maxStorageBuffersPerShaderStage", storage, allowed)?;
            let allowed = limits.max_uniform_buffers_per_shader_stage;
            check("maxUniformBuffersPerShaderStage", uniform, allowed)?;
            let allowed = limits.max_sampled_textures_per_shader_stage;
            check("maxSampledTexturesPerShaderStage", textures, allowed)?;
            check("maxSamplersPerShaderStage", samplers, limits.max_samplers_per_shader_stage)?;
        }
        for entry in shader.entry_points {
            let invocations = entry.workgroup_size.iter().product();
            let allowed = limits.max_compute_invocations_per_workgroup;
            check("maxComputeInvocationsPerWorkgroup", invocations, allowed)?;
        }
        Ok(())
    }
}
