//! Benchmarks: every kernel against its CPU reference and a copy of the same bytes, in one run on the current
//! adapter (`relievo bench`). Results are ratios, since absolute times mean little across machines.

use relievo::Error;
use relievo::gpu::Gpu;
use serde::Serialize;

use crate::cases::{Operation, selected};
use crate::harness::{Bench, Row};

/// The results of a run.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// The adapter.
    pub device: String,
    /// Its driver.
    pub driver: String,
    /// The commit of the build, if known.
    pub commit: String,
    /// Number of threads of `reference-parallel`.
    pub threads: usize,
    /// The results.
    pub rows: Vec<Row>,
}

/// Sets up a kernel's benchmark without measuring, and returns its rows.
///
/// # Errors
/// What the device reports.
pub fn unmeasured(gpu: &Gpu, operation: &Operation) -> Result<Vec<Row>, Error> {
    let progress = &mut |_: &Row| ();
    let mut bench = Bench::new(gpu, operation.name, progress)?.unmeasured();
    (operation.benchmark)(&mut bench)?;
    Ok(bench.into_rows())
}

/// Runs the benchmarks of every selected kernel, and calls `progress` with each row.
///
/// # Errors
/// [`relievo::InputError`] when nothing is selected; errors of the device.
pub fn run(gpu: &Gpu, only: Option<&str>, progress: &mut dyn FnMut(&Row)) -> Result<Summary, Error> {
    let mut rows = Vec::new();
    for operation in selected(only)? {
        let mut bench = Bench::new(gpu, operation.name, progress)?;
        (operation.benchmark)(&mut bench)?;
        rows.extend(bench.into_rows());
    }
    Ok(Summary {
        device: gpu.adapter().name.clone(),
        driver: gpu.adapter().driver.clone(),
        commit: option_env!("RELIEVO_COMMIT").unwrap_or("unknown").to_owned(),
        threads: rayon::current_num_threads(),
        rows,
    })
}
