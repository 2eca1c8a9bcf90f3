//! `relievo skin`

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use relievo::asset::Mesh;
use relievo::asset::Model;
use relievo::asset::mesh::COORDINATE_LIMIT;
use relievo::skinning::add_levels;
use relievo::skinning::export::obj;
use relievo::skinning::instance_lod::InstanceLod;
use relievo::skinning::morph::reference::morph;
use relievo::skinning::palette::reference::palette_for;
use relievo::skinning::picture::reference::{Part, Scene};
use relievo::skinning::picture::texture::Surface;
use relievo::skinning::picture::{Light, framing};
use relievo::skinning::poses_of;
use relievo::skinning::skin::reference::skin;
use relievo::skinning::vertex::{Blend, Vertex};
use relievo::surface::linear_image::LinearImage;
use relievo::{Error, InputError};

use crate::Context;
use crate::output::{Staged, say};
use crate::pose::{Backend, MomentArgs, on_cpu, open};
use crate::progress::during;

/// Writes the meshes of a model at a moment of a clip, or at rest: where every vertex is, and a picture.
///
/// mesh.obj: the meshes of all nodes with a skin, an object a primitive, in the order of the nodes. attached.obj, where
/// there are any: those of nodes without one, which follow the node that they hang on. Positions and normals are in the
/// scene's space, with every digit; vertices are in the file's order, and behind them those that are repeated since their
/// corners have different tangents. Points and lines have no faces. skin.png: all of it, lit, in the base colours and
/// textures of its materials; clay where a mesh has none.
#[derive(Args)]
pub struct Skin {
    /// A .gltf or .glb file, or `builtin`: a creature of 153 bones with the clips walk, idle and wave.
    #[arg(long, value_name = "FILE|builtin")]
    model: PathBuf,
    #[command(flatten)]
    moment: MomentArgs,
    /// Which bones a vertex follows: all of its own (up to 8); the K strongest; or all, fading to the strongest alone as
    /// LAMBDA goes from 0 to 1.
    #[arg(long, value_name = "full|truncate:K|fade:LAMBDA", default_value = "full")]
    influences: String,
    /// Blends rigid motions rather than matrices: twisted limbs keep their volume.
    #[arg(long)]
    dual_quaternion: bool,
    /// Leaves triangles out: each mesh is the coarsest of its levels of detail whose surface is never further off than
    /// this, in any pose of the clip or at rest, and says what is left. Vertices stay in the file's order. The clip is
    /// looked at 60 times a second, and lasts an hour at most.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    within: Option<f32>,
    /// What computes and draws; both agree within rounding.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// The folder for mesh.obj, attached.obj and skin.png.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// Edge of the picture.
const EDGE: u32 = 768;

/// Samples along a pixel's edge.
const FINER: u32 = 2;

/// Linear.
const SKY: [f32; 3] = [0.02, 0.025, 0.03];
const CLAY: [f32; 3] = [0.6, 0.3, 0.16];

impl Skin {
    pub fn run(&self, context: &Context) -> Result<ExitCode, Error> {
        let Made { model, vertices, picture } = self.made(context)?;
        let mut staged = Staged::new(&self.out)?;
        let meshes: Vec<_> =
            model.meshes.iter().zip(&vertices).map(|(mesh, vertices)| (mesh, &vertices[..])).collect();
        let (skinned, attached) = meshes.split_at(model.skinned);
        for (name, meshes) in [("mesh.obj", skinned), ("attached.obj", attached)] {
            if !meshes.is_empty() {
                let path = staged.path(name);
                std::fs::write(&path, obj(meshes)).map_err(|error| Error::output(&path, error))?;
            }
        }
        let path = staged.path("skin.png");
        picture.save(&path).map_err(|error| Error::output(&path, error))?;
        staged.publish()?;
        Ok(ExitCode::SUCCESS)
    }

    /// The picture alone, for the demonstration.
    #[cfg(feature = "gpu")]
    pub fn picture(&self, context: &Context) -> Result<image::RgbaImage, Error> {
        Ok(self.made(context)?.picture)
    }

