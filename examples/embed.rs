//! Terrain whose heights the program computes with passes of its own choice, in a scene on the program's own wgpu device:
//! `cargo run --example embed`.
//!
//! Set-up compiles pipelines and allocates; later, new heights are only recorded into the program's encoder.

use glam::{DVec3, Vec3};
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::regions::{HeightBatch, RegionPass};
use relievo::ops::terrain::window::Windows;
use relievo::render::Offscreen;
use relievo::scene::{Camera, Scene, TerrainSource};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The device of the embedding program.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    // Set-up. With a margin of one sample, shading agrees across patches.
    let gpu = Gpu::from_wgpu(device.clone(), queue.clone());
    let config = TerrainConfig::new(129, 40.0, "embedded")?;
    let pass = RegionPass::new(&gpu, &config, None)?;
    let batch = HeightBatch::new(&gpu, &pass, &config, Windows { count: 9, apron: 1 }, 0)?;
    // The scene shares the heights, which show nothing yet. Nine patches fit one buffer; a batch beyond 128 MiB has several
    // parts, each a terrain.
    let mut scene = Scene::new(&gpu)?;
    let land = scene.add_terrain(&TerrainSource::from_fields(config, batch.fields()[0].clone(), &[]))?;

    // Whenever the viewer has travelled: choose the patches, record their heights, and say between which these lie.
    let patches: Vec<[i32; 2]> = (0..9).map(|i| [i % 3, i / 3]).collect();
    batch.set(&gpu, &patches, &Features::default())?;
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    batch.record(&mut encoder);
    queue.submit([encoder.finish()]);
    scene.set_patches(land, &patches, [-80.0, 80.0])?;

    // The same ground on the CPU, to place objects on it: height and normal of the triangle that is drawn.
    scene.read_ground(land)?;
    let (x, z) = (60.5, 370.25);
    let feet = scene.ground(land, x, z)?.ok_or("nobody stands outside of the patches")?;
    println!("({x}, {z}): {:.2} high, the ground's normal is {:.2?}", feet.height, feet.normal);

    // A frame of a program without a window; `Scene` shows how others draw into their own passes.
    let eye = DVec3::new(x, feet.height + 40.0, z).as_vec3();
    let target = Offscreen::new(&gpu, [960, 540])?;
    let camera = Camera::looking_at(eye, Vec3::new(192.0, 0.0, 160.0), 0.8, [1.0, 2000.0], target.size());
    target.draw(&mut scene, camera, [0.36, 0.55, 0.80])?;
    target.read(&gpu)?.save("embed.png")?;
    println!("embed.png");
    Ok(())
}
