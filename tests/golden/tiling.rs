//! Zone textures repeat every `textureTile` world units, across patches and wherever the origin is.

use glam::{DVec3, Vec3};
use image::RgbaImage;
use relievo::asset::Light;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::BuiltIn;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::texture::{TEXTURE_SIZE, TerrainTexture};
use relievo::render::Offscreen;
use relievo::scene::{Camera, Placement, Scene, TerrainSource};

use crate::harness::gpu;

const EDGE: u32 = 256;
const SIZE: u32 = 17;

/// The eastern half of a tile is red, the southern half green.
fn quarters() -> TerrainTexture {
    let mut texture = TerrainTexture::built_in(BuiltIn::Sand);
    for (level, texels) in texture.mips.iter_mut().enumerate() {
        let edge = (TEXTURE_SIZE as usize) >> level;
        for (at, texel) in texels.chunks_exact_mut(4).enumerate() {
            let half = |index: usize| if 2 * index >= edge { 255 } else { 0 };
            texel.copy_from_slice(&[half(at % edge), half(at / edge), 0, 255]);
        }
    }
    texture
}

/// Two flat patches from `first` on, 64 × 32 units, seen from straight above: a pixel is an eighth of a unit, and
/// the first is that of world position (16, 0) from the first patch.
fn drawn(gpu: &Gpu, tile: Option<f64>, first: [i32; 2]) -> RgbaImage {
    let config = TerrainConfig {
        terrain_scale: 2.0,
        texture_tile: tile,
        ..TerrainConfig::new(SIZE, 0.0, "").expect("valid")
    };
    let config = TerrainConfig { zones: config.zones[..1].to_vec(), ..config };
    let fields = Fields::new(gpu, "flat", SIZE + 2, 2).expect("allocated");
    let patches = [first, [first[0] + 1, first[1]]];
    let [x, z] = first.map(|index| 32.0 * f64::from(index));
    let source = TerrainSource::from_fields(config, fields, &patches).with_textures(vec![quarters()]);
    let mut scene = Scene::new(gpu).expect("compiled");
    scene.set_light(Light { ambient: 1.0, ..Light::default() }).expect("valid");
    scene.add_terrain(&source).expect("added");
    let Placement { cell, offset: eye, .. } = Placement::at_world(DVec3::new(x + 32.0, 16.0, z + 16.0));
    let field_of_view = std::f32::consts::FRAC_PI_2;
    let camera = Camera::looking_at(eye, eye - 16.0 * Vec3::Y, field_of_view, [1.0, 100.0], [EDGE; 2]);
    let target = Offscreen::new(gpu, [EDGE; 2]).expect("allocated");
    target.draw(&mut scene, Camera { cell, ..camera }, [0.0, 0.0, 1.0]).expect("drawn");
    target.read(gpu).expect("read")
}

/// Where a pixel's middle lies in its tile, 0..1 eastward and southward. Patches are 32 units wide.
fn in_tile(tile: f64, first: [i32; 2], pixel: [u32; 2]) -> [f64; 2] {
    let from_first = [16.0, 0.0];
    [0, 1].map(|axis| {
        let from_patch = from_first[axis] + (f64::from(pixel[axis]) + 0.5) / 8.0;
        // Where the first patch begins, in tiles: whole numbers of 1/64 units are exact.
        let start = (i64::from(first[axis]) * 32 * 64).rem_euclid((tile * 64.0) as i64) as f64 / 64.0;
        ((start + from_patch) / tile).rem_euclid(1.0)
    })
}

/// Pixels that show another part of the tile than they should; those within two pixels of an edge between two
/// parts are left out, and counted.
fn wrong(image: &RgbaImage, tile: f64, first: [i32; 2]) -> [usize; 2] {
    let (mut wrong, mut skipped) = (0, 0);
    for (x, y, pixel) in image.enumerate_pixels() {
        let at = in_tile(tile, first, [x, y]);
        let near = |part: f64| [0.0, 0.5, 1.0].iter().any(|edge| (part - edge).abs() * tile < 2.0 / 8.0);
        if at.into_iter().any(near) {
            skipped += 1;
            continue;
        }
        let expected = at.map(|part| if part >= 0.5 { 255 } else { 0 });
        let is_right = pixel.0[2] == 0 && (0..2).all(|axis| pixel.0[axis].abs_diff(expected[axis]) < 8);
        wrong += usize::from(!is_right);
    }
    [wrong, skipped]
}

#[test]
fn textures_repeat_as_often_as_the_configuration_says() {
    let gpu = gpu();
    // By default a tenth of patchSize − 1, whatever the distance between samples.
    for (tile, units) in [(None, 1.6), (Some(8.0), 8.0), (Some(5.25), 5.25), (Some(40.0), 40.0)] {
        for first in [[0, 0], [-3, 5], [523_001, -499_999]] {
            if tile.is_none() && first != [0, 0] {
                continue;
            }
            let [wrong, skipped] = wrong(&drawn(&gpu, tile, first), units, first);
            let most = if units < 2.0 { 60_000 } else { 26_000 };
            assert!(wrong == 0 && skipped < most, "{tile:?} at {first:?}: {wrong} wrong, {skipped} left out");
        }
    }
}

#[test]
fn a_tile_of_another_size_is_seen() {
    let gpu = gpu();
    let image = drawn(&gpu, Some(8.0), [0, 0]);
    assert!(wrong(&image, 8.0, [0, 0])[0] == 0 && wrong(&image, 8.25, [0, 0])[0] > 1000);
    assert!(wrong(&image, 8.0, [0, 1])[0] == 0, "a patch is four tiles wide");
    let image = drawn(&gpu, Some(5.25), [0, 0]);
    assert!(wrong(&image, 5.25, [1, 0])[0] > 1000, "patches do not start at the same place of a tile");
}
