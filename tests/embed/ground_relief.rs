//! The relief of the ground's textures.

use image::{DynamicImage, Rgba, RgbaImage};
use relievo::InputError;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::{Slope, TerrainConfig, Zone};
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::texture::TerrainTexture;
use relievo::render::Offscreen;
use relievo::scene::{Camera, EndlessLimits, GroundRelief, Scene, TerrainSource};
use relievo_testing::{Difference, Tolerance};

use crate::frame::device;

const SIZE: [u32; 2] = [160, 120];

/// Depth of the relief in world units.
const DEPTH: f32 = 0.5;

/// Level ground of one zone, whose texture covers 4 units.
fn flat() -> TerrainConfig {
    let config = TerrainConfig::new(33, 0.0, "flat").expect("valid");
    let zone = Zone { min: -9.0, max: 9.0, slope: Slope::default(), ..config.zones[0].clone() };
    TerrainConfig { zones: vec![zone], texture_tile: Some(4.0), ..config }
}

/// A smooth pattern whose alpha channel says the height, 0 to 255.
fn texture(height: impl Fn(u32, u32) -> u8) -> TerrainTexture {
    let wave = |at: u32, turns: f32| {
        (127.0 + 110.0 * (turns * std::f32::consts::TAU * at as f32 / 64.0).sin()) as u8
    };
    let texel = |x, y| Rgba([wave(x, 1.0), wave(y, 2.0), wave(x + y, 1.0), height(x, y)]);
    TerrainTexture::from_image(&DynamicImage::ImageRgba8(RgbaImage::from_fn(64, 64, texel)))
}

/// The ground seen from `height` units above it, in a direction that goes down by `down` for each unit ahead.
fn shot(gpu: &Gpu, source: &TerrainSource, height: f64, down: f64) -> RgbaImage {
    let mut scene = Scene::new(gpu).expect("compiled");
    let land = scene.add_terrain(source).expect("added");
    let eye = [16.0, height, 16.0];
    let camera = Camera::looking_at_world(eye, [17.0, height - down, 15.4], 0.9, [0.05, 100.0], SIZE);
    let target = Offscreen::new(gpu, SIZE).expect("allocated");
    for _ in 0..50 {
        target.draw(&mut scene, camera, [0.0; 3]).expect("drawn");
        if scene.terrain_statistics(land).is_ok_and(|all| all.ready < 1.0) {
            continue;
        }
        break;
    }
    target.read(gpu).expect("read")
}

fn relief(distance: f32) -> GroundRelief {
    GroundRelief { depth: DEPTH, distance }
}

/// A relief whose texels all have one height is a plane below the ground. It looks like flat ground seen from an eye that much higher.
#[test]
fn a_level_relief_is_ground_that_lies_lower() {
    let gpu = device();
    for (height, name) in [(255, "highest"), (128, "half"), (0, "lowest")] {
        let source = TerrainSource::new(flat()).with_textures(vec![texture(|_, _| height)]);
        let lower = f64::from(DEPTH) * (1.0 - f64::from(height) / 255.0);
        let seen = shot(&gpu, &source.clone().with_relief(relief(1e4)), 2.0, 1.6);
        let expected = shot(&gpu, &source, 2.0 + lower, 1.6);
        let difference = Difference::of(&seen, &expected, 3);
        println!("{name}: {difference:?}");
        assert!(difference.flip < Tolerance::IMAGE.here().flip, "{name}: {difference:?}");
        // The comparison sees a relief of another depth.
        let other = Difference::of(&seen, &shot(&gpu, &source, 2.0 + lower + 0.1, 1.6), 3);
        assert!(other.flip > 0.03, "{name}: {other:?}");
    }
}

