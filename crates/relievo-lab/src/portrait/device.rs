//! Square pictures of a model as it stands, drawn by a scene.

use glam::Mat4;
use image::RgbaImage;
use relievo::asset::material::{Alpha, Material, Texture};
use relievo::asset::{Mesh, Model};
use relievo::gpu::Gpu;
use relievo::ops::skinning::{Vertex, still};
use relievo::render::Offscreen;
use relievo::scene::{Camera, Depth, Placement, Scene};
use relievo::{Error, InputError};

use super::Portrait;
use super::picture::{framing_camera, framing_of};

/// Draws the meshes of a model, with these vertices of each, in the middle of a picture: a scene of static meshes in full
/// detail under the default light. [`PosedModel::on_host`](super::PosedModel::on_host) draws the same without a
/// device, within rounding. Waits for the device.
///
/// # Errors
/// [`InputError`] for another number of meshes or vertices than the model has, for vertices outside the range of coordinates,
/// for a material or an image that the model lacks, and for a picture without a pixel or a sample;
/// [`relievo::gpu::GpuError`].
pub fn portrait(
    gpu: &Gpu,
    model: &Model,
    vertices: &[Vec<Vertex>],
    portrait: &Portrait,
) -> Result<RgbaImage, Error> {
    drawn(gpu, &still(model, vertices)?, framing_camera(vertices.iter().flatten()), portrait)
}

/// Draws models that stand still, such as those of [`still`] and [`at_rest`](relievo::ops::skinning::at_rest()), as [`portrait`] does,
/// a picture each. One camera sees all of them, with the first in the middle. Waits for the device.
///
/// # Errors
/// As [`portrait`].
pub fn portraits(gpu: &Gpu, models: &[&Model], portrait: &Portrait) -> Result<Vec<RgbaImage>, Error> {
    let camera = framing_of(models);
    models.iter().map(|model| drawn(gpu, model, camera, portrait)).collect()
}

/// Draws a model that stands still, seen by a camera: the matrices from the world to its space, and from there to the picture.
fn drawn(
    gpu: &Gpu,
    standing: &Model,
    [view_from_cell, clip_from_view]: [Mat4; 2],
    portrait: &Portrait,
) -> Result<RgbaImage, Error> {
    for (path, number) in [("portrait.edge", portrait.edge), ("portrait.finer", portrait.finer)] {
        if number == 0 {
            return Err(InputError::new(path, number, "must be at least 1").into());
        }
    }
    let size = [portrait.finer.saturating_mul(portrait.edge); 2];
    let target = Offscreen::linear(gpu, size)?;
    let mut scene = Scene::new(gpu)?;
    // Each mesh is an object, so that no texture shares its size with another.
    for mesh in standing.meshes.iter().filter(|mesh| !mesh.indices.is_empty()) {
        let object = scene.add_mesh(&alone(standing, mesh, portrait)?, 1)?;
        scene.spawn(object, Placement::default())?;
    }
    let depth = Depth::Forward;
    let camera = Camera { cell: [0; 3], view_from_cell, clip_from_view, viewport: size, depth };
    target.draw(&mut scene, camera, portrait.background)?;
    Ok(target.read_linear(gpu)?.reduced(portrait.finer).encoded())
}

/// The model of one mesh. Its material has no normal map, as on the host, and what is blended is dithered, since the picture
/// has one layer. A mesh without a material is clay.
fn alone(model: &Model, mesh: &Mesh, portrait: &Portrait) -> Result<Model, InputError> {
    let [r, g, b] = portrait.clay;
    let clay = || Material::opaque("clay", [r, g, b, 1.0]);
    let mut material = model.material(mesh)?.cloned().unwrap_or_else(clay);
    let mut images = Vec::new();
    if let Some(texture) = &mut material.texture {
        images.push(model.images[texture.image].clone());
        *texture = Texture { image: 0, ..*texture };
    }
    material.normal = None;
    material.pbr = Default::default();
    if material.alpha == Alpha::Blended {
        material.alpha = Alpha::Dithered;
    }
    Ok(Model {
        skeleton: model.skeleton.clone(),
        skins: model.skins.clone(),
        clips: Vec::new(),
        motion: None,
        meshes: vec![Mesh { material: Some(0), ..mesh.clone() }],
        skinned: 0,
        materials: vec![material],
        images,
    })
}
