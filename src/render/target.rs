//! The formats of [`Offscreen`](super::Offscreen), and the readback of textures.

use crate::gpu::{Gpu, GpuError};

/// Colour format of sRGB pictures.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Colour format of pictures in linear light.
pub const LINEAR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Format of depth.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Reads an aspect of a texture back, row by row; `texel` is the number of bytes per texel. See [`Gpu::wait_async`].
pub(super) async fn read_texture(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    aspect: wgpu::TextureAspect,
    texel: u32,
) -> Result<Vec<u8>, GpuError> {
    let (width, height) = (texture.width(), texture.height());
    let pitch = (texel * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = crate::gpu::Buffer::<u8>::new(gpu, "readback", (pitch * height) as usize)?;
    gpu.submit("readback", |encoder| {
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo { aspect, ..texture.as_image_copy() },
            wgpu::TexelCopyBufferInfo {
                buffer: buffer.raw(),
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(pitch),
                    rows_per_image: None,
                },
            },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
    })?;
    let rows = buffer.read(gpu).await?;
    let row = (texel * width) as usize;
    Ok(rows.chunks_exact(pitch as usize).flat_map(|padded| &padded[..row]).copied().collect())
}
