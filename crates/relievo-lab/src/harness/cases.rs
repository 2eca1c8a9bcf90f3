//! Parity cases of operations, and their results.

use std::fmt::Debug;

use relievo::Error;
use relievo::gpu::Gpu;
use serde::Serialize;

use crate::harness::compare::{self, Comparison};
use crate::harness::poison::Poisoned;

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
    pub(crate) fn add(&mut self, case: impl Into<String>, comparison: Comparison) {
        let result = CaseResult { stem: self.stem, case: case.into(), comparison };
        (self.progress)(&result);
        self.results.push(result);
    }

    /// Adds the comparison of an output.
    pub(crate) async fn check<T: bytemuck::Pod>(
        &mut self,
        case: impl Into<String>,
        output: &Poisoned<T>,
        compare: impl FnOnce(&[T]) -> Comparison,
    ) -> Result<(), Error> {
        let comparison = output.check(self.gpu, compare).await?;
        self.add(case, comparison);
        Ok(())
    }

    /// Adds the comparison to the bit of an output.
    pub(crate) async fn exact<T: bytemuck::Pod + Debug + PartialEq>(
        &mut self,
        case: impl Into<String>,
        output: &Poisoned<T>,
        expected: &[T],
    ) -> Result<(), Error> {
        self.check(case, output, |actual| compare::exact(actual, expected)).await
    }

    /// The values of an output. Adds a case of whether memory beyond its end is untouched.
    pub(crate) async fn values<T: bytemuck::Pod>(
        &mut self,
        case: impl Into<String>,
        output: &Poisoned<T>,
    ) -> Result<Vec<T>, Error> {
        let mut values = Vec::new();
        let read = |all: &[T]| {
            values.extend_from_slice(all);
            compare::exact(&[0], &[0])
        };
        self.check(case, output, read).await?;
        Ok(values)
    }
}
