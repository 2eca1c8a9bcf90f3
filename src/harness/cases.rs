//! Parity cases: what an operation adds, and what came of it.

use serde::Serialize;

use super::compare::Comparison;
use crate::gpu::Gpu;

/// One case's result.
#[derive(Debug, Clone, Serialize)]
pub struct CaseResult {
    /// The kernel.
    pub stem: &'static str,
    /// What was computed.
    pub case: String,
    /// What came of it.
    #[serde(flatten)]
    pub comparison: Comparison,
}

/// Collects the cases of a run.
pub struct Cases<'a> {
    /// The device that is being verified.
    pub gpu: &'a Gpu,
    pub(crate) stem: &'static str,
    pub(crate) results: Vec<CaseResult>,
    pub(crate) progress: &'a mut dyn FnMut(&CaseResult),
}

impl Cases<'_> {
    /// Adds a case.
    pub fn add(&mut self, case: impl Into<String>, comparison: Comparison) {
        let result = CaseResult { stem: self.stem, case: case.into(), comparison };
        (self.progress)(&result);
        self.results.push(result);
    }
}

/// Whether `stem` is asked for: `only` is a stem, a part of one, or nothing.
pub fn selected(stem: &str, only: Option<&str>) -> bool {
    only.is_none_or(|only| stem.contains(only))
}
