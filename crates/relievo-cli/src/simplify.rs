//! `relievo simplify`: levels of detail of a model as files, with their measured errors; and all reducers beside each other.

mod plot;
mod report;

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args, ValueEnum};
use image::RgbaImage;
use relievo::asset::Model;
use relievo::ops::mesh::Seams;
use relievo::{Error, InputError};
use relievo_lab::files::Staged;
use relievo_lab::measure::reduction::{MeasuredLevel, ReducerComparison, Reduction, Target, reduction};
use relievo_lab::plot::strip;
use relievo_lab::portrait::{Portrait, portraits};
use relievo_lab::reduce::{Normals, Reducer};

use crate::Context;
use crate::arguments::{self, Backend, one_of};
use crate::output::say;
use crate::progress::shown;
use report::{LevelReport, Report};

const NORMALS: [(&str, Normals); 2] = [("carry", Normals::Carry), ("recompute", Normals::Recompute)];

const SEAMS: [(&str, Seams); 2] = [("hold", Seams::Held), ("cross", Seams::AllCrossed)];

/// How each level is drawn.
const PORTRAIT: Portrait =
    Portrait { edge: 384, finer: 2, background: [0.02, 0.025, 0.03], clay: [0.6, 0.3, 0.16] };

/// The most pictures in a row of levels.png.
const COLUMNS: usize = 5;

/// The prefix of models that need no file.
const BUILT_IN: &str = "builtin:";

/// Writes levels of detail of a model, as OBJ or GLB files, with the measured distance of each from the model.
///
/// The model is taken as it stands at rest. All its meshes are reduced together, and every triangle keeps its mesh and its
/// material. `level_0`, `level_1`, … are the levels in the order in which they were asked for: by --triangles, then by
/// --share, then by --error. levels.png shows the model and all levels side by side. report.json has the reducer's
/// seconds and, for each level, its file, triangles, vertices, the root mean square and the largest distance between its
/// surface and the model's (both ways, in the model's units; the largest is at most 1 % too large and never too
/// small), why the reducer stopped, and the SHA-256 of the file. A level that has more triangles than were asked for says
/// what is in the way.
///
/// With --compare, every reducer makes levels of 50, 20, 10 and 2 % of the triangles instead. compare.json, compare.md and
/// compare.png have their errors, times, and sizes on the wire.
///
/// relievo simplify --model builtin:rock --share 0.5 0.1 --out levels
///
/// relievo simplify --model cow.obj --compare --out compared
#[derive(Args)]
#[command(group(ArgGroup::new("what").required(true).multiple(true).args(["triangles", "share", "error", "compare"])))]
pub struct Simplify {
    /// A .glb, .gltf, .obj or .rlv file, or a built-in model: builtin:creature, builtin:rock or builtin:wall.
    #[arg(long, value_name = "FILE|builtin:NAME")]
    model: PathBuf,
    /// Levels of these numbers of triangles, or as few less as the reducer permits.
    #[arg(long, value_name = "N", num_args = 1.., value_delimiter = ',')]
    triangles: Vec<usize>,
    /// Levels of these parts of the model's triangles, above 0 to 1.
    #[arg(long, value_name = "S", num_args = 1.., value_delimiter = ',', allow_negative_numbers = true)]
    share: Vec<f64>,
    /// Levels whose measured largest distance is at most this, in the model's units, with as few triangles as a search finds.
    #[arg(long, value_name = "E", num_args = 1.., value_delimiter = ',', allow_negative_numbers = true)]
    error: Vec<f64>,
    /// What takes triangles away; a wrong name lists all.
    #[arg(long, value_name = "NAME", default_value = "quadric")]
    reducer: Reducer,
    /// The normals of the levels: the model's, with its hard edges, or computed again from the triangles.
    #[arg(long, value_name = "NORMALS", default_value = "carry", value_parser = one_of(NORMALS))]
    normals: Normals,
    /// Whether triangles may collapse across seams of texture coordinates, at the price by which the texture slips. A model
    /// in which each triangle has texture coordinates of its own keeps all triangles otherwise. Seams of normals are always
    /// crossed, and borders between meshes never.
    #[arg(long, value_name = "SEAMS", default_value = "hold", value_parser = one_of(SEAMS))]
    texture_seams: Seams,
    /// The format of the levels. OBJ has a material library and images beside each level.
    #[arg(long, default_value_t, value_enum)]
    format: Format,
    /// The processor that draws levels.png; the results of both agree within rounding.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// Compares all reducers instead of writing levels.
    #[arg(long, conflicts_with_all = ["triangles", "share", "error", "reducer", "format", "texture_seams"])]
    compare: bool,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// The format of levels.
#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Format {
    Obj,
    #[default]
    Glb,
}

