//! Creatures walk over generated terrain.

use relievo::glam::DVec3;
use relievo::gpu::{Gpu, Options};
use relievo::render::{Layer, Offscreen, Renderer, SunShadow, TargetFormat};
use relievo::scene::*;
use relievo_samples::creature;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::headless(&Options::default())?;
    let mut scene = Scene::new(&gpu)?;
    let config = TerrainConfig::new(257, 40.0, "any text")?; // samples along an edge, range of heights, seed
    let patches = [[1, 1], [2, 1], [1, 2], [2, 2]]; // counted to the east and to the south
    let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&patches))?;
    let ground = |scene: &Scene, x: f64, z: f64| {
        let point = scene.ground(land, x, z).ok().flatten();
        DVec3::new(x, point.map_or(0.0, |point| point.height), z)
    };
    let mut model = creature()?;
    add_levels(&mut model, &[0], 60)?; // levels of detail for the first clip, from 60 of its poses
    let crowd = scene.add_character(&model, 40)?;
    for at in 0..40 {
        let place = ground(&scene, 650.0 + 4.0 * f64::from(at % 5), 600.0 + 5.0 * f64::from(at / 5));
        let walker = scene.spawn(crowd, Placement::at_world(place).turned(0.4).scaled(1.8))?;
        scene.play(walker, &Play { start: -0.31 * f64::from(at), ..Play::new("walk") })?;
    }

    let target = Offscreen::with_format(&gpu, [960, 540], TargetFormat::srgb().with_samples(4))?;
    let mut shadow = SunShadow::new(&mut scene, 4096)?; // texels along an edge of its map
    let mut renderer = Renderer::new(&gpu, target.format())?;
    renderer.prepare(&scene)?;
    let mut view = scene.view(Quality::pixels(1.0))?; // at most a pixel off
    let (eye, focus) = (ground(&scene, 660.0, 655.0) + 6.0 * DVec3::Y, ground(&scene, 660.0, 580.0));
    view.set(Camera::looking_at_world(eye, focus, 0.8, [0.1, 2000.0], target.size()))?;
    let (mut encoder, sky) = (gpu.encoder("frame"), [0.42, 0.58, 0.8]);
    shadow.fit(&scene, &mut [&mut view], 150.0)?; // up to 150 units ahead of the eye
    scene.record(&mut encoder, &mut [&mut view, shadow.view()])?;
    shadow.draw(&mut encoder, &scene)?;
    target.record(&mut encoder, sky, |pass| renderer.draw(pass, &scene, &view, Layer::Color))?;
    gpu.queue().submit([encoder.finish()]);
    target.read(&gpu)?.save("first.png")?;
    Ok(())
}