    #[cfg_attr(not(feature = "gpu"), allow(unused_variables, reason = "the device is the context's"))]
    fn made(&self, context: &Context) -> Result<Made, Error> {
        let instance_lod = instance_lod(&self.influences)?;
        let mut model = open(&self.model)?;
        if model.meshes.is_empty() {
            let bound = "must be at least one that is not compressed with Draco";
            return Err(Error::InputFile {
                path: self.model.clone(),
                source: InputError::new("meshes", "none", bound),
            });
        }
        let (clip, time) = self.moment.find(&mut model, &self.model)?;
        if let Some(metres) = self.within {
            coarsen(&mut model, clip, metres)?;
        }
        let blend = if self.dual_quaternion { Blend::DualQuaternion } else { Blend::Linear };
        let moment = Moment { model: &model, clip, time, instance_lod, blend };
        let (vertices, picture) = match self.backend {
            #[cfg(feature = "gpu")]
            Backend::Gpu => device::skinned(&context.gpu()?, &moment)?,
            Backend::Cpu => on_host(&moment)?,
        };
        let picture = picture.reduced(FINER).encoded();
        Ok(Made { model, vertices, picture })
    }
}

/// Gives meshes the triangles of their levels.
fn coarsen(model: &mut Model, clip: usize, metres: f32) -> Result<(), Error> {
    if !(metres >= 0.0 && metres.is_finite()) {
        return Err(InputError::new("within", metres, "must be finite, and not negative").into());
    }
    let poses = poses_of(&model.clips[clip])?;
    during("simplifying", || add_levels(model, &[clip], poses))?;
    for mesh in &mut model.meshes {
        let all = mesh.indices.len() / 3;
        let level = std::mem::take(&mut mesh.levels).into_iter().rfind(|level| level.error <= metres);
        let error = level.as_ref().map_or(0.0, |level| level.error);
        if let Some(level) = level {
            mesh.indices = level.indices;
        }
        let left = mesh.indices.len() / 3;
        say(format_args!("{}: {left} of {all} triangles, {error} metres off", mesh.name))?;
    }
    Ok(())
}

/// What is written.
struct Made {
    model: Model,
    /// Of each mesh.
    vertices: Vec<Vec<Vertex>>,
    picture: image::RgbaImage,
}

/// `full`, `truncate:K` or `fade:LAMBDA`.
fn instance_lod(text: &str) -> Result<InstanceLod, InputError> {
    let refused = || InputError::new("influences", text, "must be full, truncate:K or fade:LAMBDA");
    let named =
        |error: InputError| InputError::new("influences", text, format!("{} {}", error.path, error.bound));
    match text.split_once(':') {
        None if text == "full" => Ok(InstanceLod::FULL),
        Some(("truncate", most)) => {
            InstanceLod::truncate(most.parse().map_err(|_| refused())?).map_err(named)
        }
        Some(("fade", fade)) => InstanceLod::fade(fade.parse().map_err(|_| refused())?).map_err(named),
        _ => Err(refused()),
    }
}

/// A model in a clip, at a time inside it.
struct Moment<'a> {
    model: &'a Model,
    clip: usize,
    time: f32,
    instance_lod: InstanceLod,
    blend: Blend,
}

impl Moment<'_> {
    fn weights(&self, mesh: &Mesh) -> Vec<f32> {
        mesh.weights_at(self.clip, self.time)
    }
}

/// Refuses vertices that large scales have driven out of range.
fn check_range(mesh: usize, vertices: &[Vertex]) -> Result<(), InputError> {
    let is_good = |value: &f32| value.abs() <= COORDINATE_LIMIT;
    match vertices.iter().position(|vertex| !vertex.position.iter().all(is_good)) {
        None => Ok(()),
        Some(at) => {
            let bound = format!("must be within ±{COORDINATE_LIMIT:e}: scales or weights are too large");
            let value = format!("{:?}", vertices[at].position);
            Err(InputError::new(format!("meshes[{mesh}].positions[{at}]"), value, bound))
        }
    }
}