impl Simplify {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        // What is wrong with names is reported before the work.
        let mut reducer = self.reducer;
        if self.texture_seams != Seams::Held {
            let Reducer::HalfEdge { seams, .. } = &mut reducer else {
                let name = self.reducer.name();
                let bound = format!("must be hold with the reducer {name}: quadric and melax cross seams");
                return Err(InputError::new("texture-seams", "cross", bound).into());
            };
            *seams = self.texture_seams;
        }
        drop(Staged::new(&self.out)?);
        let model = open(&self.model)?;
        let in_file = |source: InputError| Error::InputFile { path: self.model.clone(), source };
        if model.meshes.iter().all(|mesh| mesh.indices.is_empty()) {
            let bound = "must be at least 1";
            return Err(in_file(InputError::new("triangles", 0, bound)));
        }
        if self.compare {
            return self.write_comparison(&model);
        }
        let gpu = self.backend.gpu(context)?;
        let made = shown(|listener| reduction(&model, &reducer, &self.targets(), self.normals, listener));
        let made = made.map_err(named)?;
        let whole = std::iter::once(&made.whole);
        let models: Vec<&Model> = whole.chain(made.levels.iter().map(|level| &level.reduced.model)).collect();
        let pictures = match &gpu {
            Some(gpu) => portraits(gpu, &models, &PORTRAIT)?,
            None => PORTRAIT.on_host(&models)?,
        };
        self.write(&made, &pictures)
    }

    fn targets(&self) -> Vec<Target> {
        let triangles = self.triangles.iter().map(|count| Target::Triangles(*count));
        let shares = self.share.iter().map(|share| Target::Share(*share));
        triangles.chain(shares).chain(self.error.iter().map(|error| Target::Error(*error))).collect()
    }

    fn write(&self, made: &Reduction, pictures: &[RgbaImage]) -> Result<(), Error> {
        let mut staged = Staged::new(&self.out)?;
        let mut levels = Vec::new();
        for (at, level) in made.levels.iter().enumerate() {
            let files = self.files(&format!("level_{at}"), &level.reduced.model)?;
            let (name, bytes) = &files[0];
            levels.push(LevelReport::new(name, bytes, level));
            for (name, bytes) in &files {
                staged.write(name, bytes)?;
            }
        }
        let captions = captions(made);
        staged.write_png("levels.png", &strip(pictures, &captions, COLUMNS)?)?;
        let model = self.model.to_string_lossy();
        let report = Report { model: &model, reducer: self.reducer.name(), seconds: made.seconds, levels };
        staged.write_json("report.json", &report)?;
        staged.remove_stale(is_ours);
        staged.publish()?;
        report.levels.iter().try_for_each(say)
    }

    /// The files of a level, the first of them the model's.
    fn files(&self, name: &str, model: &Model) -> Result<Vec<(String, Vec<u8>)>, InputError> {
        match self.format {
            Format::Obj => model.to_obj(name),
            Format::Glb => Ok(vec![(format!("{name}.glb"), model.to_glb()?)]),
        }
    }

    fn write_comparison(&self, model: &Model) -> Result<(), Error> {
        let name = self.model.to_string_lossy();
        let comparison = shown(|listener| ReducerComparison::new(&name, model, self.normals, listener))?;
        let table = comparison.table();
        let mut staged = Staged::new(&self.out)?;
        staged.write_json("compare.json", &comparison)?;
        staged.write("compare.md", table.as_bytes())?;
        staged.write_png("compare.png", &plot::plot(&comparison)?)?;
        staged.publish()?;
        say(table.trim_end())
    }
}

/// Opens a file or a built-in model.
fn open(path: &Path) -> Result<Model, Error> {
    match path.to_str().and_then(|text| text.strip_prefix(BUILT_IN)) {
        Some(name) => Ok(relievo_samples::model(name)?),
        None => arguments::open(path),
    }
}

/// An error of a target as one of the argument: `share` for `targets[1].share`.
fn named(error: InputError) -> InputError {
    match error.path.strip_prefix("targets[").and_then(|path| path.split_once("].")) {
        Some((_, field)) => InputError { path: field.to_owned(), ..error },
        None => error,
    }
}

/// The captions of the model and of all levels.
fn captions(made: &Reduction) -> Vec<Vec<String>> {
    let whole: usize = made.whole.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum();
    let level = |(at, level): (usize, &MeasuredLevel)| {
        let [rms, max] = [level.distance.rms(), level.distance.max()];
        vec![
            format!("level {at}"),
            format!("{} triangles", level.reduced.triangles()),
            format!("rms {rms:.3e}, largest {max:.3e}"),
        ]
    };
    let first = vec!["the model".to_owned(), format!("{whole} triangles")];
    std::iter::once(first).chain(made.levels.iter().enumerate().map(level)).collect()
}

/// Whether a file of this name may be a level's of an earlier run: level_3.glb, or level_3_0.png beside level_3.obj.
fn is_ours(name: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let Some((stem, ending)) = name.strip_prefix("level_").and_then(|rest| rest.rsplit_once('.')) else {
        return false;
    };
    match ending {
        "glb" | "obj" | "mtl" => is_number(stem),
        "png" => stem.split_once('_').is_some_and(|(level, image)| is_number(level) && is_number(image)),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_levels_of_earlier_runs_are_ours() {
        assert!(["level_0.glb", "level_12.obj", "level_1.mtl", "level_1_0.png"].into_iter().all(is_ours));
        let others = [
            "level_.glb",
            "level_a.glb",
            "level_1.txt",
            "level_1.png",
            "my_level_1.glb",
            "level_1_.png",
            "levels.png",
        ];
        assert!(!others.into_iter().any(is_ours));
    }

    #[test]
    fn targets_have_the_names_of_arguments() {
        assert_eq!(named(InputError::new("targets[2].share", 2, "no")).path, "share");
        assert_eq!(named(InputError::new("model.triangles.len", 0, "no")).path, "model.triangles.len");
    }
}
