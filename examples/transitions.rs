//! Draws how each transition changes a level of detail: `cargo run --example transitions -- transitions.png`.
//!
//! Every row is one transition of the same object. From left to right the camera goes away while it zooms in, so that only the
//! level changes. The shading paints the finer level orange and the coarser one blue.

use std::error::Error;

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::{Light, Model};
use relievo::gpu::{Gpu, Options};
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{
    Camera, Criterion, DistanceTo, LevelChoice, LevelOfDetail, Pace, Placement, Play, Quality, Scene,
    Transition, View, add_levels,
};
use relievo_lab::plot::strip;
use relievo_samples::creature;

/// Width and height of a picture.
const SIZE: [u32; 2] = [200, 236];

/// Pictures a row.
const STEPS: usize = 5;

/// The middle of the object, which distances are measured to.
const MIDDLE: Vec3 = Vec3::new(0.0, 0.95, 0.0);

/// The band in which the level changes reaches from 90 to 110.
const BAND: Pace = Pace::Band(0.1);

/// Colours by level.
const SHADING: &str = "
fn shade(surface: Surface, view: View) -> vec4<f32> {
    let color = select(vec3<f32>(0.1, 0.35, 0.8), vec3<f32>(0.9, 0.35, 0.05), surface.level <= 5u);
    let light = view.ambient + (1.0 - view.ambient) * max(dot(surface.normal, view.light), 0.0);
    return vec4<f32>(color * light, surface.fade);
}";

const TRANSITIONS: [(&str, Transition); 7] = [
    ("hard", Transition::Hard),
    ("dither", Transition::Dither(BAND)),
    ("cross-fade", Transition::CrossFade(BAND)),
    ("fade in", Transition::FadeIn(BAND)),
    ("two phases", Transition::TwoPhase(BAND)),
    ("geomorph", Transition::Geomorph),
    ("alpha", Transition::Alpha { opaque: 90.0, gone: 110.0 }),
];

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "transitions.png".to_owned());
    let gpu = Gpu::headless(&Options::default())?;
    let mut model = creature()?;
    add_levels(&mut model, &[0], 9)?;
    let (mut pictures, mut captions) = (Vec::new(), Vec::new());
    for (name, transition) in TRANSITIONS {
        for step in 0..STEPS {
            let distance = 91.0 + 18.0 * step as f32 / (STEPS - 1) as f32;
            pictures.push(picture(&gpu, &model, transition, distance)?);
            captions.push(vec![format!("{name} at {distance:.0}")]);
        }
    }
    strip(&pictures, &captions, STEPS)?.save(&path)?;
    println!("{path}");
    Ok(())
}

/// The object at a distance.
fn picture(
    gpu: &Gpu,
    model: &Model,
    transition: Transition,
    distance: f32,
) -> Result<RgbaImage, Box<dyn Error>> {
    let mut scene = Scene::new(gpu)?;
    scene.set_light(Light { ambient: 0.35, ..Light::default() })?;
    let object = scene.add_character(model, 1)?;
    // Level 5 changes into level 6. A geomorph begins at 1.2 times the threshold, and ends at that of the level after.
    let from = match transition {
        Transition::Geomorph => vec![1.0, 2.0, 3.0, 4.0, 5.0, 90.0 / 1.2, 110.0 / 1.2],
        Transition::Alpha { .. } => vec![1.0, 2.0, 3.0, 4.0, 5.0],
        _ => vec![1.0, 2.0, 3.0, 4.0, 5.0, 100.0],
    };
    let to = DistanceTo::Point(MIDDLE);
    let choice = LevelChoice::By(Criterion::Distance { to, from });
    scene.set_level_of_detail(object, &LevelOfDetail { choice, transition, ..Default::default() })?;
    let instance = scene.spawn(object, Placement::at([0.0; 3]))?;
    scene.play(instance, &Play::new("walk"))?;

    let target = Offscreen::new(gpu, SIZE)?;
    let mut renderer = Renderer::new(gpu, target.format())?.with_shading(SHADING, None)?;
    renderer.prepare(&scene)?;
    let mut view: View = scene.view(Quality::default())?;
    let field = 2.0 * (1.05 / distance).atan();
    let eye = MIDDLE + distance * Vec3::new(0.7, 0.25, 1.0).normalize();
    view.set(Camera::looking_at(eye, MIDDLE, field, [0.5 * distance, 2.0 * distance], SIZE))?;
    gpu.try_run("picture", |encoder| -> Result<(), relievo::Error> {
        scene.record(encoder, &mut [&mut view])?;
        let draw = |pass: &mut relievo::wgpu::RenderPass<'_>| {
            renderer.draw(pass, &scene, &view, Layer::Color)?;
            renderer.draw(pass, &scene, &view, Layer::Transparent)
        };
        Ok(target.record(encoder, [0.05, 0.05, 0.06], draw)?)
    })?;
    Ok(target.read(gpu)?)
}
