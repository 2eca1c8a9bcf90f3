//! Computes the vertices of a whole model at one time of a clip on the device, and draws a picture of them,
//! for the command line.

use image::{Rgba, RgbaImage};

use super::skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
use super::target::{LINEAR_FORMAT, Target};
use super::{Albedo, ColorTexture};
use crate::animation::crowd::Crowd;
use crate::animation::pose::posed;
use crate::asset::Light;
use crate::asset::transform::AFFINE_IDENTITY;
use crate::gpu::{Buffer, Gpu};
use crate::skinning::frame::SkinFrame;
use crate::skinning::picture::framing;
use crate::skinning::posed::{Portrait, PosedModel, check_range};
use crate::skinning::vertex::Vertex;
use crate::surface::linear_image::LinearImage;
use crate::surface::mips::Mips;
use crate::{Error, srgb};

/// Computes the same as [`PosedModel::on_host`] on the device; the results are equal within rounding. Waits
/// for the device.
///
/// # Errors
/// [`crate::InputError`] for vertices outside the range of `f32`, as large scales produce, and for a material
/// or an image that the model lacks; [`crate::gpu::GpuError`] for errors of the device.
pub fn on_device(
    gpu: &Gpu,
    moment: &PosedModel<'_>,
    portrait: &Portrait,
) -> Result<(Vec<Vec<Vertex>>, RgbaImage), Error> {
    let model = moment.model;
    let crowd = posed(gpu, &model.skeleton, &model.clips[moment.clip], moment.time)?;
    let (mut all, mut scenes) = (Vec::new(), Vec::new());
    let [r, g, b] = portrait.clay.map(srgb::byte);
    let clay = Mips::of_color(RgbaImage::from_pixel(1, 1, Rgba([r, g, b, 255])));
    let clay = ColorTexture::linear(gpu, &clay, true)?.into();
    let albedos = Albedo::of_meshes(gpu, model, &clay, ColorTexture::linear)?;
    for (index, albedo) in albedos.iter().enumerate() {
        let (vertices, scene) = skinned_mesh(gpu, moment, index, &crowd, albedo)?;
        check_range(index, &vertices)?;
        all.push(vertices);
        scenes.push(scene);
    }
    let clip_from_model = framing(all.iter().flatten());
    scenes.iter_mut().try_for_each(|scene| scene.set_camera(gpu, clip_from_model))?;
    let size = [portrait.finer * portrait.edge; 2];
    let target = Target::linear(gpu, size)?;
    let background = portrait.background.map(f64::from);
    target.draw(gpu, background, |pass| scenes.iter().for_each(|scene| scene.draw(pass)))?;
    let picture = LinearImage { size, pixels: target.read_linear(gpu)? };
    Ok((all, picture.reduced(portrait.finer).encoded()))
}

fn skinned_mesh(
    gpu: &Gpu,
    moment: &PosedModel<'_>,
    mesh: usize,
    posed: &Crowd,
    albedo: &Albedo,
) -> Result<(Vec<Vertex>, SkinnedScene), Error> {
    let frame = SkinFrame::new(gpu, moment.model, mesh, posed.model_matrices(), 1, moment.blend)?;
    frame.crowd.instance_lods.write(gpu, &[moment.instance_lod])?;
    frame.crowd.weights.write(gpu, &moment.weights(&moment.model.meshes[mesh]))?;
    gpu.run("skin", |encoder| frame.record_all(encoder))?;
    let instances = SkinnedInstances {
        mesh: &frame.mesh,
        skinned: &frame.skinned,
        placements: &Buffer::from_slice(gpu, "placements", &[AFFINE_IDENTITY])?,
        drawn: &Buffer::from_slice(gpu, "drawn", &[0])?,
        albedo,
        light: Light::default(),
    };
    let scene = SkinnedRenderer::new(gpu, LINEAR_FORMAT)?.scene(gpu, &instances)?;
    Ok((frame.read(gpu, 0)?, scene))
}
