//! Draws a character with each of its skeletons: `cargo run --example skeletons -- skeletons.png [model.glb]`.
//!
//! Every row is one skeleton, at five moments of the first clip. The camera stands where the view changes to this skeleton at an
//! error of one pixel, and zooms in.

use std::error::Error;
use std::path::Path;

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::{Light, Model};
use relievo::gpu::{Gpu, Options};
use relievo::ops::skinning::bounding_sphere::BoundingSphere;
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{
    BoneGate, Camera, CharacterOptions, ErrorBudget, Placement, Play, Quality, Scene, SkeletonTier,
};
use relievo_lab::plot::strip;
use relievo_samples::creature;

/// Width and height of a picture.
const SIZE: [u32; 2] = [236, 236];

/// Pictures a row.
const STEPS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().unwrap_or_else(|| "skeletons.png".to_owned());
    let model = match arguments.next() {
        Some(file) => Model::from_file(Path::new(&file))?,
        None => creature()?,
    };
    let gpu = Gpu::headless(&Options::default())?;
    let options = CharacterOptions {
        gate: BoneGate::Off,
        tiers: SkeletonTier::DEFAULT.to_vec(),
        ..CharacterOptions::default()
    };
    let mut scene = Scene::new(&gpu)?;
    scene.set_light(Light { ambient: 0.35, ..Light::default() })?;
    scene.set_error_budget(ErrorBudget { mesh: 0.0, bones: 1.0, influences: 0.0 })?;
    let crowd = scene.add_character_with(&model, 1, &options)?;
    let instance = scene.spawn(crowd, Placement::at([0.0; 3]))?;
    scene.play(instance, &Play::new("0"))?;

    let sphere = BoundingSphere::in_clip(&model, 0);
    let eye = sphere.center + 40.0 * sphere.radius * Vec3::new(0.7, 0.25, 1.0).normalize();
    let field = 2.0 * (0.72_f32 / 40.0).atan();
    let near_and_far = [20.0 * sphere.radius, 60.0 * sphere.radius];
    let target = Offscreen::new(&gpu, SIZE)?;
    let mut renderer = Renderer::new(&gpu, target.format())?;
    renderer.prepare(&scene)?;
    let (mut pictures, mut captions) = (Vec::new(), Vec::new());
    for skeleton in scene.skeletons(crowd)? {
        // What a pixel is at the model, in model units. Bones and their skeleton may use all of it.
        let pixel = 2.0 * 0.72 * sphere.radius / SIZE[1] as f32;
        let mut view = scene.view(Quality::pixels(1.3 * skeleton.error / pixel))?;
        view.set(Camera::looking_at(eye, sphere.center, field, near_and_far, SIZE))?;
        for step in 0..STEPS {
            let seconds = model.clips[0].duration() * step as f32 / STEPS as f32;
            scene.play(instance, &Play { start: scene.time() - f64::from(seconds), ..Play::new("0") })?;
            pictures.push(picture(&mut scene, &mut view, &target, &renderer)?);
            captions.push(vec![format!("{} bones, error {:.3}", skeleton.bones, skeleton.error)]);
        }
    }
    strip(&pictures, &captions, STEPS)?.save(&path)?;
    println!("{path}");
    Ok(())
}

/// A frame of the scene.
fn picture(
    scene: &mut Scene,
    view: &mut relievo::scene::View,
    target: &Offscreen,
    renderer: &Renderer,
) -> Result<RgbaImage, Box<dyn Error>> {
    let gpu = scene.gpu().clone();
    gpu.try_run("picture", |encoder| -> Result<(), relievo::Error> {
        scene.record(encoder, &mut [view])?;
        let draw = |pass: &mut relievo::wgpu::RenderPass<'_>| renderer.draw(pass, scene, view, Layer::Color);
        Ok(target.record(encoder, [0.05, 0.05, 0.06], draw)?)
    })?;
    Ok(target.read(&gpu)?)
}