fn on_host(moment: &Moment<'_>) -> Result<(Vec<Vec<Vertex>>, LinearImage), Error> {
    let model = moment.model;
    let (_, models) = on_cpu(model, &model.clips[moment.clip], moment.time);
    let skinned: Vec<Vec<Vertex>> = (model.meshes.iter())
        .map(|mesh| {
            let palette = palette_for(&model.skins[mesh.skin], &models, moment.blend);
            skin(&morph(mesh, &moment.weights(mesh)), &mesh.influences, &palette, moment.instance_lod)
        })
        .collect();
    skinned.iter().enumerate().try_for_each(|(mesh, vertices)| check_range(mesh, vertices))?;
    let scene = Scene {
        clip_from_model: framing(skinned.iter().flatten()),
        light: Light::default(),
        size: [FINER * EDGE; 2],
    };
    let surface = |mesh: &Mesh| {
        let material = model.material(mesh)?;
        Ok(material.map_or(Surface::plain(CLAY), |material| Surface::of(model, material)))
    };
    let surfaces = model.meshes.iter().map(surface).collect::<Result<Vec<_>, InputError>>()?;
    let parts: Vec<_> = (model.meshes.iter().zip(&skinned).zip(&surfaces))
        .map(|((mesh, vertices), surface)| Part { mesh, level: 0, vertices, surface })
        .collect();
    let picture = scene.draw(&parts, SKY);
    Ok((skinned, picture))
}

#[cfg(feature = "gpu")]
mod device {
    use super::*;
    use relievo::animation::ClipSet;
    use relievo::animation::crowd::{ClipBuffers, Crowd};
    use relievo::animation::instance::Instance;
    use relievo::animation::instance::Wrap;
    use relievo::animation::keyframe_cursor::KeyframeCursorPass;
    use relievo::animation::local_to_model::{LocalToModelPass, Walk};
    use relievo::animation::sample::SamplePass;
    use relievo::asset::keyframe::RotationPath;
    use relievo::asset::transform::AFFINE_IDENTITY;
    use relievo::gpu::{Buffer, Gpu};
    use relievo::render::skinned::{SkinnedInstances, SkinnedRenderer, SkinnedScene};
    use relievo::render::target::{LINEAR_FORMAT, Target};
    use relievo::render::{Albedo, ColorTexture};
    use relievo::skinning::frame::SkinFrame;
    use relievo::surface::mips::Mips;

    /// A crowd of one.
    pub fn skinned(gpu: &Gpu, moment: &Moment<'_>) -> Result<(Vec<Vec<Vertex>>, LinearImage), Error> {
        let crowd = posed(gpu, moment)?;
        let (mut all, mut scenes) = (Vec::new(), Vec::new());
        let clay = ColorTexture::linear(gpu, &clay(), true)?.into();
        let albedos = Albedo::of_meshes(gpu, moment.model, &clay, ColorTexture::linear)?;
        for (index, albedo) in albedos.iter().enumerate() {
            let (vertices, scene) = skinned_mesh(gpu, moment, index, &crowd, albedo)?;
            check_range(index, &vertices)?;
            all.push(vertices);
            scenes.push(scene);
        }
        let clip_from_model = framing(all.iter().flatten());
        scenes.iter_mut().try_for_each(|scene| scene.set_camera(gpu, clip_from_model))?;
        let size = [FINER * EDGE; 2];
        let target = Target::linear(gpu, size)?;
        target.draw(gpu, SKY.map(f64::from), |pass| scenes.iter().for_each(|scene| scene.draw(pass)))?;
        Ok((all, LinearImage { size, pixels: target.read_linear(gpu)? }))
    }

    fn posed(gpu: &Gpu, moment: &Moment<'_>) -> Result<Crowd, Error> {
        let set = ClipSet::new(&[&moment.model.clips[moment.clip]])?;
        let clips = ClipBuffers::new(gpu, &set)?;
        // The time is inside the clip already, and its end is not its start here.
        let crowd = Crowd::new(gpu, &set, &[Instance::new(0, Wrap::Clamp, moment.time, 0.0)])?;
        let place = KeyframeCursorPass::new(gpu)?.prepare(gpu, &clips, &crowd)?;
        let sample = SamplePass::new(gpu, RotationPath::Slerp)?.prepare(gpu, &clips, &crowd)?;
        let local_to_model =
            LocalToModelPass::new(gpu, Walk::of(gpu))?.prepare(gpu, &moment.model.skeleton, &crowd)?;
        gpu.run("pose", |encoder| {
            place.record(encoder);
            sample.record(encoder);
            local_to_model.record(encoder);
        })?;
        Ok(crowd)
    }

    fn skinned_mesh(
        gpu: &Gpu,
        moment: &Moment<'_>,
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

    fn clay() -> Mips {
        let [r, g, b] = CLAY.map(relievo::srgb::byte);
        Mips::of_color(image::RgbaImage::from_pixel(1, 1, image::Rgba([r, g, b, 255])))
    }
}
