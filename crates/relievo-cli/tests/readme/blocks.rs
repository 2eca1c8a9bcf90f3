//! The Rust of README.md and docs/*.md, block by block, each in a function that takes what the block leaves out. It is compiled and not run.
//! `tests/readme.rs` compares the lines between the two marks of a function with those of the document.
#![allow(dead_code, unused_variables, reason = "they are compiled, not run")]

use std::collections::BTreeMap;

use relievo::Error;
use relievo::asset::Model;
use relievo::gpu::{Gpu, Options};
use relievo::ops::animation::ModelMatrices;
use relievo::ops::skinning::frame::{SkinFrame, SkinOptions};
use relievo::ops::skinning::{Blend, InstanceLod};
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::regions::{HeightBatch, RegionPass};
use relievo::ops::terrain::window::Windows;
use relievo::render::{Layer, Renderer, SunShadow, TargetFormat};
use relievo::scene::{
    Camera, CharacterOptions, Criterion, DistanceTo, LevelChoice, LevelOfDetail, ObjectId, Pace, Placement,
    Quality, Scene, SkeletonTier, TerrainSource, Transition, View, join_levels,
};
use relievo_samples::creature;

/// What the program of the README has.
mod own {
    pub const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
}

/// A scene in the render pass of a program.
#[rustfmt::skip]
mod drawing {
    // begin README.md
    use relievo::render::{Layer, Renderer, TargetFormat};
    use relievo::scene::{Camera, Quality, Scene, View};
    use relievo::{Error, gpu::Gpu, wgpu};

    struct Drawing { scene: Scene, view: View, renderer: Renderer }

    impl Drawing {
        fn new(device: &wgpu::Device, queue: &wgpu::Queue, color: wgpu::TextureFormat) -> Result<Self, Error> {
            let gpu = Gpu::from_wgpu(device.clone(), queue.clone()); // yours; WebGPU's default limits suffice
            let scene = Scene::new(&gpu)?; // then add objects
            let mut renderer = Renderer::new(&gpu, &TargetFormat::new(color).with_samples(4))?; // and Depth32Float
            renderer.prepare(&scene)?; // compiles the pipelines
            Ok(Self { view: scene.view(Quality::default())?, scene, renderer })
        }

        fn record(&mut self, camera: Camera, encoder: &mut wgpu::CommandEncoder) -> Result<(), Error> {
            self.view.set(camera)?; // your own matrices
            self.scene.record(encoder, &mut [&mut self.view]) // compute passes; no submission, no wait
        }

        fn draw(&self, pass: &mut wgpu::RenderPass<'_>) -> Result<(), Error> {
            Ok(self.renderer.draw(pass, &self.scene, &self.view, Layer::Color)?) // your render pass, in each frame
        }
    }
    // end
}

/// A character with reduced skeletons and a hand that is always sampled.
#[rustfmt::skip]
fn characters((mut scene, model): (Scene, Model)) -> Result<(), Error> {
    // begin docs/characters.md
    let options = CharacterOptions {
        tiers: SkeletonTier::DEFAULT.to_vec(),                            // half of the bones, a quarter, rigid parts
        priorities: BTreeMap::from([("hand_left", 1.0)]),                 // sampled in every frame
        ..CharacterOptions::default()
    };
    let crowd = scene.add_character_with(&model, 100, &options)?;
    for skeleton in scene.skeletons(crowd)? {
        println!("{} bones, {} off, {} bytes", skeleton.bones, skeleton.error, skeleton.bytes);
    }
    // end
    Ok(())
}

/// A scene in a program, with what that has already.
#[rustfmt::skip]
fn scene(
    (device, queue): (&wgpu::Device, &wgpu::Queue),
    (mut encoder, mut pass): (wgpu::CommandEncoder, wgpu::RenderPass<'_>),
    (config, patches): (TerrainConfig, Vec<[i32; 2]>),
    (model, place, at): (Model, Placement, usize),
    camera: Camera,
) -> Result<(), Error> {
    // begin docs/embedding.md
    let gpu = Gpu::from_wgpu(device.clone(), queue.clone());              // yours; WebGPU's default limits suffice
    let mut scene = Scene::new(&gpu)?;                                    // x east, y up, z south
    let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&patches))?;
    let crowd = scene.add_character(&model, 50)?;                         // sampled, gated, skinned on the device
    let walker = scene.spawn(crowd, place.turned(0.9 * at as f32).scaled(2.0))?; // about +Y, radians; twice as large
    let format = TargetFormat::new(own::COLOR).with_samples(4);           // of your targets
    let mut renderer = Renderer::new(&gpu, &format)?;
    renderer.prepare(&scene)?;                                            // compiles; again after objects were added
    let mut eye = scene.view(Default::default())?;                        // at most a pixel off
    eye.set(camera)?;                                                     // per frame: your own matrices
    scene.advance(0.5)?;                                                  // seconds
    scene.record(&mut encoder, &mut [&mut eye])?;                         // all views; no submission, no wait
    renderer.draw(&mut pass, &scene, &eye, Layer::Color)?;                // your pass
    // end
    Ok(())
}

