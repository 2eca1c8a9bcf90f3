//! Draws endless terrain: `cargo run --example horizon -- horizon.png`.

use std::error::Error;
use std::time::Instant;

use relievo::gpu::{Gpu, Options};
use relievo::ops::terrain::config::HeightInterpolation;
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{Camera, EndlessLimits, Quality, Scene, TerrainConfig, TerrainSource};

const SIZE: [u32; 2] = [1280, 720];

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "horizon.png".to_owned());
    let gpu = Gpu::headless(&Options::default())?;
    let mut scene = Scene::new(&gpu)?;
    let config = TerrainConfig {
        coarse_levels: 8,
        interpolation: HeightInterpolation::Smooth,
        ..TerrainConfig::new(65, 1400.0, "horizon")?
    };
    let land = scene.add_terrain(&TerrainSource::endless(config).with_limits(EndlessLimits::default()))?;
    let ground = scene.ground(land, 0.0, 0.0)?.ok_or("no ground")?.height;
    let target = Offscreen::new(&gpu, SIZE)?;
    let mut renderer = Renderer::new(&gpu, target.format())?;
    renderer.prepare(&scene)?;
    let mut view = scene.view(Quality::pixels(1.0))?;
    scene.set_statistics(true)?;
    let eye = [0.0, ground + 60.0, 0.0];
    view.set(Camera::looking_at_world(eye, [300.0, ground + 30.0, -1000.0], 0.9, [0.5, 30_000.0], SIZE))?;
    for frame in 0..100 {
        let start = Instant::now();
        gpu.try_run("frame", |encoder| scene.record(encoder, &mut [&mut view]))?;
        let statistics = scene.terrain_statistics(land)?;
        println!("{frame}: {:.1} ms {statistics:?}", start.elapsed().as_secs_f64() * 1e3);
        if statistics.ready == 1.0 {
            break;
        }
    }
    let start = Instant::now();
    gpu.try_run("frame", |encoder| -> Result<(), relievo::Error> {
        scene.record(encoder, &mut [&mut view])?;
        let draw =
            |pass: &mut relievo::wgpu::RenderPass<'_>| renderer.draw(pass, &scene, &view, Layer::Color);
        Ok(target.record(encoder, [0.5, 0.65, 0.85], draw)?)
    })?;
    println!("drawn in {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    println!("{:?}", view.statistics());
    target.read(&gpu)?.save(&path)?;
    println!("{path}");
    Ok(())
}
