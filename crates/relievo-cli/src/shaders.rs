//! `relievo shaders`: the WGSL of every pass as files.

use std::path::PathBuf;

use clap::Args;
use relievo::Error;
use relievo::gpu::shaders::{ALL, MODULES, Module, Shader};
use relievo_lab::files::Staged;

use crate::output::say;

/// Writes the WGSL of every pass, and what a host needs to know to use it.
///
/// There is one flat file per pass; `module_<name>.wgsl`, functions to put before your own shaders (every
/// ray-height method, zone weights, rotations, dual quaternions); and `manifest.json`, which has for each pass its
/// entry points with workgroup sizes and vertex inputs, its bindings with types, its override constants with
/// defaults, and its structs with offsets.
#[derive(Args)]
pub struct Shaders {
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// The contents of `manifest.json`.
#[derive(serde::Serialize)]
struct Manifest {
    shaders: Vec<Entry<Shader>>,
    modules: Vec<Entry<Module>>,
}

/// A file's name and what it contains.
#[derive(serde::Serialize)]
struct Entry<T: 'static> {
    file: String,
    #[serde(flatten)]
    content: &'static T,
}

impl Shaders {
    pub fn run(&self) -> Result<(), Error> {
        let mut staged = Staged::new(&self.out)?;
        let mut manifest = Manifest { shaders: Vec::new(), modules: Vec::new() };
        for shader in ALL {
            let file = format!("{}.wgsl", shader.name.replace('/', "_"));
            staged.write(file.clone(), shader.source.as_bytes())?;
            manifest.shaders.push(Entry { file, content: shader });
        }
        for module in MODULES {
            let file = format!("module_{}.wgsl", module.name);
            staged.write(file.clone(), module.source.as_bytes())?;
            manifest.modules.push(Entry { file, content: module });
        }
        staged.write_json("manifest.json", &manifest)?;
        staged.publish()?;
        let (passes, modules) = (ALL.len(), MODULES.len());
        say(format_args!("{passes} shaders, {modules} modules and manifest.json in {}", self.out.display()))
    }
}
