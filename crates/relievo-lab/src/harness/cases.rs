//! Parity cases of operations, and their results.

use relievo::gpu::Gpu;
use serde::Serialize;

use crate::harness::compare::Comparison;

/// The result of one case.
#[derive(Debug, Clone, Serialize)]
pub struct CaseResult {
    /// The kernel.
    pub stem: &'static str,
    /// Description of the case.
    pub case: String,
    /// The outcome.
    #[serde(flatten)]
    pub comparison: Comparison,
}

/// A case that a device cannot run.
#[derive(Debug, Clone, Serialize)]
pub struct Skipped {
    /// The kernel.
    pub stem: &'static str,
    /// Description of the case.
    pub case: String,
    /// Why the device cannot run it.
    pub reason: String,
}

/// Collects the cases of a run.
pub struct Cases<'a> {
    /// The device that is being verified.
    pub gpu: &'a Gpu,
    pub(crate) stem: &'static str,
    pub(crate) results: Vec<CaseResult>,
    pub(crate) skipped: Vec<Skipped>,
    pub(crate) progress: &'a mut dyn FnMut(&CaseResult),
}

impl Cases<'_> {
    /// Records that this device cannot run a case, and why. A kernel whose cases are all skipped does not hold.
    pub(crate) fn skip(&mut self, case: impl Into<String>, reason: impl Into<String>) {
        self.skipped.push(Skipped { stem: self.stem, case: case.into(), reason: reason.into() });
    }

    /// Adds a case.
    pub(crate) fn add(&mut self, case: impl Into<String>, comparison: Comparison) {
        let result = CaseResult { stem: self.stem, case: case.into(), comparison };
        (self.progress)(&result);
        self.results.push(result);
    }
}
