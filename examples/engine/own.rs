//! What the program has without the scene: targets with 4 samples, a cube, and a picture that is saved.

use glam::Mat4;

/// Width and height of the picture in pixels.
pub const SIZE: [u32; 2] = [960, 540];

/// The colour format of the targets.
pub const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Colour and depth with 4 samples, and the picture to which they are resolved.
pub struct Targets {
    color: wgpu::Texture,
    depth: wgpu::Texture,
    picture: wgpu::Texture,
}

impl Targets {
    /// Allocates them.
    pub fn new(device: &wgpu::Device) -> Self {
        let texture = |format, sample_count, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let nothing = wgpu::TextureUsages::empty();
        Self {
            color: texture(COLOR, 4, nothing),
            depth: texture(DEPTH, 4, nothing),
            picture: texture(COLOR, 1, wgpu::TextureUsages::COPY_SRC),
        }
    }

    /// Begins a pass that clears them.
    pub fn pass<'a>(&self, encoder: &'a mut wgpu::CommandEncoder) -> wgpu::RenderPass<'a> {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view(&self.color),
                depth_slice: None,
                resolve_target: Some(&view(&self.picture)),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.36, g: 0.55, b: 0.80, a: 1.0 }),
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
        })
    }

    /// Waits for the picture and writes it to a file.
    pub fn save(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        path: &str,
    ) -> Result<(), Box<dyn std::error::Error>> {
        // 960 pixels are a multiple of 64, so that rows need no padding.
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(4 * SIZE[0] * SIZE[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE[0]), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_buffer(self.picture.as_image_copy(), to, self.picture.size());
        queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        device.poll(wgpu::PollType::Wait { submission_index: None, timeout: None })?;
        let pixels = buffer.slice(..).get_mapped_range()?.to_vec();
        let picture = image::RgbaImage::from_raw(SIZE[0], SIZE[1], pixels).ok_or("whole rows")?;
        Ok(picture.save(path)?)
    }
}

const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_cube: mat4x4<f32>;
struct Corner { @builtin(position) clip: vec4<f32>, @location(0) @interpolate(flat) side: u32 }
@vertex fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    let side = index / 6u;
    let corner = array(vec2(-0.5, -0.5), vec2(0.5, -0.5), vec2(0.5, 0.5), vec2(-0.5, -0.5), vec2(0.5, 0.5), vec2(-0.5, 0.5))[index % 6u];
    let out = f32(side % 2u) - 0.5;
    var at = vec3(corner, out);
    if side / 2u == 1u { at = at.zxy; }
    if side / 2u == 2u { at = at.yzx; }
    return Corner(clip_from_cube * vec4(at, 1.0), side);
}
@fragment fn fragment(corner: Corner) -> @location(0) vec4<f32> {
    return vec4(array(vec3(0.5, 0.1, 0.1), vec3(0.8, 0.2, 0.1), vec3(0.3, 0.1, 0.1))[corner.side / 2u], 1.0);
}";

/// A cube with an edge of 1.
pub struct Cube {
    pipeline: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl Cube {
    /// Compiles its pipeline.
    pub fn new(device: &wgpu::Device) -> Self {
        let source = wgpu::ShaderSource::Wgsl(SHADER.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::LessEqual),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState { count: 4, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(COLOR.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        Self { pipeline, uniform, group }
    }

    /// Draws it.
    pub fn draw(&self, queue: &wgpu::Queue, pass: &mut wgpu::RenderPass<'_>, clip_from_cube: Mat4) {
        let bytes: Vec<u8> =
            clip_from_cube.to_cols_array().iter().flat_map(|value| value.to_le_bytes()).collect();
        queue.write_buffer(&self.uniform, 0, &bytes);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..36, 0..1);
    }
}