/// The same on a slope of 45°, whose relief lies lower along the normal.
#[test]
fn a_level_relief_of_a_slope_is_a_slope_that_lies_lower() {
    let gpu = device();
    let config = flat();
    let zones = vec![Zone { min: -400.0, max: 0.0, ..config.zones[0].clone() }];
    let config = TerrainConfig { zones, ..config };
    let slope = |lower: f64| {
        let generator = Generator::new(&gpu, Recipe::new(config.clone())).expect("compiled");
        let fields = generator.generate(&gpu, &[[0, 0]], 1, &mut |_| ()).expect("generated").remove(0);
        let height = |at: u32| ((f64::from(at % 35) - 1.0 - lower) * 65_536.0).round() as i32;
        let heights: Vec<i32> = (0..35 * 35).map(height).collect();
        fields.heights.write(&gpu, &heights).expect("written");
        let textures = vec![texture(|_, _| 128)];
        TerrainSource::from_fields(config.clone(), fields, &[[0, 0]]).with_textures(textures)
    };
    let lower = f64::from(DEPTH) * (1.0 - 128.0 / 255.0);
    let seen = shot(&gpu, &slope(0.0).with_relief(relief(1e4)), 18.0, 1.6);
    let difference = Difference::of(&seen, &shot(&gpu, &slope(lower * 2_f64.sqrt()), 18.0, 1.6), 3);
    println!("{difference:?}");
    assert!(difference.flip < 0.01, "{difference:?}");
    assert!(Difference::of(&seen, &shot(&gpu, &slope(lower), 18.0, 1.6), 3).flip > 0.015);
}

/// Beyond its distance, and where there is none, textures are flat to the bit.
#[test]
fn the_relief_ends_at_its_distance() {
    let gpu = device();
    let bumps = texture(|x, y| if (x / 16 + y / 16) % 2 == 0 { 255 } else { 0 });
    let source = TerrainSource::new(flat()).with_textures(vec![bumps]);
    let flat = shot(&gpu, &source, 2.0, 1.6);
    let near = shot(&gpu, &source.clone().with_relief(relief(1e4)), 2.0, 1.6);
    assert!(Difference::of(&near, &flat, 3).flip > 0.03);
    // Nothing is nearer than 2 units.
    assert!(shot(&gpu, &source.clone().with_relief(relief(2.0)), 2.0, 1.6) == flat);
    // Between both, the upper part of the picture is flat, and the lower one is not.
    let fades = shot(&gpu, &source.with_relief(relief(3.2)), 2.0, 1.6);
    let part = |image: &RgbaImage, top: u32| image::imageops::crop_imm(image, 0, top, SIZE[0], 20).to_image();
    assert!(part(&fades, 0) == part(&flat, 0) && part(&fades, 100) != part(&flat, 100));
}

/// Endless terrain has the same relief.
#[test]
fn endless_terrain_has_the_relief_of_patches() {
    let gpu = device();
    let bumps =
        || vec![texture(|x, y| (128.0 + 120.0 * ((x as f32 * 0.2).sin() * (y as f32 * 0.2).cos())) as u8)];
    let patches = TerrainSource::new(flat()).with_textures(bumps()).with_relief(relief(6.0));
    let limits = EndlessLimits { node_size: 17, nodes_per_frame: 64, ..EndlessLimits::default() };
    let endless = TerrainSource::endless(TerrainConfig { coarse_levels: 2, ..flat() })
        .with_limits(limits)
        .with_textures(bumps());
    let [patches, with, without] = [patches, endless.clone().with_relief(relief(6.0)), endless]
        .map(|source| shot(&gpu, &source, 2.0, 1.6));
    let difference = Difference::of(&with, &patches, 3);
    assert!(difference.flip < 0.005, "{difference:?}");
    assert!(Difference::of(&without, &patches, 3).flip > 0.02);
}

#[test]
fn reliefs_out_of_their_ranges_are_refused() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    for (depth, distance, path) in [
        (0.0, 9.0, "relief.depth"),
        (f32::NAN, 9.0, "relief.depth"),
        (1001.0, 9.0, "relief.depth"),
        (1.0, 0.0, "relief.distance"),
        (1.0, f32::INFINITY, "relief.distance"),
    ] {
        for source in [TerrainSource::new(flat()), TerrainSource::endless(flat())] {
            let refused = scene.add_terrain(&source.with_relief(GroundRelief { depth, distance }));
            match refused {
                Err(relievo::Error::Input(InputError { path: found, .. })) => assert_eq!(found, path),
                other => panic!("{depth} {distance}: {other:?}"),
            }
        }
    }
}