/// The shadow of a light.
#[rustfmt::skip]
fn shadow((mut scene, mut eye): (Scene, View), mut encoder: wgpu::CommandEncoder) -> Result<(), Error> {
    // begin docs/embedding.md
    let mut shadow = SunShadow::new(&mut scene, 2048)?;                   // texels along an edge; then prepare renderers
    shadow.fit(&scene, &mut [&mut eye], 120.0)?;                          // per frame: up to 120 units ahead of the eye
    scene.record(&mut encoder, &mut [&mut eye, shadow.view()])?;          // casters outside of the eye's view, too
    shadow.draw(&mut encoder, &scene)?;                                   // its map
    // end
    Ok(())
}

/// A scene in a browser.
#[rustfmt::skip]
async fn browser(config: TerrainConfig, mut renderer: Renderer) -> Result<(), Error> {
    // begin docs/embedding.md
    let gpu = Gpu::headless_async(&Options::default()).await?;            // or Gpu::from_wgpu
    let mut scene = Scene::new_async(&gpu).await?;
    let land = scene.add_terrain_async(&TerrainSource::new(config)).await?;
    let walkers = scene.add_character_async(&creature()?, 3).await?;
    renderer.prepare_async(&scene).await?;
    scene.health()?;                                                      // per frame
    // end
    Ok(())
}

/// Heights of terrain, over buffers of the program.
#[rustfmt::skip]
fn heights(
    (device, queue): (&wgpu::Device, &wgpu::Queue),
    (patches, mut encoder): (Vec<[i32; 2]>, wgpu::CommandEncoder),
    mut scene: Scene,
) -> Result<(), Error> {
    // begin docs/embedding.md
    let gpu = Gpu::from_wgpu(device.clone(), queue.clone());              // yours, or Gpu::headless
    let config = TerrainConfig::new(257, 40.0, "any text")?;
    let pass = RegionPass::new(&gpu, &config, None)?;                     // compiles once
    let windows = Windows { count: 64, apron: 1 };                         // patches, with a sample of margin
    let batch = HeightBatch::new(&gpu, &pass, &config, windows, 0)?;      // no injected points; allocates once
    let land = TerrainSource::from_fields(config, batch.fields()[0].clone(), &[]); // a scene shares the heights
    let land = scene.add_terrain(&land)?;
    batch.set(&gpu, &patches, &Features::default())?;                     // which patches, and their features
    batch.record(&mut encoder);                                           // your encoder: no submission, wait or allocation
    scene.set_patches(land, &patches, [-80.0, 80.0])?;                    // the patches, and the range of their heights
    // end
    Ok(())
}

/// Skinning of a mesh, over buffers of the program.
#[rustfmt::skip]
fn skinning(
    (gpu, mut encoder): (Gpu, wgpu::CommandEncoder),
    (fox, matrices): (Model, &ModelMatrices),
    lods: &[InstanceLod],
) -> Result<(), Error> {
    // begin docs/embedding.md
    let options = SkinOptions { mesh: 0, instances: 1000, blend: Blend::Linear };
    let skin = SkinFrame::new(&gpu, &fox, matrices, options)?;
    skin.crowd.instance_lods.write(&gpu, lods)?;                          // who is seen, how coarse
    skin.record_updated_bones(&mut encoder);                              // per frame: clusters with a bone that moved
    let (vertices, triangles) = (&skin.skinned, &skin.mesh.indices);      // instance · vertices + index
    // end
    Ok(())
}

/// Levels of detail by distance, with a fade and a budget.
#[rustfmt::skip]
fn levels((mut scene, mut view): (Scene, View), mut renderer: Renderer, tree: ObjectId) -> Result<(), Error> {
    // begin docs/levels.md
    let criterion = Criterion::Distance { to: DistanceTo::Center, from: vec![20.0, 60.0, 200.0] }; // world units
    let level_of_detail = LevelOfDetail {
        choice: LevelChoice::By(criterion),
        transition: Transition::Dither(Pace::Seconds(0.3)),
        rank: Some(0),                                                    // coarsened first
        ..LevelOfDetail::default()
    };
    scene.set_level_of_detail(tree, &level_of_detail)?;
    renderer.prepare(&scene)?;                                            // a new transition has pipelines of its own
    view.set_quality(Quality { triangles: Some(500_000), ..Quality::pixels(1.0) })?;
    // end
    Ok(())
}

#[rustfmt::skip]
fn levels_that_an_artist_made(scene: &mut Scene) -> Result<(), Error> {
    // begin docs/levels.md
    let near = Model::from_file("man.glb".as_ref())?;
    let far = Model::from_file("man_far.glb".as_ref())?;
    let man = scene.add_character(&join_levels(&[near, far])?, 100)?;
    // end
    Ok(())
}
