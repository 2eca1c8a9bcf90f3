//! Colour textures with mip levels.

use crate::gpu::{Gpu, GpuError};
use crate::surface::mips::Mips;

/// A filtered texture.
#[derive(Debug, Clone)]
pub struct ColorTexture {
    /// RGBA, all mip levels.
    pub texture: wgpu::Texture,
    /// Trilinear; wraps or clamps.
    pub sampler: wgpu::Sampler,
}

impl ColorTexture {
    /// Uploads mip levels: sRGB for colours, linear for normals, as they were made.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, mips: &Mips, wraps: bool) -> Result<Self, GpuError> {
        let size = |level: &image::RgbaImage| wgpu::Extent3d {
            width: level.width(),
            height: level.height(),
            depth_or_array_layers: 1,
        };
        let format = match mips.is_srgb {
            true => wgpu::TextureFormat::Rgba8UnormSrgb,
            false => wgpu::TextureFormat::Rgba8Unorm,
        };
        let address = if wraps { wgpu::AddressMode::Repeat } else { wgpu::AddressMode::ClampToEdge };
        gpu.scoped(|| {
            let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: Some("colour"),
                size: size(&mips.levels[0]),
                mip_level_count: mips.levels.len() as u32,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            for (mip_level, level) in (0..).zip(&mips.levels) {
                let to = wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() };
                let layout = wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(4 * level.width()),
                    rows_per_image: None,
                };
                gpu.queue().write_texture(to, level.as_raw(), layout, size(level));
            }
            let sampler = gpu.device().create_sampler(&wgpu::SamplerDescriptor {
                label: Some("colour"),
                address_mode_u: address,
                address_mode_v: address,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            });
            Self { texture, sampler }
        })
    }
}
