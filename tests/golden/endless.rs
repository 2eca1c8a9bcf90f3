//! Endless terrain as a walker and a flyer see it, a million samples from the origin.

use glam::Vec3;
use relievo::asset::Light;
use relievo::ops::terrain::config::HeightInterpolation;
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{Camera, EndlessLimits, Quality, Scene, TerrainConfig, TerrainSource};
use relievo::wgpu;

use crate::harness::{Tolerance, check_golden, gpu};

const SIZE: [u32; 2] = [192, 108];

/// Compares the picture `height` units above the ground with its golden.
fn check(height: f64, name: &str) {
    let gpu = gpu();
    let config = TerrainConfig {
        coarse_levels: 7,
        interpolation: HeightInterpolation::Smooth,
        triplanar: true,
        variation: 0.7,
        ..TerrainConfig::new(65, 700.0, "golden").expect("valid")
    };
    let mut scene = Scene::new(&gpu).expect("compiled");
    let light = Light { direction: Vec3::new(-0.8, 0.5, 0.3), ambient: 0.25, ..Light::default() };
    scene.set_light(light).expect("valid");
    let limits = EndlessLimits { nodes_per_frame: 128, ..EndlessLimits::default() };
    let land = scene.add_terrain(&TerrainSource::endless(config).with_limits(limits)).expect("added");
    let at = [1.0e6, 2_000.0];
    let ground = scene.ground(land, at[0], at[1]).expect("valid").expect("ground").height;
    let eye = [at[0], ground + height, at[1]];
    let target = [at[0] + 300.0, ground + 0.8 * height, at[1] + 1_000.0];
    let camera = Camera::looking_at_world(eye, target, 0.8, [0.5, 12_000.0], SIZE);
    let offscreen = Offscreen::new(&gpu, SIZE).expect("allocated");
    let mut view = scene.view(Quality::default()).expect("made");
    view.set(camera).expect("valid");
    for _ in 0..200 {
        gpu.try_run("detail", |encoder| scene.record(encoder, &mut [&mut view])).expect("recorded");
        if scene.terrain_statistics(land).expect("endless").ready == 1.0 {
            break;
        }
    }
    let mut renderer = Renderer::new(&gpu, offscreen.format()).expect("a format");
    renderer.prepare(&scene).expect("compiled");
    let drawn = gpu.try_run("picture", |encoder| -> Result<(), relievo::Error> {
        scene.record(encoder, &mut [&mut view])?;
        let draw = |pass: &mut wgpu::RenderPass<'_>| renderer.draw(pass, &scene, &view, Layer::Color);
        Ok(offscreen.record(encoder, [0.42, 0.58, 0.8], draw)?)
    });
    drawn.expect("drawn");
    let image = offscreen.read(&gpu).expect("read");
    check_golden(name, &image, Tolerance::IMAGE).map_or_else(|error| panic!("{error}"), drop);
}

#[test]
fn walked() {
    check(2.0, "endless_walked");
}

#[test]
fn flown() {
    check(900.0, "endless_flown");
}
