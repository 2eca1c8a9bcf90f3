//! Several characters in one picture: the built-in creature, and every `.glb` or `.gltf` given as an argument.
//! Each plays its first clip. The device poses, culls, fades, skins and draws the instances, with as few
//! influences and triangles as possible while no vertex is more than half a pixel off. Writes `characters.png`.
//!
//! The half pixel is the sum of two quarters. One is for the fade of influences, and bounds the error of every
//! drawn vertex. The other is for fewer triangles, and bounds the distance from every vertex of a mesh to the
//! drawn surface. Both compare with the same pose under all influences and triangles, in the clip that is
//! played, sampled 60 times a second. Normals and textures do not count; points between vertices may be further
//! off ([`relievo::skinning::MeshLevels::new`] says how far).
//!
//! `cargo run --release --example characters -- [FILE …]`

use glam::{Vec3, camera};
use image::{Rgba, RgbaImage};
use relievo::animation::crowd::{ClipBuffers, Crowd};
use relievo::animation::instance::Instance;
use relievo::animation::instance::Wrap;
use relievo::animation::keyframe_cursor::KeyframeCursorPass;
use relievo::animation::local_to_model::LocalToModelPass;
use relievo::animation::sample::SamplePass;
use relievo::animation::{ClipSet, Projection};
use relievo::asset::Light;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::{Affine, Model};
use relievo::gpu::{Buffer, Gpu, Options};
use relievo::render::target::{COLOR_FORMAT, Target};
use relievo::render::{Albedo, Character, ColorTexture, CrowdScene};
use relievo::samples::creature;
use relievo::skinning::bounding_sphere::BoundingSphere;
use relievo::skinning::lod::placed;
use relievo::skinning::vertex::Blend;
use relievo::skinning::{Extent, FadeRange, add_levels, level_errors, poses_of};
use relievo::surface::mips::Mips;

/// Number of instances of each character.
const COUNT: usize = 40;

/// Size of the picture in pixels.
const SIZE: [u32; 2] = [960, 540];

/// Vertical field of view in radians.
const FIELD_OF_VIEW: f32 = 0.8;

/// The error in pixels permitted for the fade of influences, and again for fewer triangles.
const PIXELS: f32 = 0.25;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // In your program: `Gpu::from_wgpu(device, queue)`.
    let gpu = Gpu::headless(&Options::default())?;
    let mut models = vec![creature()?];
    for path in std::env::args().skip(1) {
        models.push(Model::from_file(path.as_ref())?);
    }

    // At load time: pipelines and bind groups. Meshes without a material are drawn as clay.
    let clay = Mips::of_color(RgbaImage::from_pixel(1, 1, Rgba([200, 140, 98, 255])));
    let clay: Albedo = ColorTexture::new(&gpu, &clay, true)?.into();
    let mut crowd = CrowdScene::new(&gpu, COLOR_FORMAT, Light::default())?;
    let mut animations = Vec::new();
    let characters = models.len();
    for (index, model) in models.iter_mut().enumerate() {
        let clip = model.clips.first().ok_or("a character needs a clip")?;
        let poses = poses_of(clip)?;
        add_levels(model, &[0], poses)?;
        let (model, clip) = (&*model, &model.clips[0]);
        let (fade_range, levels) = ranges(model, poses)?;
        let (set, duration) = (ClipSet::new(&[clip])?, clip.duration());
        let play = |at: usize| Instance::new(0, Wrap::Loop, duration * (0.618 * at as f32).fract(), 1.0);
        let posed = Crowd::new(&gpu, &set, &(0..COUNT).map(play).collect::<Vec<_>>())?;
        let clips = ClipBuffers::new(&gpu, &set)?;
        let place = KeyframeCursorPass::new(&gpu)?.prepare(&gpu, &clips, &posed)?;
        let sample = SamplePass::new(&gpu, RotationPath::Slerp)?.prepare(&gpu, &clips, &posed)?;
        let local_to_model = LocalToModelPass::new(&gpu)?.prepare(&gpu, &model.skeleton, &posed)?;
        let placements = Buffer::from_slice(&gpu, "placements", &places(model, index, characters))?;
        let albedos = Albedo::of_meshes(&gpu, model, &clay, ColorTexture::new)?;
        crowd.add(
            &gpu,
            &Character {
                model,
                matrices: posed.model_matrices(),
                placements: &placements,
                fade_range,
                levels: &levels,
                blend: Blend::Linear,
                albedos: &albedos,
            },
        )?;
        animations.push((place, sample, local_to_model));
    }

    // A frame.
    let eye = Vec3::new(0.0, 4.0, 8.0);
    let view = camera::rh::view::look_at_mat4(eye, Vec3::new(0.0, 0.5, -6.0), Vec3::Y);
    let projection =
        camera::rh::proj::directx::perspective(FIELD_OF_VIEW, SIZE[0] as f32 / SIZE[1] as f32, 0.1, 200.0);
    crowd.set_camera(&gpu, projection * view, eye)?;
    let target = Target::new(&gpu, SIZE)?;
    let mut encoder = gpu.encoder("frame");
    for (place, sample, local_to_model) in &animations {
        place.record(&mut encoder);
        sample.record(&mut encoder);
        local_to_model.record(&mut encoder);
    }
    crowd.record(&mut encoder);
    // In your program: any render pass with a depth buffer.
    target.record(&mut encoder, [0.02, 0.025, 0.03], |pass| crowd.draw(pass));
    gpu.queue().submit([encoder.finish()]);

    target.read(&gpu)?.save("characters.png")?;
    Ok(())
}

/// The distances between which a model fades, and those at which each of its levels of detail begins.
fn ranges(model: &Model, poses: usize) -> Result<(FadeRange, Vec<f32>), relievo::InputError> {
    let scale = scale(BoundingSphere::in_clips(model).radius);
    let extent = Extent::of_model(model, &[0], poses)?.scaled(scale);
    let projection = Projection::new(SIZE[1], FIELD_OF_VIEW, 0.1);
    let errors = level_errors(&model.meshes).into_iter().map(|error| scale * error);
    Ok((extent.fade_range(&projection, PIXELS), extent.level_ranges(&projection, PIXELS, errors)))
}

/// The scale at which a sphere has a diameter of three metres.
fn scale(radius: f32) -> f32 {
    1.5 / radius.max(f32::MIN_POSITIVE)
}

/// Placements in rows away from the eye, every character scaled to one size, each turned in its own direction.
fn places(model: &Model, index: usize, characters: usize) -> Vec<Affine> {
    let BoundingSphere { center, radius } = BoundingSphere::in_clips(model);
    let scale = scale(radius);
    let place = |at: usize| {
        let (row, column) = (at / 8, (at % 8 * characters + index) as f32);
        let x = (column - 4.0 * characters as f32 + 0.5) * 2.0 / characters as f32;
        let at_ground = Vec3::new(x * 1.3, -scale * center.y + 1.0, -3.0 * row as f32 - index as f32);
        placed(at_ground, 0.7 * at as f32, scale)
    };
    (0..COUNT).map(place).collect()
}
