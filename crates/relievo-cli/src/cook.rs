//! `relievo cook`: a model with its levels of detail, as a package.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::Args;
use relievo::Error;
use relievo::asset::ModelFile;
use relievo::asset::package::{PackageHeader, PackageLevel};
use relievo::ops::skinning::cook;
use relievo_lab::files::{Staged, write_file, write_json};
use serde::Serialize;

use crate::output::say;
use crate::progress::bar;

/// The prefix of models that need no file.
const BUILT_IN: &str = "builtin:";

/// Steps of the progress bar.
const STEPS: f32 = 1000.0;

/// Writes a model with its levels of detail as a package (.rlv), so that it is simplified only once.
///
/// Every command and every scene file reads a package like any other model, in milliseconds. The package has the model's
/// meshes, skins, skeleton, clips, materials and images. Its levels of detail fit all clips and the rest pose. They lie in
/// the file from the coarsest to the finest: a program that has only the beginning of the file can draw a coarse level.
///
/// Positions, normals, texture coordinates and weights are quantized. The largest distance by which that moves a vertex is
/// measured, and added to the error of every level. A package is written again as it is.
///
/// One line a level is printed: triangles, vertices, error in the model's units, and bytes to the end of the level.
///
/// relievo cook cow.obj --out cow.rlv
///
/// relievo cook builtin:creature --out creature.rlv --json creature.json
#[derive(Args)]
pub struct Cook {
    /// A .glb, .gltf, .obj or .rlv file, or a built-in model: builtin:creature, builtin:rock or builtin:wall.
    #[arg(value_name = "FILE|builtin:NAME")]
    model: PathBuf,
    /// The package to write. The file appears complete, or not at all.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Also writes a report to this file.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

#[derive(Serialize)]
struct Report<'a> {
    model: &'a str,
    seconds: f64,
    bytes: usize,
    quantization: f32,
    model_bytes: usize,
    image_bytes: usize,
    levels: Vec<LevelReport>,
}

#[derive(Serialize)]
struct LevelReport {
    triangles: usize,
    vertices: usize,
    error: f32,
    bytes: usize,
    end: usize,
    hash: String,
}

impl From<&PackageLevel> for LevelReport {
    fn from(level: &PackageLevel) -> Self {
        let PackageLevel { triangles, vertices, error, ref chunk, ref hash } = *level;
        Self {
            triangles,
            vertices,
            error,
            bytes: chunk.end - chunk.start,
            end: chunk.end,
            hash: hash.clone(),
        }
    }
}

impl Cook {
    pub fn run(&self) -> Result<(), Error> {
        // What is wrong with names is reported before the work.
        let folder =
            self.out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        drop(Staged::new(folder)?);
        let file = open(&self.model)?;
        let begun = std::time::Instant::now();
        let bar = bar(STEPS as u64, "levels of detail");
        let made = cook(&file, &mut |fraction| {
            bar.set_position((STEPS * fraction) as u64);
            ControlFlow::Continue(())
        });
        bar.finish_and_clear();
        let in_file = |source| Error::InputFile { path: self.model.clone(), source };
        // The work is never broken off.
        let bytes = made.map_err(in_file)?.unwrap_or_default();
        let seconds = begun.elapsed().as_secs_f64();
        let (header, _) = PackageHeader::read(&bytes)?;
        write_file(&self.out, &bytes)?;
        let sum = |chunks: &[relievo::asset::package::PackageChunk]| {
            chunks.iter().map(|chunk| chunk.end - chunk.start).sum()
        };
        let report = Report {
            model: &self.model.to_string_lossy(),
            seconds,
            bytes: bytes.len(),
            quantization: header.quantization,
            model_bytes: sum(std::slice::from_ref(&header.model)),
            image_bytes: sum(&header.images),
            levels: header.levels.iter().map(LevelReport::from).collect(),
        };
        if let Some(path) = &self.json {
            write_json(path, &report)?;
        }
        say("level  triangles   vertices      error        bytes")?;
        for (at, level) in report.levels.iter().enumerate() {
            let number = report.levels.len() - 1 - at;
            let LevelReport { triangles, vertices, error, end, .. } = level;
            say(format_args!("{number:>5} {triangles:>10} {vertices:>10} {error:>10.3e} {end:>12}"))?;
        }
        say(format_args!("{} bytes in all, after {seconds:.1} s", report.bytes))
    }
}

/// Opens a file or a built-in model.
fn open(path: &Path) -> Result<ModelFile, Error> {
    match path.to_str().and_then(|text| text.strip_prefix(BUILT_IN)) {
        Some(name) => Ok(relievo_samples::model(name)?.into()),
        None => ModelFile::open(path),
    }
}
