//! Relief in a material shader of your own: the ray-height methods are WGSL text to put before it, and the
//! height map and its pyramid are textures to bind. Draws `relief.png`.
//!
//! `cargo run --example relief`

use relievo::gpu::{Gpu, Options, shaders::MODULES};
use relievo::render::{Offscreen, target::COLOR_FORMAT, target::DEPTH_FORMAT};
use relievo::scene::{Address, ReliefMethod, SurfaceTextures};
use relievo_samples::BuiltInMap;

/// The material: a wall seen at an angle. `surface_ray`, `surface_quadtree` and `surface_normal` come from
/// relievo.
const MATERIAL: &str = r#"
@group(0) @binding(0) var heights: texture_2d<f32>;
@group(0) @binding(1) var pyramid: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(vec2<u32>(index & 1u, index >> 1u));
    return vec4<f32>(4.0 * corner - 1.0, 0.5, 1.0);
}

@fragment
fn fragment(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    let scale = 0.08;
    let march = SurfaceMarch(SURFACE_WRAP, 1u, 1u, 8u, 0u);
    let to_eye = normalize(vec3<f32>(0.5, 0.8, 0.6));
    let ray = surface_ray(pixel.xy / 512.0, to_eye, scale, 1.0);
    let hit = surface_quadtree(heights, pyramid, ray, march);

    let to_light = normalize(vec3<f32>(-0.5, -0.6, 0.7));
    let normal = surface_normal(heights, hit.uv, scale, march);
    let shadow = surface_soft_shadow(heights, hit, to_light, scale, march, 24u, 0.15);
    let light = 0.2 + 0.8 * shadow * max(dot(normal, to_light), 0.0);
    return vec4<f32>(light * mix(vec3<f32>(0.4, 0.38, 0.35), vec3<f32>(0.6, 0.2, 0.12), hit.height), 1.0);
}
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // In your program: `Gpu::from_wgpu(device, queue)`.
    let gpu = Gpu::headless(&Options::default())?;
    let map = BuiltInMap::Bricks.height_map(512)?;
    // At load time: uploads the heights, and computes the pyramid on the device.
    let textures = SurfaceTextures::new(&gpu, &map, ReliefMethod::Quadtree, Address::Wrap)?;

    let surface = MODULES.iter().find(|module| module.name == "surface").ok_or("no such module")?;
    let shader = gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("wall"),
        source: wgpu::ShaderSource::Wgsl(format!("{}\n{MATERIAL}", surface.source).into()),
    });
    let (pipeline, group) = pipeline(gpu.device(), &shader, &textures);

    let target = Offscreen::new(&gpu, [640, 400])?;
    let mut encoder = gpu.encoder("wall");
    target.record(&mut encoder, [0.0; 3], |pass| {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    })?;
    gpu.queue().submit([encoder.finish()]);
    target.read(&gpu)?.save("relief.png")?;
    println!("relief.png, on {}", gpu.adapter());
    Ok(())
}

/// Plain wgpu: both textures are loaded texel by texel, so they need not be filterable.
fn pipeline(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    textures: &SurfaceTextures,
) -> (wgpu::RenderPipeline, wgpu::BindGroup) {
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("wall"),
        entries: &[entry(0), entry(1)],
    });
    let layouts = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("wall"),
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("wall"),
        layout: Some(&layouts),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(COLOR_FORMAT.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("wall"),
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view(&textures.heights)),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&view(&textures.acceleration)),
            },
        ],
    });
    (pipeline, group)
}
