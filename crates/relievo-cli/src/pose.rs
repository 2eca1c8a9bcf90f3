//! `relievo pose`: the transforms of every bone at one time of a clip, as JSON.

use std::path::PathBuf;

use clap::Args;
use relievo::Error;
use relievo::asset::transform::column_major;
use relievo::asset::{Clip, Model, Transform};
use relievo::ops::animation::{self, Wrap};
use relievo_lab::files::write_json;
use serde::Serialize;

use crate::Context;
use crate::arguments::{Backend, ModelArgs, one_of};
use crate::collapse::CollapseArgs;

/// The names of `--wrap`: how times outside a clip are taken into it.
pub const WRAPS: [(&str, Wrap); 2] = [("loop", Wrap::Loop), ("clamp", Wrap::Clamp)];

/// Writes the transform of every bone of a model at one time of a clip, or at rest, as JSON.
///
/// {"clip", "time", "bones": [{"name", "parent", "local": {"translation": [3], "rotation": [4], "scale": [3]},
/// "model": [16]}]}. The bones are the joints of every skin, each once, in the file's order. In a file without
/// skins they are every node that moves or that meshes follow, and all nodes above these, parents first. "parent"
/// is the index in this list of the nearest joint above, or -1 at a root. "local" is the transform of the joint's
/// node in its parent node's space, with the rotation as a quaternion x, y, z, w. "model" is its global transform
/// in the scene, including all nodes above it, as a 4 × 4 matrix, column by column. "time" is the time inside the
/// clip in seconds. "clip" and "time" are null at rest.
///
/// relievo pose --model builtin --clip walk --time 0.3 --out pose.json
#[derive(Args)]
pub struct Pose {
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    moment: MomentArgs,
    #[command(flatten)]
    collapse: CollapseArgs,
    /// The processor that computes; the results of both agree within rounding.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// The JSON file to write.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

/// The arguments that choose a clip and a time in it.
#[derive(Args)]
pub struct MomentArgs {
    /// The clip: its name, or its number, counted from 0. Without it the model is at rest.
    #[arg(long, value_name = "NAME|INDEX")]
    clip: Option<String>,
    /// Time in seconds since the clip's start. Default: 0.
    #[arg(long, value_name = "SECONDS", requires = "clip", allow_hyphen_values = true)]
    time: Option<f64>,
    /// What happens at times outside the clip: it repeats (loop), or its first or last pose holds (clamp).
    #[arg(long, value_name = "MODE", default_value = "loop", value_parser = one_of(WRAPS))]
    wrap: Wrap,
}

impl MomentArgs {
    /// The index of the clip among the model's, and the time inside it in seconds. For the rest pose, this
    /// adds a clip without keys to the model.
    pub fn find(&self, model: &mut Model, given: &ModelArgs) -> Result<(usize, f32), Error> {
        let Some(name) = &self.clip else {
            model.clips.push(Clip::at_rest("rest", &model.skeleton)?);
            return Ok((model.clips.len() - 1, 0.0));
        };
        let clip = given.clip(model, name)?;
        Ok((clip, self.wrap.inside(model.clips[clip].duration(), self.time.unwrap_or(0.0))?))
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
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let mut model = self.collapse.apply(self.model.open_bare()?)?;
        let (clip, time) = self.moment.find(&mut model, &self.model)?;
        let (skeleton, clip) = (&model.skeleton, &model.clips[clip]);
        let pose = match self.backend.gpu(context)? {
            Some(gpu) => relievo_lab::portrait::pose(&gpu, skeleton, clip, time)?,
            None => animation::Pose::on_host(skeleton, clip, time),
        };
        pose.check_range()?;
        let bone = |(joint, parent): (&u32, Option<u32>)| {
            let at = *joint as usize;
            BoneReport {
                name: &skeleton.bones()[at].name,
                parent: parent.map_or(-1, i64::from),
                local: pose.locals[at],
                model: column_major(&pose.model_matrices[at]),
            }
        };
        let bones = skeleton.joints().iter().zip(skeleton.joint_parents()).map(bone).collect();
        let (clip, time) = self.moment.clip.is_some().then_some((clip.name(), time)).unzip();
        write_json(&self.out, &Report { clip, time, bones })
    }
}
