//! `relievo pose`

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
#[cfg(feature = "gpu")]
use relievo::animation::ClipSet;
use relievo::animation::crowd::{ClipBuffers, Crowd, unpacked};
use relievo::animation::instance::Instance;
use relievo::animation::instance::Wrap;
use relievo::animation::keyframe_cursor::KeyframeCursorPass;
use relievo::animation::local_to_model::reference::local_to_model;
use relievo::animation::local_to_model::{LocalToModelPass, Walk};
use relievo::animation::sample::SamplePass;
use relievo::animation::sample::reference::sample;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::column_major;
use relievo::asset::{Affine, Clip, Model, Transform};
#[cfg(feature = "gpu")]
use relievo::gpu::Gpu;
use relievo::samples::creature;
use relievo::{Error, InputError};
use serde::Serialize;

use crate::Context;
use crate::output::{json, write_file};

/// Writes where every bone of a model is at a moment of a clip, or at rest, as JSON.
///
/// {"clip", "time", "bones": [{"name", "parent", "local": {"translation": [3], "rotation": [4], "scale": [3]},
/// "model": [16]}]}: the joints of every skin, each once, in the file's order; in a file without skins, every node that
/// moves or that meshes follow, and all above these, parents first. "parent" is the place in that list of
/// the nearest joint above, -1 at a root. "local" is the joint's node in its parent node's space (rotation x, y, z,
/// w). "model" is its global transform in the scene, all nodes above it included, column by column. "time" is the
/// time inside the clip. Both are null at rest.
#[derive(Args)]
pub struct Pose {
    /// A .gltf or .glb file, or `builtin`: a creature of 153 bones with the clips walk, idle and wave.
    #[arg(long, value_name = "FILE|builtin")]
    model: PathBuf,
    #[command(flatten)]
    moment: MomentArgs,
    /// What computes; both agree within rounding.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// The file.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// Which moment of which clip.
#[derive(Args)]
pub struct MomentArgs {
    /// The clip: its name, or its number, counted from 0. Without it the model is at rest.
    #[arg(long, value_name = "NAME|INDEX")]
    clip: Option<String>,
    /// Seconds since the clip's start. Default: 0.
    #[arg(long, value_name = "SECONDS", requires = "clip", allow_hyphen_values = true)]
    time: Option<f64>,
    /// What becomes of times outside the clip: it begins again, or its first or last pose stays.
    #[arg(long, value_name = "MODE", default_value = "loop")]
    wrap: WrapName,
}

impl MomentArgs {
    /// The place of the clip among the model's, and the time inside it. At rest, the model gets a clip without keys.
    pub fn find(&self, model: &mut Model, path: &Path) -> Result<(usize, f32), Error> {
        let Some(name) = &self.clip else {
            model.clips.push(Clip::at_rest("rest", &model.skeleton)?);
            return Ok((model.clips.len() - 1, 0.0));
        };
        let clip = find(model, path, name)?;
        let time = self.wrap.wrap().inside(clip.duration(), self.time.unwrap_or(0.0))?;
        Ok((place(model, clip), time))
    }

