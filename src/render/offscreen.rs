//! Off-screen targets of any [`TargetFormat`], and their readback, for programs without a window.

use image::RgbaImage;

use super::attachments::Attachments;
use super::format::TargetFormat;
use super::target::{COLOR_FORMAT, DEPTH_FORMAT, LINEAR_FORMAT, read_texture};
#[cfg(not(target_arch = "wasm32"))]
use super::{layer::Layer, renderer::Renderer};
use crate::gpu::{Gpu, GpuError};
#[cfg(not(target_arch = "wasm32"))]
use crate::scene::{Camera, Quality, Scene};
#[cfg(not(target_arch = "wasm32"))]
use crate::surface::LinearImage;
use crate::{Error, InputError};

/// An off-screen target: colour and depth of a picture, with 1 or 4 samples per pixel.
///
/// # Examples
///
/// The shortest way to a picture of a scene:
///
/// ```
/// use glam::DVec3;
/// use relievo::gpu::{Gpu, Options};
/// use relievo::render::Offscreen;
/// use relievo::scene::{Camera, Scene, TerrainConfig, TerrainSource};
///
/// let gpu = Gpu::headless(&Options::default())?;
/// let mut scene = Scene::new(&gpu)?;
/// scene.add_terrain(&TerrainSource::new(TerrainConfig::new(33, 6.0, "any text")?))?;
/// let target = Offscreen::new(&gpu, [96, 64])?;
/// let camera = Camera::framing(DVec3::new(0.0, -6.0, 0.0), DVec3::new(32.0, 6.0, 32.0), target.size());
/// target.draw(&mut scene, camera, [0.36, 0.55, 0.80])?;
/// let picture = target.read(&gpu)?;
/// assert_eq!(picture.dimensions(), (96, 64));
/// # Ok::<(), relievo::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Offscreen {
    format: TargetFormat,
    size: [u32; 2],
    colors: Vec<Attachment>,
    depth: wgpu::Texture,
}

#[derive(Debug, Clone)]
struct Attachment {
    drawn: wgpu::Texture,
    /// The resolve target, if the picture has more than one sample per pixel.
    resolved: Option<wgpu::Texture>,
}

