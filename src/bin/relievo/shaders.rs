//! `relievo shaders`

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use relievo::Error;
use relievo::gpu::shaders::{ALL, Shader};
use relievo::terrain::export::write_bytes;

use crate::output::{Staged, json, say};

/// Writes the flat WGSL of every pass, and `manifest.json` with entry points, bindings and workgroup sizes.
#[derive(Args)]
pub struct Shaders {
    /// The folder.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(serde::Serialize)]
struct Entry {
    file: String,
    #[serde(flatten)]
    shader: &'static Shader,
}

impl Shaders {
    pub fn run(&self) -> Result<ExitCode, Error> {
        let mut staged = Staged::new(&self.out)?;
        let mut entries = Vec::new();
        for shader in ALL {
            let file = format!("{}.wgsl", shader.name.replace('/', "_"));
            write_bytes(&staged.path(file.clone()), shader.source.as_bytes())?;
            entries.push(Entry { file, shader });
        }
        write_bytes(&staged.path("manifest.json"), &json(&entries)?)?;
        staged.publish()?;
        say(format_args!("{} shaders and manifest.json in {}", ALL.len(), self.out.display()))?;
        Ok(ExitCode::SUCCESS)
    }
}
