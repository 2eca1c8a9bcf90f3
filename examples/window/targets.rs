//! The window's surface, and targets with 4 samples and depth that are resolved to it.

use std::path::Path;
use std::sync::Arc;

use wgpu::CurrentSurfaceTexture as Current;
use winit::dpi::PhysicalSize;
use winit::window::Window;

use crate::Failure;

/// Samples per pixel.
pub const SAMPLES: u32 = 4;

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What frames are drawn into.
pub struct Targets {
    instance: wgpu::Instance,
    device: wgpu::Device,
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    /// Colour and depth, as large as the surface.
    sampled: [wgpu::TextureView; 2],
}

impl Targets {
    /// Configures a window's surface: in step with the display, in sRGB, and to be copied from if `saves`.
    pub fn new(
        instance: &wgpu::Instance,
        adapter: &wgpu::Adapter,
        device: &wgpu::Device,
        (window, surface): (Arc<Window>, wgpu::Surface<'static>),
        saves: bool,
    ) -> Result<Self, Failure> {
        let size = window.inner_size();
        let config = surface.get_default_config(adapter, size.width.max(1), size.height.max(1));
        let mut config = config.ok_or("the adapter cannot draw into the window")?;
        let capabilities = surface.get_capabilities(adapter);
        let srgb = capabilities.formats.iter().find(|format| format.is_srgb());
        config.format = srgb.copied().unwrap_or(config.format);
        // A surface without such a format takes the same bytes through a view of one.
        if !config.format.is_srgb() {
            config.view_formats = vec![config.format.add_srgb_suffix()];
        }
        config.present_mode = wgpu::PresentMode::AutoVsync;
        if saves {
            config.usage |= wgpu::TextureUsages::COPY_SRC;
            if !capabilities.usages.contains(config.usage) {
                return Err("the window's surface cannot be copied".into());
            }
        }
        let sampled = sampled(device, &config);
        let (instance, device) = (instance.clone(), device.clone());
        let mut targets = Self { instance, device, window, surface, config, sampled };
        targets.configure();
        Ok(targets)
    }

    /// The device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The format of the colour.
    pub fn format(&self) -> wgpu::TextureFormat {
        self.config.format.add_srgb_suffix()
    }

    /// Width and height in physical pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// The window has another size. Nothing is as large as a minimized window, whose size is 0.
    pub fn resize(&mut self, size: PhysicalSize<u32>) {
        if size.width > 0 && size.height > 0 && self.size() != [size.width, size.height] {
            self.configure();
        }
    }

    /// Fits surface and targets to the window.
    fn configure(&mut self) {
        let PhysicalSize { width, height } = self.window.inner_size();
        let most = self.device.limits().max_texture_dimension_2d;
        self.config.width = width.clamp(1, most);
        self.config.height = height.clamp(1, most);
        self.surface.configure(&self.device, &self.config);
        self.sampled = sampled(&self.device, &self.config);
    }

    /// The texture that is presented next; `None` if there is none now, because the window is hidden or the display is
    /// late.
    pub fn next(&mut self) -> Result<Option<wgpu::SurfaceTexture>, Failure> {
        let PhysicalSize { width, height } = self.window.inner_size();
        if width == 0 || height == 0 {
            return Ok(None);
        }
        for _ in 0..2 {
            match self.surface.get_current_texture() {
                // Suboptimal: it can be shown. If the size is another now, `resize` is called before the next frame.
                Current::Success(texture) | Current::Suboptimal(texture) => return Ok(Some(texture)),
                Current::Timeout | Current::Occluded => return Ok(None),
                Current::Outdated => self.configure(),
                Current::Lost => {
                    self.surface = self.instance.create_surface(self.window.clone())?;
                    self.configure();
                }
                Current::Validation => return Err("the surface's texture is refused".into()),
            }
        }
        Ok(None)
    }

    /// Begins a pass that clears the targets, and resolves them to a texture of the surface.
    pub fn pass<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
    ) -> wgpu::RenderPass<'a> {
        let resolved = texture
            .create_view(&wgpu::TextureViewDescriptor { format: Some(self.format()), ..Default::default() });
        let [color, depth] = &self.sampled;
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: color,
                depth_slice: None,
                resolve_target: Some(&resolved),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.36, g: 0.55, b: 0.80, a: 1.0 }),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// Records a copy of what is presented.
    pub fn copy(&self, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture) -> wgpu::Buffer {
        let row = row(texture.width());
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(row) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        buffer
    }

    /// Waits for a copy, which must be submitted, and writes it to a file.
    pub fn save(&self, copy: &wgpu::Buffer, path: &Path) -> Result<(), Failure> {
        copy.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        self.device.poll(wgpu::PollType::Wait { submission_index: None, timeout: None })?;
        let bytes = copy.slice(..).get_mapped_range()?.to_vec();
        let [width, height] = self.size();
        let rows = bytes.chunks_exact(row(width) as usize);
        let mut pixels: Vec<u8> = rows.flat_map(|row| &row[..4 * width as usize]).copied().collect();
        use wgpu::TextureFormat::{Bgra8Unorm, Bgra8UnormSrgb, Rgba8Unorm, Rgba8UnormSrgb};
        match self.config.format {
            Bgra8Unorm | Bgra8UnormSrgb => pixels.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2)),
            Rgba8Unorm | Rgba8UnormSrgb => (),
            other => return Err(format!("no picture is written of {other:?}").into()),
        }
        let picture = image::RgbaImage::from_raw(width, height, pixels).ok_or("whole rows")?;
        Ok(picture.save(path)?)
    }
}

/// Bytes of a row in a buffer: a multiple of 256.
fn row(width: u32) -> u32 {
    (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

/// Colour and depth with several samples, as large as the surface.
fn sampled(device: &wgpu::Device, config: &wgpu::SurfaceConfiguration) -> [wgpu::TextureView; 2] {
    let texture = |label, format| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width: config.width, height: config.height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: SAMPLES,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    };
    [texture("color", config.format.add_srgb_suffix()), texture("depth", DEPTH)]
        .map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()))
}
