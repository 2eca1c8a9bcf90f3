//! `relievo skin`: a model's vertices at one time of a clip, as files and as a picture.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use image::RgbaImage;
use relievo::asset::Model;
use relievo::ops::skinning::export::{ObjMesh, write_obj};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::vertex::{Blend, Vertex};
use relievo::{Error, InputError};
use relievo_lab::files::Staged;
use relievo_lab::portrait::{Portrait, PosedModel, portrait};

use crate::Context;
use crate::arguments::{Backend, ModelArgs};
use crate::coarsen::coarsen;
use crate::collapse::CollapseArgs;
use crate::demo::Shown;
use crate::output::say;
use crate::pose::MomentArgs;
use crate::progress::during;

/// Writes the meshes of a model at one time of a clip, or at rest: the positions of all vertices, and a picture.
///
/// mesh.obj has the meshes of all nodes with a skin, one object per primitive, in the order of the nodes.
/// attached.obj, which is written only if there are any, has the meshes of nodes without a skin, which follow the
/// node that they are attached to. Positions and normals are in the scene's space, with all digits. Vertices are in
/// the file's order; after them come the vertices that are duplicated because the triangles around them have
/// different tangents. Points and lines have no faces. skin.png shows all meshes, lit, with the base colours and
/// textures of their materials; a mesh without a material is clay.
///
/// relievo skin --model fox.glb --clip Run --time 0.3 --out fox
///
/// relievo skin --model house.glb --out house
#[derive(Args)]
pub struct Skin {
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    moment: MomentArgs,
    #[command(flatten)]
    collapse: CollapseArgs,
    /// The influences that each vertex follows: all of its own (up to 8); the K strongest; or all, fading to
    /// the strongest alone as LAMBDA goes from 0 to 1.
    #[arg(long, value_name = "full|truncate:K|fade:LAMBDA", default_value = "full", value_parser = instance_lod)]
    influences: InstanceLod,
    /// Blends dual quaternions instead of matrices: twisted limbs keep their volume.
    #[arg(long)]
    dual_quaternion: bool,
    /// Reduces triangles: draws each mesh at the coarsest of its levels of detail whose surface is never
    /// further off than this, in the model's units, in any pose of the clip or at rest; and prints how many
    /// triangles are left. Vertices stay in the file's order. The clip is sampled 60 times a second, and may
    /// last an hour at most.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    within: Option<f32>,
    /// The processor that computes and draws; the results of both agree within rounding.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// The folder for mesh.obj, attached.obj and skin.png.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// How skin.png is drawn.
const PORTRAIT: Portrait =
    Portrait { edge: 768, finer: 2, background: [0.02, 0.025, 0.03], clay: [0.6, 0.3, 0.16] };

/// The output of the command.
struct Made {
    model: Model,
    /// The vertices of each mesh.
    vertices: Vec<Vec<Vertex>>,
    picture: RgbaImage,
    /// What became of each mesh that was coarsened.
    notes: Vec<String>,
}

impl Skin {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let Made { model, vertices, picture, notes } = self.made(context)?;
        let mut staged = Staged::new(&self.out)?;
        let meshes: Vec<_> =
            model.meshes.iter().zip(&vertices).map(|(mesh, vertices)| ObjMesh { mesh, vertices }).collect();
        let (skinned, attached) = meshes.split_at(model.skinned);
        for (name, meshes) in [("mesh.obj", skinned), ("attached.obj", attached)] {
            if !meshes.is_empty() {
                let mut text = Vec::new();
                write_obj(&mut text, meshes).map_err(|error| Error::output(name, error))?;
                staged.write(name, &text)?;
            }
        }
        staged.write_png("skin.png", &picture)?;
        staged.publish()?;
        notes.into_iter().try_for_each(say)
    }

    /// The picture only, for `relievo demo`; writes no files.
    pub fn shown(&self, context: &Context, start: Instant) -> Result<Shown, Error> {
        let picture = self.made(context)?.picture;
        let seconds = start.elapsed().as_secs_f64();
        Ok(Shown::new(picture, format!("{seconds:.3} s (first use compiles the kernels)")))
    }

    fn made(&self, context: &Context) -> Result<Made, Error> {
        let mut model = self.model.open()?;
        if model.meshes.is_empty() {
            return Err(self.model.refused(InputError::new("meshes.len", 0, "must be at least 1")));
        }
        model = self.collapse.apply(model)?;
        let (clip, time) = self.moment.find(&mut model, &self.model)?;
        let mut notes = Vec::new();
        if let Some(metres) = self.within {
            let coarsened = during("simplifying", || coarsen(&mut model, clip, metres))?;
            notes.extend(model.meshes.iter().zip(coarsened).map(|(mesh, found)| {
                let (left, all, error) = (found.triangles, found.of, found.error);
                format!("{}: {left} of {all} triangles, {error} metres off", mesh.name)
            }));
        }
        let blend = if self.dual_quaternion { Blend::DualQuaternion } else { Blend::Linear };
        let moment = PosedModel { model: &model, clip, time, instance_lod: self.influences, blend };
        let (vertices, picture) = match self.backend.gpu(context)? {
            None => moment.on_host(&PORTRAIT)?,
            Some(gpu) => {
                let vertices = moment.on_device(&gpu)?;
                let picture = portrait(&gpu, &model, &vertices, &PORTRAIT)?;
                (vertices, picture)
            }
        };
        Ok(Made { model, vertices, picture, notes })
    }
}

/// Parses `full`, `truncate:K` or `fade:LAMBDA`.
fn instance_lod(text: &str) -> Result<InstanceLod, InputError> {
    let refused = |bound: &str| InputError::new("influences", text, bound);
    let odd = || refused("must be full, truncate:K or fade:LAMBDA");
    let made = match text.split_once(':') {
        None if text == "full" => Ok(InstanceLod::FULL),
        Some(("truncate", most)) => InstanceLod::truncate(most.parse().map_err(|_| odd())?),
        Some(("fade", fade)) => InstanceLod::fade(fade.parse().map_err(|_| odd())?),
        _ => return Err(odd()),
    };
    made.map_err(|error| refused(&format!("{} {}", error.path, error.bound)))
}
