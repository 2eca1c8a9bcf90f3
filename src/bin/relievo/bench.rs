//! `relievo bench`

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use relievo::Error;
use relievo::bench::run;
use relievo::harness::{Row, table};

use crate::Context;
use crate::output::{json, say, write_file};

/// Measures every kernel beside its CPU reference and a copy of the same bytes, in one run.
#[derive(Args)]
pub struct Bench {
    /// Only kernels whose name contains this, such as `terrain` or `height`.
    #[arg(long, value_name = "STEM")]
    only: Option<String>,
    /// Writes every figure.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl Bench {
    pub fn run(&self, context: &Context) -> Result<ExitCode, Error> {
        let gpu = context.gpu()?;
        say(format_args!("adapter: {}", gpu.adapter()))?;
        if cfg!(debug_assertions) {
            say("this is a debug build: the references are slower than they should be (use --release)")?;
        }
        let spinner = indicatif::ProgressBar::new_spinner();
        let summary = run(&gpu, self.only.as_deref(), &mut |row: &Row| {
            spinner.set_message(format!("{} {} {}", row.name, row.case, row.backend.name()));
            spinner.tick();
        })?;
        spinner.finish_and_clear();
        say(table(&summary.rows).trim_end())?;
        say(
            "`gpu is`: how many times as fast the kernel is as that row, the median over rounds in which all of a case \
             take turns. `clock`: wall includes submission and waiting.",
        )?;
        if let Some(path) = &self.json {
            write_file(path, &json(&summary)?)?;
            say(format_args!("written to {}", path.display()))?;
        }
        Ok(ExitCode::SUCCESS)
    }
}
