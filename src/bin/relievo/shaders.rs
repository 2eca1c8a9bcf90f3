//! `relievo shaders`

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use relievo::Error;
use relievo::gpu::shaders::{ALL, MODULES, Shader};
use relievo::terrain::export::write_bytes;

use crate::output::{Staged, json, say};

/// Writes the flat WGSL of every pass, `manifest.json` with entry points, bindings and workgroup sizes, and
/// `module_<name>.wgsl`: functions to put before your own shaders, such as every ray-height method.
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
        for module in MODULES {
            write_bytes(&staged.path(format!("module_{}.wgsl", module.name)), module.source.as_bytes())?;
        }
        write_bytes(&staged.path("manifest.json"), &json(&entries)?)?;
        staged.publish()?;
        let (passes, modules) = (ALL.len(), MODULES.len());
        say(format_args!("{passes} shaders, {modules} modules and manifest.json in {}", self.out.display()))?;
        Ok(ExitCode::SUCCESS)
    }
}
