//! Argument types and parsers that several commands share.

use std::str::FromStr;

use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use relievo::gpu::Gpu;
use relievo::{Error, InputError};
use serde::Serialize;

use crate::Context;
use crate::terrain::export::HeightRange;

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

/// Parses two values with a separator between them.
pub fn pair<T: FromStr>(field: &str, text: &str, separator: char, bound: &str) -> Result<[T; 2], InputError> {
    let (first, second) = text.split_once(separator).unwrap_or((text, ""));
    match (first.trim().parse(), second.trim().parse()) {
        (Ok(first), Ok(second)) => Ok([first, second]),
        _ => Err(InputError::new(field, text, bound)),
    }
}

/// Parses the heights of black and white.
pub fn height_range(text: &str) -> Result<HeightRange, InputError> {
    let bound = "must be two finite heights, such as -20,35.5";
    let [low, high] = pair::<f64>("heights-range", text, ',', bound)?;
    if low.is_finite() && high.is_finite() {
        return Ok(HeightRange { low, high });
    }
    Err(InputError::new("heights-range", text, bound))
}
