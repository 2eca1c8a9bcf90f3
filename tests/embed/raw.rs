//! Targets of several colours, whose texels are read as they are.

use relievo::gpu::{Buffer, Gpu};
use relievo::render::{Layer, Renderer, TargetFormat};
use relievo::scene::{Scene, View};
use relievo::wgpu;
use wgpu::TextureFormat as Format;

/// A target of one sample.
pub struct Raw {
    pub format: TargetFormat,
    pub size: [u32; 2],
    /// What every colour is cleared to.
    pub clear: wgpu::Color,
    colors: Vec<wgpu::Texture>,
    depth: wgpu::Texture,
}

impl Raw {
    pub fn new(gpu: &Gpu, format: TargetFormat, size: [u32; 2]) -> Self {
        let texture = |format, usage| {
            gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: Some("the program's target"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let colors = format.color.iter().flatten();
        let colors = colors.map(|color| texture(color.format, wgpu::TextureUsages::COPY_SRC)).collect();
        let depth = texture(format.depth.expect("a depth").format, wgpu::TextureUsages::empty());
        Self { format, size, clear: wgpu::Color::TRANSPARENT, colors, depth }
    }

    /// A renderer that has compiled what the scene needs.
    pub fn renderer(&self, gpu: &Gpu, scene: &Scene) -> Renderer {
        let mut renderer = Renderer::new(gpu, &self.format).expect("a format");
        renderer.prepare(scene).expect("compiled");
        renderer
    }

    /// Records a pass over the whole target, cleared.
    pub fn pass(&self, encoder: &mut wgpu::CommandEncoder, draw: impl FnOnce(&mut wgpu::RenderPass<'_>)) {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (colors, depth) = (self.colors.iter().map(view).collect::<Vec<_>>(), view(&self.depth));
        let attachment = |view| {
            let (load, store) = (wgpu::LoadOp::Clear(self.clear), wgpu::StoreOp::Store);
            let ops = wgpu::Operations { load, store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        };
        let is_reversed = self.format.depth.is_some_and(|depth| depth.reversed);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("the program's pass"),
            color_attachments: &colors.iter().map(attachment).collect::<Vec<_>>(),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(if is_reversed { 0.0 } else { 1.0 }),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        draw(&mut pass);
    }

    /// Records a frame through one view, and draws these layers.
    pub fn frame(&self, scene: &mut Scene, view: &mut View, renderer: &Renderer, layers: &[Layer]) {
        let gpu = scene.gpu().clone();
        let mut encoder = gpu.encoder("frame");
        scene.record(&mut encoder, &mut [view]).expect("recorded");
        self.pass(&mut encoder, |pass| {
            for layer in layers {
                renderer.draw(pass, scene, view, *layer).expect("drawn");
            }
        });
        gpu.queue().submit([encoder.finish()]);
    }

    fn bytes(&self, gpu: &Gpu, at: usize) -> Vec<u8> {
        let color = &self.colors[at];
        let texel = color.format().block_copy_size(None).expect("a colour");
        let [width, height] = self.size;
        let pitch = (texel * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = Buffer::<u8>::new(gpu, "readback", (pitch * height) as usize).expect("room");
        let run = gpu.run("readback", |encoder| {
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None };
            let to = wgpu::TexelCopyBufferInfo { buffer: buffer.raw(), layout };
            encoder.copy_texture_to_buffer(color.as_image_copy(), to, color.size());
        });
        run.expect("read");
        let rows = buffer.read_blocking(gpu).expect("read");
        let row = (texel * width) as usize;
        rows.chunks_exact(pitch as usize).flat_map(|padded| &padded[..row]).copied().collect()
    }

    /// The texels of a colour of floats, row by row; what the format lacks is 0.
    pub fn floats(&self, gpu: &Gpu, at: usize) -> Vec<[f32; 4]> {
        let format = self.colors[at].format();
        let (width, read): (usize, fn(&[u8]) -> f32) = match format {
            Format::Rgba8Unorm => (1, |byte| f32::from(byte[0]) / 255.0),
            Format::Rg16Float | Format::Rgba16Float => (2, |bytes| half([bytes[0], bytes[1]])),
            Format::Rgba32Float => (4, |bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])),
            other => panic!("teach the test {other:?}"),
        };
        let count = usize::from(format.components());
        let texel = |texel: &[u8]| {
            let values = texel.chunks_exact(width).map(read).collect::<Vec<_>>();
            std::array::from_fn(|channel| values.get(channel).copied().unwrap_or(0.0))
        };
        self.bytes(gpu, at).chunks_exact(count * width).map(texel).collect()
    }

    /// The texels of a colour of two unsigned integers, row by row.
    pub fn words(&self, gpu: &Gpu, at: usize) -> Vec<[u32; 2]> {
        let bytes = self.bytes(gpu, at);
        match self.colors[at].format() {
            Format::Rg16Uint => {
                let word = |bytes: &[u8]| u32::from(u16::from_le_bytes([bytes[0], bytes[1]]));
                bytes.chunks_exact(4).map(|texel| [word(&texel[..2]), word(&texel[2..])]).collect()
            }
            Format::Rg32Uint => {
                let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
                bytes.chunks_exact(8).map(|texel| [word(&texel[..4]), word(&texel[4..])]).collect()
            }
            other => panic!("teach the test {other:?}"),
        }
    }
}

/// A half float.
pub fn half(bytes: [u8; 2]) -> f32 {
    let bits = u16::from_le_bytes(bytes);
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023) / 1024.0);
    let size = match exponent {
        0 => fraction * 2_f32.powi(-14),
        31 => f32::NAN,
        _ => (1.0 + fraction) * 2_f32.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
}

#[test]
fn half_floats_are_read() {
    for (bits, value) in [(0x3c00_u16, 1.0), (0xc000, -2.0), (0x3555, 0.333_251_95), (1, 5.960_464_5e-8)] {
        assert_eq!(half(bits.to_le_bytes()), value);
    }
}
