//! Creates textures that are filled once ([`Gpu::fill_level`]) and then sampled, and their samplers.

use super::{Gpu, GpuError};

impl Gpu {
    /// Refuses a texture that is wider or higher than the device allows. `remedy` is the advice in the error.
    ///
    /// # Errors
    /// [`GpuError::Limit`].
    pub(crate) fn check_texture(
        &self,
        label: &'static str,
        size: [u32; 2],
        remedy: &'static str,
    ) -> Result<(), GpuError> {
        let (needed, available) = (size[0].max(size[1]), self.device.limits().max_texture_dimension_2d);
        if needed <= available {
            return Ok(());
        }
        let (needed, available) = (needed.into(), available.into());
        Err(GpuError::Limit { pass: label, limit: "maxTextureDimension2D", needed, available, remedy })
    }

    /// Creates a texture with layers and mip levels. The caller must hold an error scope.
    pub(crate) fn sampled_texture(
        &self,
        label: &'static str,
        [width, height, layers]: [u32; 3],
        mip_levels: u32,
        format: wgpu::TextureFormat,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
            mip_level_count: mip_levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        })
    }

    /// Creates a trilinear sampler that repeats the texture (`wraps`) or clamps to its edges. The caller must hold an error
    /// scope.
    pub(crate) fn trilinear_sampler(&self, label: &'static str, wraps: bool) -> wgpu::Sampler {
        let address = if wraps { wgpu::AddressMode::Repeat } else { wgpu::AddressMode::ClampToEdge };
        self.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some(label),
            address_mode_u: address,
            address_mode_v: address,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        })
    }
}
