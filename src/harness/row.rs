//! What a benchmark measures.

use serde::Serialize;

use crate::gpu::TimedBy;

/// What a row measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Backend {
    /// The kernel.
    Gpu,
    /// Its reference on one thread.
    Reference,
    /// Its reference on all threads.
    ReferenceParallel,
    /// Straightforward structure-of-arrays code for the processor, on one thread.
    PlainSoa,
    /// A kernel that moves the same bytes.
    Copy,
    /// What cannot be avoided: see the benchmark.
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

/// One measured figure.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// The kernel.
    pub name: &'static str,
    /// Sizes and batch.
    pub case: String,
    /// What was measured.
    pub backend: Backend,
    /// Median of the repetitions.
    pub nanoseconds: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
    /// Time beside the kernel's (`gpu`): the median over rounds in which both took their turn. None for the kernel.
    #[serde(skip)]
    pub beside_kernel: Option<f64>,
    /// Items computed.
    pub items: u64,
    /// What an item is.
    pub item: &'static str,
    /// Bytes that must be read and written.
    pub bytes: u64,
    /// The clock.
    pub timed_by: TimedBy,
}
