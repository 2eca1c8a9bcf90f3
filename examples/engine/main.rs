//! A renderer that embeds a scene: its own device, targets, camera and draws. Nine patches of terrain, 50 characters that
//! stand on it, statues and relief walls are drawn in the program's own pass, with 4 samples, and a cube of the program
//! between them. Writes `engine.png`. What an engine has anyway (targets, a cube, saving a picture) is in `own.rs`.
//!
//! `cargo run --release --example engine`

mod own;

use glam::{Mat4, Vec3};
use relievo::gpu::Gpu;
use relievo::render::{Layer, Renderer, TargetFormat};
use relievo::scene::{Camera, Placement, Play, Relief, Scene, TerrainConfig, TerrainSource};
use relievo_samples::{creature, maps::BuiltInMap};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The program's own device: WebGPU's default limits, no features.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    // Load: everything there is.
    let gpu = Gpu::from_wgpu(device.clone(), queue.clone());
    let mut scene = Scene::new(&gpu)?;
    let patches: Vec<[i32; 2]> = (0..9).map(|at| [at % 3 - 1, at / 3 - 1]).collect();
    let config = TerrainConfig::new(129, 9.0, "engine")?;
    let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&patches))?;
    let mut model = creature()?;
    relievo::scene::add_levels(&mut model, &[0], 60)?;
    let crowd = scene.add_character(&model, 50)?;
    let statues = scene.add_mesh(&model, 4)?;
    let bricks = BuiltInMap::Bricks;
    let wall = scene.add_relief(&Relief::wall(2.0, bricks.height_map(256)?, bricks.albedo(256)?), 3)?;
    let ground = |scene: &Scene, x: f64, z: f64| {
        let found = scene.ground(land, x, z).ok().flatten();
        Placement::at_world([x, found.map_or(0.0, |point| point.height), z])
    };
    for at in 0..50 {
        let place = ground(&scene, f64::from(at % 10) * 5.0 + 40.0, f64::from(at / 10) * 7.0 + 40.0);
        let walker = scene.spawn(crowd, place.turned(0.9 * at as f32).scaled(2.0))?;
        scene.play(walker, &Play { start: -0.31 * f64::from(at), ..Play::new("walk") })?;
    }
    for at in 0..3 {
        let [x, z] = [46.0 + 18.0 * f64::from(at), 34.0];
        let place = ground(&scene, x, z);
        scene.spawn(statues, ground(&scene, x + 8.0, z).turned(0.4).scaled(4.0))?;
        scene.spawn(wall, Placement { offset: place.offset + Vec3::Y * 4.0, ..place.scaled(10.0) })?;
    }

    // Load: pipelines for the program's targets, and a view.
    let format = TargetFormat::new(own::COLOR).with_samples(4);
    let mut renderer = Renderer::new(&gpu, &format)?;
    renderer.prepare(&scene)?;
    let mut eye = scene.view(Default::default())?; // at most a pixel off
    let (cube, targets) = (own::Cube::new(&device), own::Targets::new(&device));

    // A frame.
    let focus = ground(&scene, 62.0, 50.0).world().as_vec3();
    let position = focus + Vec3::new(6.0, 14.0, 36.0);
    let camera = Camera::looking_at(position, focus, 0.8, [0.1, 600.0], own::SIZE);
    eye.set(camera)?;
    scene.advance(0.5)?;
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    scene.record(&mut encoder, &mut [&mut eye])?;
    {
        let mut pass = targets.pass(&mut encoder);
        let place = Mat4::from_translation(focus + Vec3::Y * 2.0) * Mat4::from_scale(Vec3::splat(3.0));
        cube.draw(&queue, &mut pass, camera.clip_from_cell() * place);
        renderer.draw(&mut pass, &scene, &eye, Layer::Color)?;
    }
    queue.submit([encoder.finish()]);
    targets.save(&device, &queue, "engine.png")
}
