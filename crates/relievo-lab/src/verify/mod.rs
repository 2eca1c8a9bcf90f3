//! Parity: every kernel against its CPU reference, on the current adapter (`relievo verify`). This is part of
//! the product, so that users can find out whether their driver computes correctly.

use relievo::Error;
use relievo::gpu::{AdapterSummary, Gpu};
use serde::Serialize;

use crate::cases::{Operation, selected};
use crate::harness::compare::Comparison;
use crate::harness::{CaseResult, Cases};

mod summary;

/// The results of all cases on one adapter.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The adapter.
    pub adapter: AdapterSummary,
    /// relievo's version.
    pub version: &'static str,
    /// Whether every case holds.
    pub holds: bool,
    /// The results, case by case.
    pub cases: Vec<CaseResult>,
}

/// Runs the cases of every selected kernel, and calls `progress` with each result. Blocks.
///
/// # Errors
/// As [`run_async`].
#[cfg(not(target_arch = "wasm32"))]
pub fn run(gpu: &Gpu, only: Option<&str>, progress: &mut dyn FnMut(&CaseResult)) -> Result<Report, Error> {
    gpu.block_on(run_async(gpu, only, progress))
}

/// Runs the cases of every kernel whose name contains `only`, or of all, and calls `progress` with each result.
///
/// # Errors
/// [`relievo::InputError`] when nothing is selected; errors of the device.
pub async fn run_async(
    gpu: &Gpu,
    only: Option<&str>,
    progress: &mut dyn FnMut(&CaseResult),
) -> Result<Report, Error> {
    run_operations(gpu, selected(only)?, progress).await
}

/// Runs the cases of the given kernels. A kernel without results does not hold, since nothing was proven.
///
/// # Errors
/// What the device reports.
pub async fn run_operations<'a>(
    gpu: &Gpu,
    operations: impl IntoIterator<Item = &'a Operation>,
    progress: &mut dyn FnMut(&CaseResult),
) -> Result<Report, Error> {
    let mut all = Vec::new();
    for operation in operations {
        let mut cases = Cases { gpu, stem: operation.name, results: Vec::new(), progress };
        (operation.parity)(&mut cases).await?;
        if cases.results.is_empty() {
            cases.add("no case", Comparison::failed(0, "the kernel has no parity case".to_owned()));
        }
        all.append(&mut cases.results);
    }
    let holds = !all.is_empty() && all.iter().all(|result| result.comparison.holds);
    Ok(Report { adapter: gpu.adapter().clone(), version: env!("CARGO_PKG_VERSION"), holds, cases: all })
}
