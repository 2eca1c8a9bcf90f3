//! A program's own device, targets and frames.

use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::render::{DepthFormat, Layer, Renderer, TargetFormat};
use relievo::scene::{Camera, Depth, Scene, View};
use relievo::wgpu;
use relievo_testing::Devices;

/// The colour format of the program's targets.
pub const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// A device for a test, as a program opens it: WebGPU's default limits, no features; see [`Devices`].
pub fn device() -> Gpu {
    static DEVICES: Devices = Devices::new(new_device);
    DEVICES.of_thread()
}

/// Such a device for one test alone: if it loses the device, or counts its memory.
pub fn new_device() -> Gpu {
    let [device] = devices();
    device
}

/// So many such devices, of one adapter.
pub fn devices<const COUNT: usize>() -> [Gpu; COUNT] {
    let (_, adapter) = crate::harness::foreign_adapter();
    [(); COUNT].map(|()| {
        let gpu = opened(&adapter, &wgpu::Limits::default());
        assert_eq!(gpu.device().limits().max_storage_buffers_per_shader_stage, 8);
        gpu
    })
}

/// A device with other limits.
pub fn device_of(limits: &wgpu::Limits) -> Gpu {
    opened(&crate::harness::foreign_adapter().1, limits)
}

fn opened(adapter: &wgpu::Adapter, limits: &wgpu::Limits) -> Gpu {
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits.clone(), ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("a device");
    assert_eq!(device.features(), wgpu::Features::empty());
    device.on_uncaptured_error(std::sync::Arc::new(|error| panic!("the device reports: {error}")));
    Gpu::from_wgpu(device, queue)
}

/// What every colour but the first is cleared to; half floats hold it exactly.
pub const OTHER: wgpu::Color = wgpu::Color { r: 0.25, g: 0.5, b: 0.75, a: 0.125 };

/// What stencils are cleared to: a value that neither 0, a replacement, nor a step up or down from 0 gives.
pub const STENCIL: u8 = 0x5a;

/// A target of the program, and how it is cleared.
pub struct Frame {
    pub format: TargetFormat,
    pub size: [u32; 2],
    color: wgpu::Texture,
    /// Where samples are resolved to.
    resolved: Option<wgpu::Texture>,
    others: Vec<Option<wgpu::Texture>>,
    depth: Option<wgpu::Texture>,
}

fn texture(gpu: &Gpu, size: [u32; 2], format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let reads = samples == 1 && (format.has_color_aspect() || format.has_stencil_aspect());
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("the program's target"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: if reads { usage | wgpu::TextureUsages::COPY_SRC } else { usage },
        view_formats: &[],
    })
}

impl Frame {
    pub fn new(gpu: &Gpu, format: TargetFormat, size: [u32; 2]) -> Self {
        let color = texture(gpu, size, COLOR, format.samples);
        let resolved = (format.samples > 1).then(|| texture(gpu, size, COLOR, 1));
        let others = (format.color.iter().skip(1))
            .map(|state| state.as_ref().map(|state| texture(gpu, size, state.format, format.samples)))
            .collect();
        let depth = format.depth.as_ref().map(|depth| texture(gpu, size, depth.format, format.samples));
        Self { format, size, color, resolved, others, depth }
    }

    /// A target with depth from 0 to 1.
    pub fn plain(gpu: &Gpu, size: [u32; 2]) -> Self {
        Self::new(gpu, TargetFormat::new(COLOR), size)
    }

    /// A renderer for the target that has compiled what the scene needs.
    pub fn renderer(&self, gpu: &Gpu, scene: &Scene) -> Renderer {
        let mut renderer = Renderer::new(gpu, &self.format).expect("a format that can be drawn to");
        renderer.prepare(scene).expect("compiled");
        renderer
    }

