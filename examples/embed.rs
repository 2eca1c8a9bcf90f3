//! Terrain inside a program that has its own wgpu device and its own frame: `cargo run --example embed`.
//!
//! Set-up compiles pipelines and allocates; a frame only records into the program's encoder.

use relievo::gpu::Gpu;
use relievo::render::target::{COLOR_FORMAT, Target};
use relievo::render::{Camera, Materials, Style, TerrainRenderer};
use relievo::terrain::blend::Shading;
use relievo::terrain::config::{Config, Offset};
use relievo::terrain::features::Features;
use relievo::terrain::ground::Ground;
use relievo::terrain::height::{HeightBatch, HeightPass};
use relievo::terrain::texture::Texture;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The device of the embedding program.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    // Set-up. With a margin of one sample, shading agrees across patches.
    let gpu = Gpu::from_wgpu(device.clone(), queue.clone());
    let config = Config::new(129, 40.0, "embedded")?;
    let pass = HeightPass::new(&gpu, Offset::Signed, None)?;
    let batch = HeightBatch::new(&gpu, &pass, &config, [9, 1], 0)?;
    let textures = Texture::of_zones(&config.zones)?;
    let materials = Materials::new(&gpu, &config.zones, &textures)?;
    let renderer = TerrainRenderer::new(&gpu, COLOR_FORMAT, Style::Textured)?;
    let mut scene = renderer.scene(&gpu, &materials, &Shading::default())?;
    let patches: Vec<[i32; 2]> = (0..9).map(|i| [i % 3, i / 3]).collect();
    // Nine patches fit one buffer; a batch beyond 128 MiB has several parts, each with its own patches.
    scene.add(&gpu, &config, &batch.fields()[0], &patches, patches[0])?;

    // Every frame: choose the patches, then record.
    batch.set(&gpu, &patches, &Features::default())?;
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    batch.record(&mut encoder);
    queue.submit([encoder.finish()]);

    // The same ground on the CPU, to place objects on it: height and normal of the triangle that is drawn.
    let fields = &batch.fields()[0];
    let heights = fields.heights.read_blocking(&gpu)?;
    let mut ground = Ground::new(&config)?;
    for (patch, window) in patches.iter().zip(heights.chunks_exact((fields.width * fields.width) as usize)) {
        ground.insert(*patch, window, 1)?;
    }
    let (x, z) = (60.5, 370.25);
    let feet = ground.point_from(patches[0], x, z).ok_or("nobody stands outside of the patches")?;
    println!("({x}, {z}): {:.2} high, the ground's normal is {:.2?}", feet.height, feet.normal);

    let camera = Camera {
        eye: glam::DVec3::new(x, feet.height + 40.0, z).as_vec3(),
        target: glam::Vec3::new(192.0, 0.0, 160.0),
        field_of_view: 0.8,
        near: 1.0,
        far: 2000.0,
    };
    let target = Target::new(&gpu, [960, 540])?;
    scene.set_camera(&gpu, &camera, target.aspect())?;
    target.draw(&gpu, [0.36, 0.55, 0.80], |pass| scene.draw(pass))?;
    target.read(&gpu)?.save("embed.png")?;
    println!("embed.png");
    Ok(())
}
