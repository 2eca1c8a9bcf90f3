//! Draws a character with each of its skeletons: `cargo run --example skeletons -- skeletons.png [model.glb]`.
//!
//! The first rows show one skeleton each, at five moments of the first clip, much nearer than the view would use it. Each further row
//! shows a change of skeleton: five successive frames of a camera that moves away, with an error of at most one pixel, enlarged.

use std::error::Error;
use std::path::Path;

use glam::Vec3;
use image::RgbaImage;
use image::imageops::{FilterType, resize};
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
const SIZE: [u32; 2] = [240, 240];

/// Pictures a row.
const STEPS: usize = 5;

/// Frames of a row that come after the change of skeleton.
const AFTER: usize = 2;

/// Distance of the camera in radii of the model.
const RADII: f32 = 40.0;

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
    let away = RADII * sphere.radius * Vec3::new(0.7, 0.25, 1.0).normalize();
    let near_and_far = [0.5 * RADII * sphere.radius, 2.0 * RADII * sphere.radius];
    // What a pixel is at the model in the first rows, in model units.
    let pixel = 2.0 * 0.72 * sphere.radius / SIZE[1] as f32;
    let target = Offscreen::new(&gpu, SIZE)?;
    let mut renderer = Renderer::new(&gpu, target.format())?;
    renderer.prepare(&scene)?;
    let (mut pictures, mut captions) = (Vec::new(), Vec::new());
    for skeleton in scene.skeletons(crowd)? {
        let mut view = scene.view(Quality::pixels(1.3 * skeleton.error / pixel))?;
        let camera = [sphere.center + away, sphere.center];
        view.set(Camera::looking_at(
            camera[0],
            camera[1],
            field_of(pixel, SIZE[1], &away),
            near_and_far,
            SIZE,
        ))?;
        for step in 0..STEPS {
            let seconds = model.clips[0].duration() * step as f32 / STEPS as f32;
            scene.play(instance, &Play { start: scene.time() - f64::from(seconds), ..Play::new("0") })?;
            pictures.push(picture(&mut scene, &mut view, &target, &renderer)?);
            captions.push(vec![format!("{} bones, error {:.3}", skeleton.bones, skeleton.error)]);
        }
    }
    scene.set_statistics(true)?;
    for skeleton in scene.skeletons(crowd)?.iter().skip(1) {
        // A pixel is as large as the skeleton's error somewhere on the camera's way. The picture is enlarged to `SIZE`.
        let pixel = skeleton.error / 0.8;
        let zoom = (SIZE[1] as f32 / (1.4 * sphere.radius / pixel)).max(1.0) as u32;
        let size = SIZE.map(|edge| edge / zoom.min(16));
        let target = Offscreen::new(&gpu, size)?;
        let mut view = scene.view(Quality::pixels(1.0))?;
        let mut frames: Vec<(RgbaImage, u32)> = Vec::new();
        let mut distance = 0.8;
        let mut after = 0;
        while after < AFTER && distance < 1.5 {
            let camera = [sphere.center + distance * away, sphere.center];
            view.set(Camera::looking_at(
                camera[0],
                camera[1],
                field_of(pixel, size[1], &away),
                near_and_far,
                size,
            ))?;
            let picture = picture(&mut scene, &mut view, &target, &renderer)?;
            let bones = scene.statistics().map_or(0, |all| all.characters.iter().map(|own| own.bones).sum());
            let has_changed =
                frames.len() + AFTER >= STEPS && frames.last().is_some_and(|(_, last)| bones < *last);
            after += usize::from(after > 0 || has_changed);
            frames.push((resize(&picture, SIZE[0], SIZE[1], FilterType::Nearest), bones));
            scene.advance(1.0 / 60.0)?;
            distance *= 1.005;
        }
        for (picture, bones) in frames.split_off(frames.len().saturating_sub(STEPS)) {
            pictures.push(picture);
            let zoomed = if zoom > 1 { format!(", enlarged {zoom} times") } else { String::new() };
            captions.push(vec![format!("{bones} bones sampled{zoomed}")]);
        }
    }
    strip(&pictures, &captions, STEPS)?.save(&path)?;
    println!("{path}");
    Ok(())
}

/// The vertical field of view at which a pixel of `lines` is `pixel` model units large, `away` from the eye.
fn field_of(pixel: f32, lines: u32, away: &Vec3) -> f32 {
    2.0 * (0.5 * lines as f32 * pixel / away.length()).atan()
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