    /// Whether no clip is asked for.
    pub fn is_rest(&self) -> bool {
        self.clip.is_none()
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Backend {
    #[cfg(feature = "gpu")]
    #[default]
    Gpu,
    #[cfg_attr(not(feature = "gpu"), default)]
    Cpu,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum WrapName {
    Loop,
    Clamp,
}

impl WrapName {
    pub fn wrap(self) -> Wrap {
        match self {
            Self::Loop => Wrap::Loop,
            Self::Clamp => Wrap::Clamp,
        }
    }
}

#[derive(Serialize)]
struct Report<'a> {
    clip: Option<&'a str>,
    time: Option<f32>,
    bones: Vec<BoneReport<'a>>,
}

#[derive(Serialize)]
struct BoneReport<'a> {
    name: &'a str,
    parent: i64,
    local: Transform,
    model: [f32; 16],
}

impl Pose {
    #[cfg_attr(not(feature = "gpu"), allow(unused_variables, reason = "the device is the context's"))]
    pub fn run(&self, context: &Context) -> Result<ExitCode, Error> {
        let mut model = open_bare(&self.model)?;
        let (clip, time) = self.moment.find(&mut model, &self.model)?;
        let clip = &model.clips[clip];
        let (locals, models) = match self.backend {
            #[cfg(feature = "gpu")]
            Backend::Gpu => on_gpu(&context.gpu()?, &model, clip, time)?,
            Backend::Cpu => on_cpu(&model, clip, time),
        };
        check_range(&models)?;
        let moment = (!self.moment.is_rest()).then_some((clip.name(), time));
        write_file(&self.out, &json(&report(&model, moment, &locals, &models))?)?;
        Ok(ExitCode::SUCCESS)
    }
}

pub fn on_cpu(model: &Model, clip: &Clip, time: f32) -> (Vec<Transform>, Vec<Affine>) {
    let locals = sample(clip, time, RotationPath::Slerp);
    let models = local_to_model(&model.skeleton, &locals);
    (locals, models)
}

/// A crowd of one.
#[cfg(feature = "gpu")]
fn on_gpu(gpu: &Gpu, model: &Model, clip: &Clip, time: f32) -> Result<(Vec<Transform>, Vec<Affine>), Error> {
    let set = ClipSet::new(&[clip])?;
    let clips = ClipBuffers::new(gpu, &set)?;
    // The time is inside the clip already, and its end is not its start here.
    let crowd = Crowd::new(gpu, &set, &[Instance::new(0, Wrap::Clamp, time, 0.0)])?;
    let place = KeyframeCursorPass::new(gpu)?.prepare(gpu, &clips, &crowd)?;
    let sample = SamplePass::new(gpu, RotationPath::Slerp)?.prepare(gpu, &clips, &crowd)?;
    let local_to_model = LocalToModelPass::new(gpu, Walk::of(gpu))?.prepare(gpu, &model.skeleton, &crowd)?;
    gpu.run("pose", |encoder| {
        place.record(encoder);
        sample.record(encoder);
        local_to_model.record(encoder);
    })?;
    let locals = crowd.locals.read_blocking(gpu)?.iter().map(unpacked).collect();
    Ok((locals, crowd.model_matrices().read_blocking(gpu)?))
}

/// Refuses transforms that chains of large scales have driven out of range: JSON has no infinity.
fn check_range(models: &[Affine]) -> Result<(), InputError> {
    let is_finite = |model: &Affine| model.iter().flatten().all(|value| value.is_finite());
    match models.iter().position(|model| !is_finite(model)) {
        None => Ok(()),
        Some(bone) => {
            let bound = "must fit f32: translations or scales are too large";
            Err(InputError::new(format!("bones[{bone}].model"), format!("{:?}", models[bone]), bound))
        }
    }
}

fn report<'a>(
    model: &'a Model,
    moment: Option<(&'a str, f32)>,
    locals: &[Transform],
    models: &[Affine],
) -> Report<'a> {
    let skeleton = &model.skeleton;
    let bone = |(joint, parent): (&u32, Option<u32>)| {
        let at = *joint as usize;
        BoneReport {
            name: &skeleton.bones()[at].name,
            parent: parent.map_or(-1, i64::from),
            local: locals[at],
            model: column_major(&models[at]),
        }
    };
    let bones = skeleton.joints().iter().zip(skeleton.joint_parents()).map(bone).collect();
    let (clip, time) = moment.unzip();
    Report { clip, time, bones }
}

/// As [`open`], without materials and images.
pub fn open_bare(path: &Path) -> Result<Model, Error> {
    if path == Path::new("builtin") { Ok(creature()?) } else { Model::from_file_bare(path) }
}

/// A file's model, or the built-in one.
pub fn open(path: &Path) -> Result<Model, Error> {
    if path == Path::new("builtin") { Ok(creature()?) } else { Model::from_file(path) }
}

/// The place of a model's own clip among its clips.
pub fn place(model: &Model, clip: &Clip) -> usize {
    model.clips.iter().position(|other| std::ptr::eq(other, clip)).unwrap_or_default()
}

/// A model's clip; says which file lacks it.
pub fn find<'a>(model: &'a Model, path: &Path, clip: &str) -> Result<&'a Clip, Error> {
    let in_file = |source: InputError| Error::InputFile { path: path.to_owned(), source };
    model.clip(clip).map_err(in_file)
}