impl Offscreen {
    /// A target of `size` (width and height in pixels) with [`TargetFormat::srgb`]. [`Offscreen::with_format`] makes
    /// targets of other formats, such as one with 4 samples per pixel.
    ///
    /// # Errors
    /// [`InputError`] for a size of 0 or beyond the device's limit; [`GpuError`] for failures of the device.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, Error> {
        Self::with_format(gpu, size, TargetFormat::srgb())
    }

    /// A target of `size` pixels in linear light: `Rgba32Float`, `Depth32Float` that grows with distance, and one
    /// sample per pixel. The values do not depend on a driver's rounding or encoding.
    ///
    /// # Errors
    /// Same as [`Offscreen::new`].
    pub fn linear(gpu: &Gpu, size: [u32; 2]) -> Result<Self, Error> {
        Self::with_format(gpu, size, TargetFormat::new(LINEAR_FORMAT))
    }

    /// Whether the device can hold a target of this size and colour format, and read its colours back through one buffer binding.
    pub fn fits(gpu: &Gpu, size: [u32; 2], color: wgpu::TextureFormat) -> bool {
        let most = gpu.device().limits().max_texture_dimension_2d;
        let [width, height] = size.map(u64::from);
        let texel = color.block_copy_size(None).map_or(u64::MAX, u64::from);
        size.iter().all(|edge| (1..=most).contains(edge))
            && texel.saturating_mul(width * height) <= gpu.max_binding()
    }

    /// A target of `size` pixels. In `format`, no colour attachment may be missing, and depth must be `Depth32Float`.
    ///
    /// # Errors
    /// [`InputError`] for a format that [`TargetFormat::validate`] refuses, for missing colours, for depth formats other than
    /// `Depth32Float`, for more than one sample of a format that cannot be resolved, and for a size of 0 or beyond the device's
    /// limit; [`GpuError`] for failures of the device.
    pub fn with_format(gpu: &Gpu, size: [u32; 2], format: TargetFormat) -> Result<Self, Error> {
        format.validate()?;
        let depth = format.depth.map(|depth| depth.format);
        if depth != Some(DEPTH_FORMAT) {
            let bound = format!("must be {DEPTH_FORMAT:?}");
            return Err(InputError::new("format.depth", format!("{depth:?}"), bound).into());
        }
        if format.samples > 1 && format.attachments != Attachments::Color {
            return Err(
                InputError::new("format.samples", format.samples, "must be 1 for these attachments").into()
            );
        }
        if let Some(at) = format.color.iter().position(Option::is_none) {
            return Err(InputError::new(format!("format.color[{at}]"), "none", "must be there").into());
        }
        let most = gpu.device().limits().max_texture_dimension_2d;
        if size.iter().any(|edge| !(1..=most).contains(edge)) {
            let value = format!("{}x{}", size[0], size[1]);
            return Err(InputError::new("size", value, format!("must be 1 to {most} pixels each way")).into());
        }
        let texture = |format, samples: u32| texture(gpu, size, format, samples);
        let samples = format.samples;
        let attachment = |color: &wgpu::ColorTargetState| Attachment {
            drawn: texture(color.format, samples),
            resolved: (samples > 1).then(|| texture(color.format, 1)),
        };
        let (colors, depth) = gpu.scoped(|| {
            (format.color.iter().flatten().map(attachment).collect(), texture(DEPTH_FORMAT, samples))
        })?;
        Ok(Self { format, size, colors, depth })
    }

    /// The target's format, for a [`Renderer`].
    pub fn format(&self) -> &TargetFormat {
        &self.format
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The texture of a colour attachment, with one sample per pixel, for the caller's own passes. A shader may read it, and a copy may write it.
    /// A colour format with `Srgb` in its name can also be viewed without the conversion. `None` if there is no such
    /// attachment.
    pub fn color(&self, index: usize) -> Option<&wgpu::Texture> {
        let Attachment { drawn, resolved } = self.colors.get(index)?;
        Some(resolved.as_ref().unwrap_or(drawn))
    }

    /// Records a render pass that calls `draw`. The pass first clears colour to `background` (linear), other attachments to 0,
    /// and depth to the far value.
    ///
    /// # Errors
    /// The errors that `draw` returns.
    pub fn record(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        background: [f32; 3],
        draw: impl FnOnce(&mut wgpu::RenderPass<'_>) -> Result<(), InputError>,
    ) -> Result<(), InputError> {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let views = self.colors.iter().map(|color| (view(&color.drawn), color.resolved.as_ref().map(view)));
        let views: Vec<_> = views.collect();
        let [r, g, b] = background.map(f64::from);
        let clear = match self.format.attachments {
            Attachments::Color => wgpu::Color { r, g, b, a: 1.0 },
            _ => wgpu::Color::TRANSPARENT,
        };
        let attachment = |(view, resolved)| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: resolved,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
        };
        let attachments: Vec<_> =
            views.iter().map(|(view, resolved)| Some(attachment((view, resolved.as_ref())))).collect();
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("off screen"),
            color_attachments: &attachments,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view(&self.depth),
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(if self.format.is_reversed() { 0.0 } else { 1.0 }),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        draw(&mut pass)
    }

    /// Draws one frame of a scene through a camera, in full detail, over a linear `background`.
    ///
    /// The call compiles the pipelines, records a view, draws its colours, and waits for the device. A program that draws more
    /// than one frame should keep a [`View`](crate::scene::View) and a [`Renderer`] instead.
    ///
    /// # Errors
    /// [`InputError`] for a target without colour, and the errors of [`View::set`](crate::scene::View::set), [`Scene::record`]
    /// and [`Renderer::draw`]; [`GpuError`] for failures of the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn draw(&self, scene: &mut Scene, camera: Camera, background: [f32; 3]) -> Result<(), Error> {
        let gpu = scene.gpu().clone();
        let mut renderer = Renderer::new(&gpu, &self.format)?;
        renderer.prepare(scene)?;
        let mut view = scene.view(Quality::pixels(0.0))?;
        view.set(camera)?;
        gpu.try_run("draw", |encoder| {
            scene.record(encoder, &mut [&mut view])?;
            let draw = |pass: &mut wgpu::RenderPass<'_>| renderer.draw(pass, scene, &view, Layer::Color);
            Ok(self.record(encoder, background, draw)?)
        })
    }

    /// Reads the colours back: sRGB, row by row. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for a target without colour, or with a format other than `Rgba8UnormSrgb`; [`GpuError`] for failures of the
    /// device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read(&self, gpu: &Gpu) -> Result<RgbaImage, Error> {
        gpu.block_on(self.read_async(gpu))
    }

    /// Same as `Offscreen::read`, but completes once the device has finished; see [`Gpu::wait_async`].
    ///
    /// # Errors
    /// [`InputError`] for a target without colour, or with a format other than `Rgba8UnormSrgb`; [`GpuError`] for failures of the
    /// device.
    pub async fn read_async(&self, gpu: &Gpu) -> Result<RgbaImage, Error> {
        let pixels = self.read_color(gpu, 0, COLOR_FORMAT).await?;
        let reason = "the image that was read back has the wrong size".to_owned();
        let image = RgbaImage::from_raw(self.size[0], self.size[1], pixels);
        image.ok_or_else(|| GpuError::Internal { reason }.into())
    }

    /// Reads the colours of a target in linear light ([`Offscreen::linear`]), without their alpha. Waits for the
    /// device.
    ///
    /// # Errors
    /// [`InputError`] for a target of another format; [`GpuError`] for failures of the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_linear(&self, gpu: &Gpu) -> Result<LinearImage, Error> {
        let bytes = gpu.block_on(self.read_color(gpu, 0, LINEAR_FORMAT))?;
        let pixels: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(LinearImage {
            size: self.size,
            pixels: pixels.into_iter().map(|[r, g, b, _]| [r, g, b]).collect(),
        })
    }

    /// Reads the bytes of a colour attachment, texel by texel, row by row. `format` must be the attachment's format.
    ///
    /// # Errors
    /// [`InputError`] for an attachment that does not exist or has another format; [`GpuError`] for failures of the device.
    pub async fn read_color(
        &self,
        gpu: &Gpu,
        index: usize,
        format: wgpu::TextureFormat,
    ) -> Result<Vec<u8>, Error> {
        let Some(color) = self.color(index) else {
            let path = match self.colors.len() {
                0 => "format.color".to_owned(),
                _ => format!("format.color[{index}]"),
            };
            return Err(InputError::new(path, "none", "must be there to be read").into());
        };
        if color.format() != format {
            let bound = format!("must be {format:?} to be read like this");
            let value = format!("{:?}", color.format());
            return Err(InputError::new(format!("format.color[{index}].format"), value, bound).into());
        }
        let texel = format.block_copy_size(None).unwrap_or(4);
        Ok(read_texture(gpu, color, wgpu::TextureAspect::All, texel).await?)
    }

    /// Reads the depths back, 0 to 1, row by row. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for more than one sample per pixel; [`GpuError`] for failures of the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_depth(&self, gpu: &Gpu) -> Result<Vec<f32>, Error> {
        gpu.block_on(self.read_depth_async(gpu))
    }

    /// Same as `Offscreen::read_depth`, but completes once the device has finished; see [`Gpu::wait_async`].
    ///
    /// # Errors
    /// [`InputError`] for more than one sample per pixel; [`GpuError`] for failures of the device.
    pub async fn read_depth_async(&self, gpu: &Gpu) -> Result<Vec<f32>, Error> {
        if self.format.samples > 1 {
            let bound = "must be 1 where depth is read";
            return Err(InputError::new("format.samples", self.format.samples, bound).into());
        }
        let bytes = read_texture(gpu, &self.depth, wgpu::TextureAspect::DepthOnly, 4).await?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }
}

fn texture(gpu: &Gpu, size: [u32; 2], format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let read =
        wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING;
    let plain = [format.remove_srgb_suffix()];
    let is_viewed = samples == 1 && plain[0] != format;
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("off screen"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: if samples == 1 { usage | read } else { usage },
        view_formats: if is_viewed { &plain } else { &[] },
    })
}
