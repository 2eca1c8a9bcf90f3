//! An off-screen colour and depth target, and its readback.

use crate::gpu::{Gpu, GpuError};

/// The colour format of [`Target`].
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// The colour format of [`Target::linear`].
pub const LINEAR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// The depth format that every pass of this module expects.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// An off-screen sRGB image with a depth buffer.
#[derive(Debug, Clone)]
pub struct Target {
    color: wgpu::Texture,
    depth: wgpu::Texture,
}

impl Target {
    /// A target of `size` pixels.
    ///
    /// # Errors
    /// [`GpuError::Limit`] when it is larger than a texture may be, [`GpuError::OutOfMemory`].
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        Self::of(gpu, size, COLOR_FORMAT)
    }

    /// A target of linear light in f32, whose values do not depend on a driver's rounding or encoding.
    ///
    /// # Errors
    /// As [`Target::new`].
    pub fn linear(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        Self::of(gpu, size, LINEAR_FORMAT)
    }

    fn of(gpu: &Gpu, size: [u32; 2], color: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let available = gpu.device().limits().max_texture_dimension_2d;
        if size.iter().any(|edge| *edge == 0 || *edge > available) {
            return Err(GpuError::Limit {
                pass: "target",
                limit: "maxTextureDimension2D",
                needed: u64::from(size[0].max(size[1])),
                available: available.into(),
                remedy: "draw a smaller image (at least one pixel)",
            });
        }
        let texture = |format, usage| {
            gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: Some("target"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        gpu.scoped(|| Self {
            color: texture(color, wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC),
            depth: texture(DEPTH_FORMAT, wgpu::TextureUsages::RENDER_ATTACHMENT),
        })
    }

    /// Width divided by height.
    pub fn aspect(&self) -> f32 {
        self.color.width() as f32 / self.color.height() as f32
    }

    /// Clears the colour to `sky` (linear) and the depth to the far plane, draws with `draw`, and waits.
    ///
    /// # Errors
    /// Errors of the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn draw(
        &self,
        gpu: &Gpu,
        sky: [f64; 3],
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) -> Result<(), GpuError> {
        gpu.run("draw", |encoder| self.record(encoder, sky, draw))
    }

    /// Records the same work as [`Target::draw`] into the caller's encoder.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        sky: [f64; 3],
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("draw"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view(&self.color),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: sky[0], g: sky[1], b: sky[2], a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view(&self.depth),
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        draw(&mut pass);
    }

    /// Reads the image of a target made by [`Target::new`]: RGBA, sRGB, row by row.
    ///
    /// # Errors
    /// Errors of the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read(&self, gpu: &Gpu) -> Result<image::RgbaImage, GpuError> {
        let pixels = self.read_bytes(gpu, 4)?;
        image::RgbaImage::from_raw(self.color.width(), self.color.height(), pixels).ok_or_else(|| {
            GpuError::Internal { reason: "the image that was read back has the wrong size".to_owned() }
        })
    }

    /// Reads linear red, green and blue of a target made by [`Target::linear`], row by row.
    ///
    /// # Errors
    /// Errors of the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_linear(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>, GpuError> {
        let pixels: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&self.read_bytes(gpu, 16)?);
        Ok(pixels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn read_bytes(&self, gpu: &Gpu, texel: u32) -> Result<Vec<u8>, GpuError> {
        gpu.block_on(read_texture(gpu, &self.color, wgpu::TextureAspect::All, texel))
    }
}

/// Reads an aspect of a texture of `texel` bytes a texel, row by row; see [`Gpu::wait_async`].
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
