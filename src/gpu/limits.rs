//! Whether a device allows what a shader binds.

use super::shaders::{BindingKind, Shader, Stage};
use super::{Gpu, GpuError};

/// What helps where a device was created with smaller limits.
const REMEDY: &str = "create the device with WebGPU's default limits (`wgpu::Limits::default()`)";

impl Gpu {
    /// Checks that the device allows as many resources in each stage, and workgroups as large, as a shader has.
    ///
    /// # Errors
    /// [`GpuError::Limit`].
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
            let count = |is_counted: fn(BindingKind) -> bool| {
                let counted = |binding: &&super::shaders::Binding| {
                    binding.stages.contains(&stage) && is_counted(binding.kind)
                };
                shader.bindings.iter().filter(counted).count() as u32
            };
            let storage = |kind| matches!(kind, BindingKind::StorageRead | BindingKind::StorageReadWrite);
            let uniform = |kind| matches!(kind, BindingKind::Uniform);
            let sampler = |kind| matches!(kind, BindingKind::Sampler | BindingKind::ComparisonSampler);
            let texture = |kind| {
                use BindingKind::{DepthTexture, LoadedTexture, Texture, TextureArray};
                matches!(kind, TextureArray | Texture | LoadedTexture | DepthTexture)
            };
            let allowed = limits.max_storage_buffers_per_shader_stage;
            check("maxStorageBuffersPerShaderStage", count(storage), allowed)?;
            let allowed = limits.max_uniform_buffers_per_shader_stage;
            check("maxUniformBuffersPerShaderStage", count(uniform), allowed)?;
            let allowed = limits.max_sampled_textures_per_shader_stage;
            check("maxSampledTexturesPerShaderStage", count(texture), allowed)?;
            check("maxSamplersPerShaderStage", count(sampler), limits.max_samplers_per_shader_stage)?;
        }
        for entry in shader.entry_points {
            let invocations = entry.workgroup_size.iter().product();
            check(
                "maxComputeInvocationsPerWorkgroup",
                invocations,
                limits.max_compute_invocations_per_workgroup,
            )?;
        }
        Ok(())
    }
}
