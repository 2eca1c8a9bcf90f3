//! No camera sees through a seamless grid.

use glam::{DVec3, Vec3};
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::recipe::Recipe;
use relievo::render::Offscreen;
use relievo::scene::{Camera, Placement, Scene, TerrainSource};

use crate::harness::gpu;

/// Magenta, which no texture has.
const SKY: [f32; 3] = [1.0, 0.0, 1.0];

/// Pixels of sky in views from low above the middle of a 3×3 grid, where all rays hit the ground. `lift` moves
/// the heights of one patch, in units: a planted crack.
fn sky_pixels(lift: i32) -> usize {
    let gpu = gpu();
    let config = TerrainConfig::new(33, 6.0, "cracks").expect("valid");
    let patches: Vec<[i32; 2]> = (0..9).map(|i| [i % 3 - 7, i / 3 + 4]).collect();
    let generator = Generator::new(&gpu, Recipe::new(config.clone())).expect("valid");
    let parts = generator.generate(&gpu, &patches, 1, &mut |_| ()).expect("generated");
    let fields = &parts[0];
    let mut heights = fields.heights.read_blocking(&gpu).expect("read");
    let points = 35 * 35;
    heights[4 * points..5 * points].iter_mut().for_each(|height| *height -= lift << 16);
    fields.heights.write(&gpu, &heights).expect("written");
    let mut scene = Scene::new(&gpu).expect("compiled");
    let first = patches[0].map(|index| 32.0 * f64::from(index));
    scene.add_terrain(&TerrainSource::from_fields(config, fields.clone(), &patches)).expect("added");
    let target = Offscreen::new(&gpu, [640, 480]).expect("allocated");
    // Positions are relative to a cell near the first patch, which lies elsewhere.
    let Placement { cell, offset: corner, .. } = Placement::at_world(DVec3::new(first[0], 0.0, first[1]));
    let mut sky = 0;
    for step in 0..12 {
        let angle = step as f32 * 0.55;
        let center = corner + Vec3::new(48.0, 0.0, 48.0);
        let eye = center + Vec3::new(angle.sin() * 20.0, 34.0, angle.cos() * 20.0);
        let camera = Camera::looking_at(eye, center, 0.7, [0.1, 500.0], target.size());
        target.draw(&mut scene, Camera { cell, ..camera }, SKY).expect("drawn");
        let image = target.read(&gpu).expect("read");
        sky += image.pixels().filter(|pixel| pixel.0[0] > 250 && pixel.0[1] < 5 && pixel.0[2] > 250).count();
    }
    sky
}

#[test]
fn shared_edges_leave_no_crack_from_any_camera() {
    assert_eq!(sky_pixels(0), 0);
}

#[test]
fn a_planted_crack_is_seen() {
    assert!(sky_pixels(2) > 50, "a patch two units lower shows its edges");
}
