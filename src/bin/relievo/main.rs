//! The command line: a thin shell over the library.

#[cfg(feature = "gpu")]
mod bench;
#[cfg(feature = "gpu")]
mod demo;
#[cfg(feature = "gpu")]
mod info;
mod output;
#[allow(dead_code, reason = "the first command that draws charts comes with the relief methods")]
mod plot;
mod progress;
#[cfg(feature = "gpu")]
mod shaders;
mod terrain;
#[cfg(feature = "gpu")]
mod verify;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// A GPU-compute rendering core: terrain that is the same bits on every device, proven on yours.
///
/// Start with `relievo demo --out demo`, and `relievo verify` to see whether your driver computes what it
/// should.
#[derive(Parser)]
#[command(version, propagate_version = true)]
struct Arguments {
    /// The adapter: a kind (discrete, integrated, virtual, cpu) or a part of its name or driver. Default: the
    /// fastest kind there is.
    #[cfg(feature = "gpu")]
    #[arg(long, global = true, env = "RELIEVO_ADAPTER", value_name = "NAME")]
    adapter: Option<String>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Lists adapters, the chosen one's driver and limits, and every pass.
    #[cfg(feature = "gpu")]
    Info,
    Terrain(Box<terrain::Terrain>),
    #[cfg(feature = "gpu")]
    Verify(verify::Verify),
    #[cfg(feature = "gpu")]
    Bench(bench::Bench),
    #[cfg(feature = "gpu")]
    Shaders(shaders::Shaders),
    #[cfg(feature = "gpu")]
    Demo(demo::Demo),
}

/// What a command is run with.
pub struct Context {
    #[cfg(feature = "gpu")]
    options: relievo::gpu::Options,
}

#[cfg(feature = "gpu")]
impl Context {
    /// Opens the chosen adapter.
    fn gpu(&self) -> Result<relievo::gpu::Gpu, relievo::Error> {
        Ok(relievo::gpu::Gpu::headless(&self.options)?)
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let context = Context {
        #[cfg(feature = "gpu")]
        options: relievo::gpu::Options { adapter: arguments.adapter },
    };
    let outcome = match arguments.command {
        #[cfg(feature = "gpu")]
        Command::Info => info::run(&context),
        Command::Terrain(command) => command.run(&context),
        #[cfg(feature = "gpu")]
        Command::Verify(command) => command.run(&context),
        #[cfg(feature = "gpu")]
        Command::Bench(command) => command.run(&context),
        #[cfg(feature = "gpu")]
        Command::Shaders(command) => command.run(),
        #[cfg(feature = "gpu")]
        Command::Demo(command) => command.run(&context),
    };
    match outcome {
        Ok(code) => code,
        Err(error) => {
            let line = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            eprintln!("relievo: {line}");
            ExitCode::from(if error.is_input() { 2 } else { 1 })
        }
    }
}