    /// Records a pass of the program over the whole target, cleared to a sky.
    pub fn pass(&self, encoder: &mut wgpu::CommandEncoder, draw: impl FnOnce(&mut wgpu::RenderPass<'_>)) {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (color, resolved) = (view(&self.color), self.resolved.as_ref().map(view));
        let others: Vec<_> = self.others.iter().map(|other| other.as_ref().map(view)).collect();
        let depth = self.depth.as_ref().map(view);
        let sky = wgpu::Color { r: 0.02, g: 0.03, b: 0.05, a: 1.0 };
        let attachment = |view, resolve_target, clear| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
            })
        };
        let mut attachments = vec![attachment(&color, resolved.as_ref(), sky)];
        attachments.extend(others.iter().map(|view| attachment(view.as_ref()?, None, OTHER)));
        let is_reversed = self.format.depth.as_ref().is_some_and(|depth: &DepthFormat| depth.reversed);
        let has_stencil = self.depth.as_ref().is_some_and(|depth| depth.format().has_stencil_aspect());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("the program's pass"),
            color_attachments: &attachments,
            depth_stencil_attachment: depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(if is_reversed { 0.0 } else { 1.0 }),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: has_stencil.then_some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(u32::from(STENCIL)),
                    store: wgpu::StoreOp::Store,
                }),
            }),
            ..Default::default()
        });
        draw(&mut pass);
    }

    /// Records a frame of the scene through one view, submits it and reads the picture of its opaque surfaces.
    pub fn shot(&self, scene: &mut Scene, view: &mut View, renderer: &Renderer) -> RgbaImage {
        self.shot_of(scene, view, renderer, &[Layer::Color])
    }

    /// As [`Frame::shot`], of these layers.
    pub fn shot_of(
        &self,
        scene: &mut Scene,
        view: &mut View,
        renderer: &Renderer,
        layers: &[Layer],
    ) -> RgbaImage {
        let gpu = scene.gpu().clone();
        let mut encoder = gpu.encoder("frame");
        scene.record(&mut encoder, &mut [view]).expect("recorded");
        self.pass(&mut encoder, |pass| {
            for layer in layers {
                renderer.draw(pass, scene, view, *layer).expect("drawn");
            }
        });
        gpu.queue().submit([encoder.finish()]);
        self.read(&gpu)
    }

    /// The picture.
    pub fn read(&self, gpu: &Gpu) -> RgbaImage {
        let [width, height] = self.size;
        let from = self.resolved.as_ref().unwrap_or(&self.color);
        let pixels = self.bytes(gpu, from, wgpu::TextureAspect::All);
        RgbaImage::from_raw(width, height, pixels).expect("whole rows")
    }

    /// The bytes of the colour after the first by `at`, row by row.
    pub fn other(&self, gpu: &Gpu, at: usize) -> Vec<u8> {
        let other = self.others[at].as_ref().expect("an attachment");
        self.bytes(gpu, other, wgpu::TextureAspect::All)
    }

    /// The stencil, row by row; `None` for a depth without one.
    pub fn stencil(&self, gpu: &Gpu) -> Option<Vec<u8>> {
        let depth = self.depth.as_ref().filter(|depth| depth.format().has_stencil_aspect())?;
        Some(self.bytes(gpu, depth, wgpu::TextureAspect::StencilOnly))
    }

    fn bytes(&self, gpu: &Gpu, from: &wgpu::Texture, aspect: wgpu::TextureAspect) -> Vec<u8> {
        let [width, height] = self.size;
        let row = from.format().block_copy_size(Some(aspect)).expect("can be copied") * width;
        let pitch = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer =
            relievo::gpu::Buffer::<u8>::new(gpu, "readback", (pitch * height) as usize).expect("room");
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None };
        let run = gpu.run("readback", |encoder| {
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo { aspect, ..from.as_image_copy() },
                wgpu::TexelCopyBufferInfo { buffer: buffer.raw(), layout },
                from.size(),
            );
        });
        run.expect("read");
        let rows = buffer.read_blocking(gpu).expect("read");
        rows.chunks_exact(pitch as usize).flat_map(|padded| &padded[..row as usize]).copied().collect()
    }
}

/// The same camera with reversed depth, which lies at infinity if `is_infinite`.
pub fn reversed(camera: Camera, near: f32, is_infinite: bool) -> Camera {
    let aspect = camera.viewport[0] as f32 / camera.viewport[1] as f32;
    let (focal_y, far) = (camera.clip_from_view.y_axis.y, 400.0);
    let mut clip_from_view = glam::Mat4::ZERO;
    clip_from_view.x_axis.x = focal_y / aspect;
    clip_from_view.y_axis.y = focal_y;
    clip_from_view.z_axis.w = -1.0;
    let (a, b) = if is_infinite { (0.0, near) } else { (near / (far - near), near * far / (far - near)) };
    clip_from_view.z_axis.z = a;
    clip_from_view.w_axis.z = b;
    Camera { clip_from_view, depth: Depth::Reversed, ..camera }
}
