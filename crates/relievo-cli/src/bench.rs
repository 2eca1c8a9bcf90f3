//! `relievo bench`: times each kernel beside its CPU reference and a memory copy.

use std::path::PathBuf;

use clap::Args;
use relievo::Error;
use relievo_lab::bench::run;
use relievo_lab::files::write_json;
use relievo_lab::harness::{Row, table};

use crate::Context;
use crate::output::say;
use crate::progress::spinner;

/// Times every kernel beside its CPU reference and beside a copy of the same number of bytes, in one run.
#[derive(Args)]
pub struct Bench {
    /// Runs only kernels whose name contains this text, such as `terrain` or `height`.
    #[arg(long, value_name = "STEM")]
    only: Option<String>,
    /// Also writes every measurement to this file.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

impl Bench {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let gpu = context.gpu()?;
        say(format_args!("adapter: {}", gpu.adapter()))?;
        if cfg!(debug_assertions) {
            say("this is a debug build: the references are slower than they should be (use --release)")?;
        }
        let spinner = spinner();
        let summary = run(&gpu, self.only.as_deref(), &mut |row: &Row| {
            spinner.set_message(format!("{} {} {}", row.name, row.case, row.backend.name()));
        })?;
        spinner.finish_and_clear();
        say(table(&summary.rows).trim_end())?;
        say(
            "`gpu is`: how many times as fast the kernel is as that row, the median over rounds in which all of a case \
             take turns. `clock`: wall includes submission and waiting.",
        )?;
        if let Some(path) = &self.json {
            write_json(path, &summary)?;
            say(format_args!("written to {}", path.display()))?;
        }
        Ok(())
    }
}
