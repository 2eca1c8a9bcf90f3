//! Draws a ridge of endless terrain at ever fewer levels of detail: `cargo run --example horizon -- ridge.png`.
//!
//! The columns permit errors of 1, 4 and 16 pixels. The second row shows the triangles.

use std::error::Error;

use image::RgbaImage;
use relievo::gpu::{Gpu, Options};
use relievo::ops::terrain::config::HeightInterpolation;
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{
    Camera, EndlessLimits, ObjectId, Quality, Scene, TerrainConfig, TerrainSource, TerrainStyle,
};
use relievo_lab::plot::strip;

/// Width and height of a picture.
const SIZE: [u32; 2] = [400, 240];

/// Errors that are permitted, in pixels.
const PIXELS: [f32; 3] = [1.0, 4.0, 16.0];

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "ridge.png".to_owned());
    let gpu = Gpu::headless(&Options::default())?;
    let config = TerrainConfig {
        coarse_levels: 8,
        interpolation: HeightInterpolation::Smooth,
        ..TerrainConfig::new(65, 1_400.0, "horizon")?
    };
    let limits =
        EndlessLimits { nodes_per_frame: 256, capacity: 8_192, node_size: 17, ..EndlessLimits::default() };
    let (mut pictures, mut captions) = (Vec::new(), Vec::new());
    for style in [TerrainStyle::Textured, TerrainStyle::Wireframe] {
        let mut scene = Scene::new(&gpu)?;
        let source = TerrainSource::endless(config.clone()).with_limits(limits).with_style(style);
        let land = scene.add_terrain(&source)?;
        scene.set_statistics(true)?;
        for pixels in PIXELS {
            let (picture, triangles) = picture(&mut scene, land, pixels)?;
            pictures.push(picture);
            captions.push(vec![format!("within {pixels} px: {triangles} triangles")]);
        }
    }
    strip(&pictures, &captions, PIXELS.len())?.save(&path)?;
    println!("{path}");
    Ok(())
}

/// A picture with all detail that an error permits, and the number of its triangles.
fn picture(scene: &mut Scene, land: ObjectId, pixels: f32) -> Result<(RgbaImage, u64), Box<dyn Error>> {
    let gpu = scene.gpu().clone();
    let target = Offscreen::new(&gpu, SIZE)?;
    let mut renderer = Renderer::new(&gpu, target.format())?;
    renderer.prepare(scene)?;
    let mut view = scene.view(Quality::pixels(pixels))?;
    let (eye, ridge) = ([0.0, 1_000.0, 5_000.0], [0.0, 320.0, 0.0]);
    view.set(Camera::looking_at_world(eye, ridge, 0.6, [10.0, 40_000.0], SIZE))?;
    loop {
        gpu.try_run("picture", |encoder| -> Result<(), relievo::Error> {
            scene.record(encoder, &mut [&mut view])?;
            let draw =
                |pass: &mut relievo::wgpu::RenderPass<'_>| renderer.draw(pass, scene, &view, Layer::Color);
            Ok(target.record(encoder, [0.42, 0.58, 0.8], draw)?)
        })?;
        if scene.terrain_statistics(land)?.ready == 1.0 {
            break;
        }
    }
    let levels =
        view.statistics().into_iter().flat_map(|seen| &seen.objects).flat_map(|object| &object.levels);
    Ok((target.read(&gpu)?, levels.map(|level| level.triangles).sum()))
}
