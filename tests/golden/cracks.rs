//! No camera sees through a seamless grid.

use glam::Vec3;
use relievo::render::target::COLOR_FORMAT;
use relievo::render::{Camera, Materials, Style, Target, TerrainRenderer};
use relievo::terrain::blend::Shading;
use relievo::terrain::config::Config;
use relievo::terrain::fields::Fields;
use relievo::terrain::generator::Generator;
use relievo::terrain::recipe::Recipe;
use relievo::terrain::texture::Texture;

use crate::harness::gpu;

/// Magenta, which no texture has.
const SKY: [f64; 3] = [1.0, 0.0, 1.0];

/// Pixels of sky in views from low above the middle of a 3×3 grid, where all rays hit the ground. `lift` moves
/// the heights of one patch, in units: a planted crack.
fn sky_pixels(lift: i32) -> usize {
    let gpu = gpu();
    let config = Config::new(33, 6.0, "cracks").expect("valid");
    let patches: Vec<[i32; 2]> = (0..9).map(|i| [i % 3 - 7, i / 3 + 4]).collect();
    let generator = Generator::new(&gpu, Recipe::new(config.clone())).expect("valid");
    let parts = generator.generate(&gpu, &patches, 1, &mut |_| ()).expect("generated");
    let mut heights = parts[0].heights.read_blocking(&gpu).expect("read");
    let points = 35 * 35;
    heights[4 * points..5 * points].iter_mut().for_each(|height| *height -= lift << 16);
    let fields = Fields::new(&gpu, "heights", 35, 9).expect("allocated");
    fields.heights.write(&gpu, &heights).expect("written");
    let textures = Texture::of_zones(&config.zones).expect("built in");
    let materials = Materials::new(&gpu, &config.zones, &textures).expect("uploaded");
    let renderer = TerrainRenderer::new(&gpu, COLOR_FORMAT, Style::Textured).expect("compiled");
    let mut scene = renderer.scene(&gpu, &materials, &Shading::default()).expect("bound");
    scene.add(&gpu, &config, &fields, &patches, patches[0]).expect("added");
    let target = Target::new(&gpu, [640, 480]).expect("allocated");
    let mut sky = 0;
    for step in 0..12 {
        let angle = step as f32 * 0.55;
        let center = Vec3::new(48.0, 0.0, 48.0);
        let eye = center + Vec3::new(angle.sin() * 20.0, 34.0, angle.cos() * 20.0);
        let camera = Camera { eye, target: center, field_of_view: 0.7, near: 0.1, far: 500.0 };
        scene.set_camera(&gpu, &camera, target.aspect()).expect("a camera");
        target.draw(&gpu, SKY, |pass| scene.draw(pass)).expect("drawn");
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
