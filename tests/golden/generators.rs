//! What each generator of noise looks like: 2 × 2 patches in low light, seen at an angle. Each patch is a cell of the base
//! lattice.

use glam::{DVec3, Vec3};
use relievo::asset::Light;
use relievo::ops::terrain::config::{BuiltIn, HeightGenerator, TerrainConfig, Zone, ZoneTexture};
use relievo::render::Offscreen;
use relievo::scene::{Camera, Scene, TerrainSource};

use crate::harness::{Tolerance, check_golden, gpu};

const EDGE: u32 = 144;

/// Compares the picture of a generator with its golden.
fn check(generator: HeightGenerator, name: &str) {
    let gpu = gpu();
    let config = TerrainConfig {
        generator,
        roughness: 1.2,
        zones: vec![Zone::new(-200.0, 0.0, Some(ZoneTexture::BuiltIn(BuiltIn::Snow)))],
        ..TerrainConfig::new(257, 50.0, "golden").expect("valid")
    };
    let patches: Vec<_> = (0..4).map(|at| [at % 2, at / 2]).collect();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let light = Light { direction: Vec3::new(-0.8, 0.7, -0.3), ambient: 0.1, ..Light::default() };
    scene.set_light(light).expect("valid");
    scene.add_terrain(&TerrainSource::new(config).with_patches(&patches)).expect("added");
    let eye = DVec3::new(256.0, 560.0, 660.0);
    let target = DVec3::new(256.0, 0.0, 265.0);
    let camera = Camera::looking_at_world(eye, target, 0.75, [1.0, 2000.0], [EDGE; 2]);
    let offscreen = Offscreen::new(&gpu, [EDGE; 2]).expect("allocated");
    offscreen.draw(&mut scene, camera, [0.6, 0.7, 0.8]).expect("drawn");
    let image = offscreen.read(&gpu).expect("read");
    check_golden(name, &image, Tolerance::IMAGE).map_or_else(|error| panic!("{error}"), drop);
}

#[test]
fn fbm() {
    check(HeightGenerator::Fbm, "generator_fbm");
}

#[test]
fn ridged() {
    check(HeightGenerator::Ridged, "generator_ridged");
}

#[test]
fn simplex() {
    check(HeightGenerator::Simplex, "generator_simplex");
}
