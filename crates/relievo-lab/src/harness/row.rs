//! The rows of a benchmark.

use serde::Serialize;

use crate::harness::TimedBy;

/// The contender that a row measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Backend {
    /// The kernel.
    Gpu,
    /// Its CPU reference on one thread.
    Reference,
    /// Its CPU reference on all threads.
    ReferenceParallel,
    /// Plain structure-of-arrays code for the CPU, on one thread.
    PlainSoa,
    /// A kernel that moves the same bytes.
    Copy,
    /// Work that cannot be avoided; the benchmark says which.
    Limit,
}

impl Backend {
    /// Its name in tables and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gpu => "gpu",
            Self::Reference => "reference",
            Self::ReferenceParallel => "reference-parallel",
            Self::PlainSoa => "plain-soa",
            Self::Copy => "copy",
            Self::Limit => "limit",
        }
    }
}

/// One measured result.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// The kernel.
    pub name: &'static str,
    /// Sizes and batch.
    pub case: String,
    /// The contender.
    pub backend: Backend,
    /// Median time of the repetitions, in nanoseconds.
    pub nanoseconds: f64,
    /// The shortest time, in nanoseconds.
    pub min: f64,
    /// The longest time, in nanoseconds.
    pub max: f64,
    /// The ratio of this time to the kernel's (`gpu`): the median over the rounds in which both took part.
    /// `None` for the kernel.
    #[serde(skip)]
    pub beside_kernel: Option<f64>,
    /// Number of items computed.
    pub items: u64,
    /// What an item is.
    pub item: &'static str,
    /// Bytes that must be read and written.
    pub bytes: u64,
    /// The clock that was used.
    pub timed_by: TimedBy,
}
