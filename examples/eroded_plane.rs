//! Erodes a part of an endless terrain, and gives it back as an elevation map: `cargo run --release --example eroded_plane -- out.png`.
//!
//! Erosion needs the ground around each sample, so nodes of endless terrain cannot erode alone. A generator erodes a window of the same
//! plane once. Its heights become an elevation map, whose border blends with the terrain around it. Left: without the map.

use std::error::Error;
use std::sync::Arc;

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::Light;
use relievo::gpu::{Gpu, Options};
use relievo::ops::terrain::generator::Generator;
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{
    Camera, ElevationLayout, ElevationMap, ElevationTiles, EndlessLimits, HeightInterpolation, Hydraulic,
    Quality, Scene, TerrainConfig, TerrainRecipe, TerrainSource, Thermal,
};
use relievo_lab::plot::strip;

/// Width and height of a picture.
const SIZE: [u32; 2] = [640, 400];

/// Patches that are eroded, along each axis.
const PATCHES: i32 = 2;

/// Samples over which the eroded ground blends with the ground around it.
const MARGIN: u32 = 120;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "eroded_plane.png".to_owned());
    let gpu = Gpu::headless(&Options::default())?;
    let config = TerrainConfig {
        coarse_levels: 4,
        interpolation: HeightInterpolation::Smooth,
        triplanar: true,
        variation: 0.7,
        roughness: 1.1,
        texture_tile: Some(16.0),
        ..TerrainConfig::new(513, 1_300.0, "eroded plane")?
    };
    let plain = TerrainSource::endless(config.clone())
        .with_limits(EndlessLimits { nodes_per_frame: 256, ..EndlessLimits::default() });
    let map = eroded(&gpu, &config)?;
    let tiles = ElevationTiles::new(&config, &map)?;
    let pictures = [picture(&gpu, &plain)?, picture(&gpu, &plain.clone().with_elevation(Arc::new(tiles)))?];
    let captions = [vec!["generated".to_owned()], vec!["eroded once, as an elevation map".to_owned()]];
    strip(&pictures, &captions, 2)?.save(&path)?;
    println!("{path}");
    Ok(())
}

/// The eroded heights of patches around the origin.
fn eroded(gpu: &Gpu, config: &TerrainConfig) -> Result<ElevationMap, Box<dyn Error>> {
    let hydraulic = Some(Hydraulic { iterations: 160, ..Hydraulic::default() });
    let thermal_after = Some(Thermal { iterations: 30, talus: 35.0 });
    let recipe = TerrainRecipe { hydraulic, thermal_after, ..TerrainRecipe::new(config.clone()) };
    let generator = Generator::new(gpu, recipe)?;
    let first = -PATCHES / 2;
    let patches: Vec<[i32; 2]> =
        (0..PATCHES * PATCHES).map(|at| [first + at % PATCHES, first + at / PATCHES]).collect();
    let cells = config.patch_size as usize - 1;
    let width = PATCHES as usize * cells + 1;
    let mut heights = vec![0.0; width * width];
    let parts = generator.generate(gpu, &patches, 0, &mut |_| ())?;
    let fields = parts.iter().map(|part| part.read_blocking(gpu)).collect::<Result<Vec<_>, _>>()?;
    for (field, patch) in fields.iter().flatten().zip(&patches) {
        let [column, row] = patch.map(|at| (at - first) as usize * cells);
        for (y, samples) in field.chunks_exact(cells + 1).enumerate() {
            let start = (row + y) * width + column;
            let height = samples.iter().map(|height| *height as f32 / 65_536.0);
            heights[start..start + samples.len()].iter_mut().zip(height).for_each(|(to, from)| *to = from);
        }
    }
    let first = [first * cells as i32; 2];
    let layout = ElevationLayout { spacing: 1, first, size: [width as u32; 2] };
    Ok(ElevationMap { layout, heights, margin: MARGIN })
}

/// A picture with all detail.
fn picture(gpu: &Gpu, source: &TerrainSource) -> Result<RgbaImage, Box<dyn Error>> {
    let mut scene = Scene::new(gpu)?;
    scene.set_light(Light {
        direction: Vec3::new(-0.8, 0.45, 0.3),
        color: Vec3::new(1.5, 1.36, 1.15),
        ambient: 0.3,
    })?;
    let land = scene.add_terrain(source)?;
    let target = Offscreen::new(gpu, SIZE)?;
    let mut renderer = Renderer::new(gpu, target.format())?;
    renderer.prepare(&scene)?;
    let mut view = scene.view(Quality::pixels(1.0))?;
    let ground = scene.ground(land, 0.0, 0.0)?.map_or(0.0, |point| point.height);
    let (eye, middle) = ([-260.0, ground + 330.0, 560.0], [40.0, ground - 40.0, 0.0]);
    view.set(Camera::looking_at_world(eye, middle, 0.75, [2.0, 12_000.0], SIZE))?;
    loop {
        gpu.try_run("picture", |encoder| -> Result<(), relievo::Error> {
            scene.record(encoder, &mut [&mut view])?;
            let draw =
                |pass: &mut relievo::wgpu::RenderPass<'_>| renderer.draw(pass, &scene, &view, Layer::Color);
            Ok(target.record(encoder, [0.42, 0.58, 0.8], draw)?)
        })?;
        if scene.terrain_statistics(land)?.ready == 1.0 {
            break;
        }
    }
    Ok(target.read(gpu)?)
}
