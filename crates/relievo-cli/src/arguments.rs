//! Argument types and parsers that several commands share.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::{Error, InputError};
use relievo_samples::creature;
use serde::Serialize;

use crate::Context;

/// The processor that computes.
#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    #[default]
    Gpu,
    Cpu,
}

impl Backend {
    /// Opens the device if the backend is the GPU; `None` for the CPU.
    pub fn gpu(self, context: &Context) -> Result<Option<Gpu>, Error> {
        match self {
            Self::Gpu => context.gpu().map(Some),
            Self::Cpu => Ok(None),
        }
    }
}

/// The model that a command shows.
#[derive(Args)]
pub struct ModelArgs {
    /// A .glb, .gltf, .obj or .rlv file, or `builtin`: a creature of 153 bones with the clips walk, idle and wave.
    #[arg(long = "model", value_name = "FILE|builtin")]
    path: PathBuf,
}

impl ModelArgs {
    /// The argument as it was given.
    pub fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// Opens the model.
    pub fn open(&self) -> Result<Model, Error> {
        open(&self.path)
    }

    /// Opens the model without materials and images.
    pub fn open_bare(&self) -> Result<Model, Error> {
        if self.path == Path::new("builtin") { Ok(creature()?) } else { Model::from_file_bare(&self.path) }
    }

    /// Finds a clip of the model by name or number, and returns its index; the error names the file that lacks it.
    pub fn clip(&self, model: &Model, clip: &str) -> Result<usize, Error> {
        let found = model.clip(clip).map_err(|source| self.refused(source))?;
        Ok(model.clips.iter().position(|other| std::ptr::eq(other, found)).unwrap_or_default())
    }

    /// What is wrong with the model.
    pub fn refused(&self, source: InputError) -> Error {
        Error::InputFile { path: self.path.clone(), source }
    }
}

/// Opens the model of a file, or the built-in creature.
pub fn open(path: &Path) -> Result<Model, Error> {
    if path == Path::new("builtin") { Ok(creature()?) } else { Model::from_file(path) }
}

/// Makes a clap parser that maps each name to its value and refuses all other names.
pub fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(
    values: [(&'static str, T); N],
) -> impl TypedValueParser<Value = T> {
    let find = move |name: String| {
        let found = values.into_iter().find(|(other, _)| *other == name);
        found.map(|(_, value)| value).ok_or("is none of these")
    };
    PossibleValuesParser::new(values.map(|(name, _)| name)).try_map(find)
}

/// Parses one of a list of distances.
pub fn distance(text: &str) -> Result<f32, InputError> {
    let refused = |_| InputError::new("distance", text, "must be numbers with commas between them");
    text.trim().parse().map_err(refused)
}

/// Makes a clap parser of two values with a separator between them; `bound` says what they must be.
pub fn pair<T: FromStr>(
    field: &'static str,
    separator: char,
    bound: &'static str,
) -> impl Fn(&str) -> Result<[T; 2], InputError> + Clone {
    move |text| {
        let (first, second) = text.split_once(separator).unwrap_or((text, ""));
        match (first.trim().parse(), second.trim().parse()) {
            (Ok(first), Ok(second)) => Ok([first, second]),
            _ => Err(InputError::new(field, text, bound)),
        }
    }
}

/// Makes a clap parser of the width and height of a picture, each at most `most`.
pub fn size(most: u32) -> impl Fn(&str) -> Result<[u32; 2], InputError> + Clone {
    move |text| {
        let size = pair("size", 'x', "must be width x height in pixels, such as 960x600")(text)?;
        if size.iter().all(|edge| (1..=most).contains(edge)) {
            return Ok(size);
        }
        let bound = format!("must be 1 to {most} pixels along each edge");
        Err(InputError::new("size", text, bound))
    }
}
