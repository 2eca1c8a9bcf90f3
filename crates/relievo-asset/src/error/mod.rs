//! Errors: invalid input, files, and the GPU.

#[cfg(feature = "gpu")]
mod gpu;
#[doc(hidden)]
pub mod json;
mod names;

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

#[cfg(feature = "gpu")]
pub use gpu::GpuError;
pub use names::name_or_index;

/// A value outside its bounds. Programs may compare the fields, for example `error.path == "zones[2].max"`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{path} = {value}: {bound}")]
pub struct InputError {
    /// The path of the refused field, such as `zones[2].max`.
    pub path: String,
    /// The refused value.
    pub value: String,
    /// The condition that the value must meet.
    pub bound: String,
}

impl InputError {
    /// An error for the value at `path`, which does not meet `bound`.
    pub fn new(path: impl Into<String>, value: impl Display, bound: impl Into<String>) -> Self {
        Self { path: path.into(), value: value.to_string(), bound: bound.into() }
    }

    /// Refuses a list at `path` whose length is not `wanted`. `each` names the thing that needs one entry in the list.
    #[doc(hidden)]
    pub fn check_len(path: &str, len: usize, wanted: usize, each: &str) -> Result<(), Self> {
        Self::check_same(format!("{path}.len"), len, wanted, &format!("one {each}"))
    }

    /// Refuses a value that is not `wanted`; `reason` says where `wanted` comes from.
    #[doc(hidden)]
    pub fn check_same<T: PartialEq + Display>(
        path: impl Into<String>,
        value: T,
        wanted: T,
        reason: &str,
    ) -> Result<(), Self> {
        Self::check(value == wanted, path, value, || format!("must be {wanted}, {reason}"))
    }

    /// Refuses an index that is not below `count`.
    #[doc(hidden)]
    pub fn check_below(
        path: impl Into<String>,
        index: impl TryInto<usize> + Copy + Display,
        count: usize,
    ) -> Result<(), Self> {
        let is_below = index.try_into().is_ok_and(|index| index < count);
        Self::check(is_below, path, index, || format!("must be below {count}"))
    }

    /// Refuses a value above `most`.
    #[doc(hidden)]
    pub fn check_most<T: PartialOrd + Display>(
        path: impl Into<String>,
        value: T,
        most: T,
    ) -> Result<(), Self> {
        Self::check(value <= most, path, value, || format!("must be at most {most}"))
    }

    /// Refuses a value outside of a range.
    #[doc(hidden)]
    pub fn check_within<T: PartialOrd + Display>(
        path: impl Into<String>,
        value: T,
        range: RangeInclusive<T>,
    ) -> Result<(), Self> {
        let bound = || format!("must be in {}..={}", range.start(), range.end());
        Self::check(range.contains(&value), path, value, bound)
    }

    /// Refuses infinities and NaN.
    #[doc(hidden)]
    pub fn check_finite(path: impl Into<String>, value: impl Into<f64> + Copy + Display) -> Result<(), Self> {
        Self::check(value.into().is_finite(), path, value, || "must be finite")
    }

    /// Refuses the first value of a list that fails the test.
    #[doc(hidden)]
    pub fn check_each<T: Display>(
        path: &str,
        values: &[T],
        is_good: impl Fn(&T) -> bool,
        bound: impl Into<String>,
    ) -> Result<(), Self> {
        match values.iter().position(|value| !is_good(value)) {
            None => Ok(()),
            Some(at) => Err(Self::new(format!("{path}[{at}]"), &values[at], bound)),
        }
    }

    /// Checks a condition. `bound` names the bound that the value exceeds if the condition does not hold.
    #[doc(hidden)]
    pub fn check<B: Into<String>>(
        is_good: bool,
        path: impl Into<String>,
        value: impl Display,
        bound: impl FnOnce() -> B,
    ) -> Result<(), Self> {
        if is_good { Ok(()) } else { Err(Self::new(path, value, bound())) }
    }

    /// Prepends `parent` and a dot to the error's path.
    #[doc(hidden)]
    pub fn below(self, parent: &str) -> Self {
        Self { path: format!("{parent}.{}", self.path), ..self }
    }

    /// Writes the error's path in camel case, as in JSON files: `patchSize` for the field `patch_size`.
    pub fn in_json(self) -> Self {
        let mut path = String::with_capacity(self.path.len());
        let mut letters = self.path.chars().peekable();
        while let Some(letter) = letters.next() {
            match letters.peek() {
                Some(next) if letter == '_' && next.is_ascii_lowercase() => {
                    path.extend(letters.next().map(|next| next.to_ascii_uppercase()));
                }
                _ => path.push(letter),
            }
        }
        Self { path, ..self }
    }
}

/// Any error of the crate.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A value is outside its bounds.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A value in a file is outside its bounds.
    #[error("{}: {source}", path.display())]
    InputFile {
        /// Path of the file.
        path: PathBuf,
        /// The invalid value in the file.
        source: InputError,
    },
    /// A file cannot be read or understood.
    #[error("{}: {reason}", path.display())]
    File {
        /// Path of the file.
        path: PathBuf,
        /// The reason that the file cannot be read or understood.
        reason: String,
    },
    /// A file cannot be written.
    #[error("{}: {reason}", path.display())]
    Output {
        /// Path of the file.
        path: PathBuf,
        /// The reason that the file cannot be written.
        reason: String,
    },
    /// The GPU device failed, or no device exists.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

impl Error {
    /// Creates an [`Error::File`] for a file that cannot be read or understood.
    pub fn file(path: impl AsRef<Path>, reason: impl Display) -> Self {
        Self::File { path: path.as_ref().to_owned(), reason: reason.to_string() }
    }

    /// Creates an [`Error::Output`] for a file that cannot be written.
    pub fn output(path: impl AsRef<Path>, reason: impl Display) -> Self {
        Self::Output { path: path.as_ref().to_owned(), reason: reason.to_string() }
    }

    /// Whether the user's input is at fault, including files that cannot be read. False for failures of the machine.
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Input(_) | Self::InputFile { .. } | Self::File { .. })
    }
}
