//! A meadow: grass, a kind of object that the library does not know, on terrain, in the light and the shadow of a low sun, with
//! creatures in it. The kind is `grass.rs` and `grass.wgsl`. Writes `kind.png`.
//!
//! `cargo run --release --example kind`

mod grass;

use glam::{DVec3, Vec3};
use relievo::asset::Light;
use relievo::gpu::{Gpu, Options};
use relievo::render::{Layer, Offscreen, Renderer, SunShadow, TargetFormat};
use relievo::scene::{Camera, Placement, Play, Quality, Scene, TerrainConfig, TerrainSource};
use relievo_samples::creature;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::headless(&Options::default())?;
    let mut scene = Scene::new(&gpu)?;
    let land = scene.add_terrain(&TerrainSource::new(TerrainConfig::new(129, 7.0, "meadow")?))?;
    let ground = |scene: &Scene, x: f64, z: f64| {
        let point = scene.ground(land, x, z).ok().flatten();
        DVec3::new(x, point.map_or(0.0, |point| point.height), z)
    };
    let mut model = creature()?;
    relievo::scene::add_levels(&mut model, &[0], 60)?;
    let crowd = scene.add_character(&model, 8)?;
    for at in 0..6 {
        let place = ground(&scene, 54.0 + 3.0 * f64::from(at % 3), 56.0 + 4.0 * f64::from(at / 3));
        let walker = scene.spawn(crowd, Placement::at_world(place).turned(0.9 * at as f32).scaled(0.8))?;
        scene.set_tint(walker, [0.55, 0.36, 0.22, 1.0])?;
        scene.play(walker, &Play { start: -0.4 * f64::from(at), ..Play::new("walk") })?;
    }
    let meadow = scene.add_kind(grass::Grass::new(&gpu, 48)?, 6400)?;
    for at in 0..6400_u32 {
        let (column, row) = (f64::from(at % 80), f64::from(at / 80));
        let away = |seed: f64| (seed * 12.9898).sin().fract() * 0.3;
        let place = ground(
            &scene,
            36.0 + 0.5 * column + away(f64::from(at)),
            36.0 + 0.5 * row + away(f64::from(at) + 0.5),
        );
        let scale = 1.0 + away(f64::from(at) + 0.25) as f32;
        scene.spawn(meadow, Placement::at_world(place).turned(at as f32).scaled(scale))?;
    }
    scene.set_light(Light {
        direction: Vec3::new(-0.8, 0.5, 0.2),
        color: Vec3::new(1.5, 1.35, 1.1),
        ambient: 0.3,
    })?;

    let target = Offscreen::with_format(&gpu, [960, 540], TargetFormat::srgb().with_samples(4))?;
    let mut shadow = SunShadow::new(&mut scene, 4096)?;
    let mut renderer = Renderer::new(&gpu, target.format())?;
    renderer.prepare(&scene)?;
    let mut view = scene.view(Quality::pixels(1.0))?;
    let (eye, focus) =
        (ground(&scene, 58.0, 66.0) + 2.2 * DVec3::Y, ground(&scene, 56.0, 56.0) + 0.6 * DVec3::Y);
    view.set(Camera::looking_at_world(eye, focus, 0.8, [0.1, 400.0], target.size()))?;

    scene.advance(0.7)?;
    let mut encoder = gpu.encoder("frame");
    shadow.fit(&scene, &mut [&mut view], 40.0)?;
    scene.record(&mut encoder, &mut [&mut view, shadow.view()])?;
    shadow.draw(&mut encoder, &scene)?;
    target
        .record(&mut encoder, [0.42, 0.58, 0.8], |pass| renderer.draw(pass, &scene, &view, Layer::Color))?;
    gpu.queue().submit([encoder.finish()]);
    target.read(&gpu)?.save("kind.png")?;
    Ok(())
}
