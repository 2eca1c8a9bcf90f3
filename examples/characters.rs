//! Several characters in one picture: the built-in creature, and every `.glb` or `.gltf` given as an argument. Each plays its
//! first clip, and is as coarse as half a pixel permits. Writes `characters.png`.
//!
//! `cargo run --release --example characters -- [FILE …]`

use glam::Vec3;
use relievo::asset::Model;
use relievo::gpu::{Gpu, Options};
use relievo::ops::skinning::poses_of;
use relievo::render::{Layer, Offscreen, Renderer, TargetFormat};
use relievo::scene::{BoundingSphere, Camera, Placement, Play, Quality, Scene, add_levels};
use relievo_samples::creature;

/// Number of instances of each character.
const COUNT: usize = 40;

/// Size of the picture in pixels.
const SIZE: [u32; 2] = [960, 540];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // In your program: `Gpu::from_wgpu(device, queue)`.
    let gpu = Gpu::headless(&Options::default())?;
    let mut models = vec![creature()?];
    for path in std::env::args().skip(1) {
        models.push(Model::from_file(path.as_ref())?);
    }

    // At load time: coarser meshes for the clip that is played, and everything that frames need.
    let mut scene = Scene::new(&gpu)?;
    let characters = models.len();
    for (index, model) in models.iter_mut().enumerate() {
        let clip = model.clips.first().ok_or("a character needs a clip")?;
        let (duration, poses) = (f64::from(clip.duration()), poses_of(clip)?);
        add_levels(model, &[0], poses)?;
        let character = scene.add_character(model, COUNT)?;
        for at in 0..COUNT {
            let instance = scene.spawn(character, place(model, at, [index, characters]))?;
            let start = -duration * (0.618 * at as f64).fract();
            scene.play(instance, &Play { start, ..Play::new("0") })?;
        }
    }
    let target = Offscreen::with_format(&gpu, SIZE, TargetFormat::srgb().with_samples(4))?; // In your program: any targets.
    let mut renderer = Renderer::new(&gpu, target.format())?;
    renderer.prepare(&scene)?;
    let mut view = scene.view(Quality::pixels(0.5))?;

    // A frame.
    let (eye, ahead) = (Vec3::new(0.0, 4.0, 8.0), Vec3::new(0.0, 0.5, -6.0));
    view.set(Camera::looking_at(eye, ahead, 0.8, [0.1, 200.0], SIZE))?;
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [&mut view])?;
    target
        .record(&mut encoder, [0.02, 0.025, 0.03], |pass| renderer.draw(pass, &scene, &view, Layer::Color))?;
    gpu.queue().submit([encoder.finish()]);

    target.read(&gpu)?.save("characters.png")?;
    Ok(())
}

/// Places instances in rows away from the eye, each turned in its own direction, every character three metres large.
fn place(model: &Model, at: usize, [index, characters]: [usize; 2]) -> Placement {
    let BoundingSphere { center, radius } = BoundingSphere::in_clips(model);
    let scale = 1.5 / radius.max(f32::MIN_POSITIVE);
    let (row, column) = (at / 8, (at % 8 * characters + index) as f32);
    let x = 2.6 * (column - 4.0 * characters as f32 + 0.5) / characters as f32;
    let place = Vec3::new(x, 1.0 - scale * center.y, -3.0 * row as f32 - index as f32);
    Placement::at(place).turned(0.7 * at as f32).scaled(scale)
}
