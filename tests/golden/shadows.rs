//! The shadow of the sun on ground, rock, relief and characters.

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::Light;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::{Layer, Offscreen, Renderer, SunShadow};
use relievo::scene::{Camera, Placement, Play, Relief, Scene, TerrainSource};
use relievo_samples::maps::BuiltInMap;
use relievo_samples::{creature, rock};

use crate::harness::{Difference, Tolerance, check_golden, gpu};

const SIZE: [u32; 2] = [176, 112];

/// Drawn at twice the size, with a shadow that may fall from elsewhere, and averaged.
fn picture(sun: Vec3) -> RgbaImage {
    let gpu = gpu();
    let mut scene = Scene::new(&gpu).expect("compiled");
    scene.set_light(Light { direction: sun, ambient: 0.25, ..Light::default() }).expect("a light");
    let config = TerrainConfig::new(33, 4.0, "shadows").expect("valid");
    let land = scene.add_terrain(&TerrainSource::new(config)).expect("generated");
    let ground = |scene: &Scene, x: f64, z: f64| {
        let height = scene.ground(land, x, z).expect("terrain").expect("inside").height;
        Placement::at_world([x, height, z])
    };
    let walkers = scene.add_character(&creature().expect("valid"), 2).expect("added");
    for (at, x) in [14.0, 19.0].into_iter().enumerate() {
        let place = ground(&scene, x, 20.0 - at as f64).turned(0.5 + at as f32).scaled(2.0);
        let walker = scene.spawn(walkers, place).expect("room");
        scene.play(walker, &Play { start: -0.4 * at as f64, ..Play::new("walk") }).expect("the clip");
    }
    let rocks = scene.add_mesh(&rock().expect("valid"), 2).expect("added");
    let place = ground(&scene, 10.0, 16.0).turned(0.8).scaled(1.5);
    scene.spawn(rocks, place).expect("room");
    // Beside the picture: only its shadow shows.
    let beside = ground(&scene, 5.5, 25.0);
    scene
        .spawn(rocks, Placement { offset: beside.offset + Vec3::Y * 3.0, ..beside.scaled(1.5) })
        .expect("room");
    let bricks = BuiltInMap::Bricks;
    let (heights, colors) = (bricks.height_map(128).expect("a map"), bricks.albedo(128).expect("colours"));
    let walls = scene.add_relief(&Relief::wall(2.0, heights, colors), 1).expect("added");
    let place = ground(&scene, 17.0, 13.0);
    scene
        .spawn(walls, Placement { offset: place.offset + Vec3::Y * 2.0, ..place.turned(0.2).scaled(7.0) })
        .expect("room");

    let size = SIZE.map(|edge| 2 * edge);
    let target = Offscreen::new(&gpu, size).expect("allocated");
    let mut shadow = SunShadow::new(&mut scene, 1024).expect("a shadow");
    let mut renderer = Renderer::new(&gpu, target.format()).expect("a format");
    renderer.prepare(&scene).expect("compiled");
    let mut eye = scene.view(Default::default()).expect("a view");
    let focus = ground(&scene, 15.5, 17.0).world().as_vec3() + Vec3::Y;
    let camera = Camera::looking_at(focus + Vec3::new(-1.0, 7.0, 14.0), focus, 0.75, [0.1, 200.0], size);
    eye.set(camera).expect("a camera");
    shadow.fit(&scene, &mut [&mut eye], 30.0).expect("fitted");
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [&mut eye, shadow.view()]).expect("recorded");
    shadow.draw(&mut encoder, &scene).expect("drawn");
    let draw = |pass: &mut relievo::wgpu::RenderPass<'_>| renderer.draw(pass, &scene, &eye, Layer::Color);
    target.record(&mut encoder, [0.36, 0.55, 0.8], draw).expect("drawn");
    gpu.queue().submit([encoder.finish()]);
    let image = target.read(&gpu).expect("read");
    image::imageops::resize(&image, SIZE[0], SIZE[1], image::imageops::FilterType::Triangle)
}

#[test]
fn everything_lies_in_the_shadow_of_everything() {
    let sun = Vec3::new(-0.75, 0.55, 0.35);
    let picture = picture(sun);
    check_golden("shadows", &picture, Tolerance::IMAGE).expect("the golden");
    // A sun that is elsewhere is told from it.
    let other = self::picture(Vec3::new(-0.6, 0.55, 0.35));
    let found = Difference::of(&other, &picture, Tolerance::IMAGE.levels);
    assert!(!found.within(Tolerance::IMAGE), "{found:?}");
}
