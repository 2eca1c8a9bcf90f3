//! `relievo verify`: compares every kernel with its CPU reference.

use std::path::PathBuf;

use clap::Args;
use relievo::Error;
use relievo_lab::files::write_json;
use relievo_lab::harness::CaseResult;
use relievo_lab::verify::run;

use crate::Context;
use crate::output::say;
use crate::progress::spinner;

/// Compares every kernel with its CPU reference on your adapter, and prints which of them agree. Exits with 1
/// if one does not.
///
/// relievo verify --only terrain/thermal
#[derive(Args)]
pub struct Verify {
    /// Compares only kernels whose name contains this text, such as `terrain/height` or `thermal`.
    #[arg(long, value_name = "STEM")]
    only: Option<String>,
    /// Also writes every case with its error and bound to this file.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl Verify {
    /// Whether every case holds.
    pub fn run(&self, context: &Context) -> Result<bool, Error> {
        let gpu = context.gpu()?;
        say(format_args!("adapter: {}", gpu.adapter()))?;
        let spinner = spinner();
        let report = run(&gpu, self.only.as_deref(), &mut |case: &CaseResult| {
            spinner.set_message(format!("{} {}", case.stem, case.case));
        })?;
        spinner.finish_and_clear();
        say(report.summary().trim_end())?;
        if let Some(path) = &self.json {
            write_json(path, &report)?;
        }
        Ok(report.holds)
    }
}
