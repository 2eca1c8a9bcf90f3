//! The command line: parses arguments, and calls the library.

mod arguments;
mod bench;
mod coarsen;
mod collapse;
mod cook;
mod creases;
mod crowd;
mod demo;
#[cfg(feature = "network")]
mod fetch;
mod info;
mod memory;
mod output;
mod pose;
mod priorities;
mod progress;
mod relief;
mod scene;
#[cfg(feature = "network")]
mod serve;
mod shaders;
mod simplify;
mod skin;
mod sweep;
mod terrain;
mod verify;
#[cfg(feature = "view")]
mod view;

use std::error::Error as _;
use std::io::Write as _;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{ArgMatches, CommandFactory as _, FromArgMatches as _, Parser, Subcommand};

/// A GPU-compute rendering core: terrain that is the same bits on every device, proven on yours.
///
/// Start with `relievo demo --out demo`, which draws examples of everything, and `relievo verify`, which checks
/// that your driver computes correct results.
#[derive(Parser)]
#[command(version, propagate_version = true)]
struct Arguments {
    /// The adapter to use: its kind (discrete, integrated, virtual, cpu), or a part of its name or driver.
    /// Default: the fastest kind that exists.
    #[arg(long, global = true, env = "RELIEVO_ADAPTER", value_name = "NAME")]
    adapter: Option<String>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Lists the adapters, the driver and limits of the chosen one, and every pass.
    Info,
    Scene(Box<scene::Scene>),
    #[cfg(feature = "view")]
    View(view::View),
    Terrain(Box<terrain::Terrain>),
    Creases(creases::Creases),
    Relief(Box<relief::Relief>),
    Pose(pose::Pose),
    Priorities(priorities::Priorities),
    Skin(skin::Skin),
    Simplify(Box<simplify::Simplify>),
    Cook(cook::Cook),
    #[cfg(feature = "network")]
    Serve(Box<serve::Serve>),
    #[cfg(feature = "network")]
    Export(serve::Export),
    #[cfg(feature = "network")]
    Fetch(fetch::Fetch),
    Crowd(Box<crowd::Crowd>),
    Sweep(Box<sweep::Sweep>),
    Verify(verify::Verify),
    Bench(bench::Bench),
    Shaders(shaders::Shaders),
    Demo(demo::Demo),
}

/// The global arguments that every command runs with.
pub struct Context {
    options: relievo::gpu::Options,
    opened: std::cell::OnceCell<relievo::gpu::Gpu>,
}

impl Context {
    /// The chosen adapter's device, opened at the first call.
    fn gpu(&self) -> Result<relievo::gpu::Gpu, relievo::Error> {
        if let Some(gpu) = self.opened.get() {
            return Ok(gpu.clone());
        }
        let gpu = relievo::gpu::Gpu::headless(&self.options)?;
        Ok(self.opened.get_or_init(|| gpu).clone())
    }
}

fn main() -> ExitCode {
    let matches = Arguments::command().try_get_matches();
    let parsed = matches.and_then(|matches| Ok((Arguments::from_arg_matches(&matches)?, matches)));
    let (arguments, matches) = match parsed {
        Ok(parsed) => parsed,
        Err(error) => return refused(&error),
    };
    let context =
        Context { options: relievo::gpu::Options { adapter: arguments.adapter }, opened: Default::default() };
    let outcome = match arguments.command {
        Command::Info => info::run(&context),
        Command::Scene(command) => command.run(&context),
        #[cfg(feature = "view")]
        Command::View(command) => command.run(&context),
        Command::Terrain(command) => command.run(&context),
        Command::Creases(command) => command.run(),
        Command::Relief(command) => command.run(&context),
        Command::Pose(command) => command.run(&context),
        Command::Priorities(command) => command.run(),
        Command::Skin(command) => command.run(&context),
        Command::Simplify(command) => command.run(&context),
        Command::Cook(command) => command.run(),
        #[cfg(feature = "network")]
        Command::Serve(command) => command.run(),
        #[cfg(feature = "network")]
        Command::Export(command) => command.run(),
        #[cfg(feature = "network")]
        Command::Fetch(command) => command.run(),
        Command::Crowd(command) => command.run(&context),
        Command::Sweep(command) => command.run(&context),
        Command::Bench(command) => command.run(&context),
        Command::Shaders(command) => command.run(),
        Command::Demo(command) => command.run(&context),
        Command::Verify(command) => match command.run(&context) {
            Ok(false) => return ExitCode::FAILURE,
            outcome => outcome.map(|_| ()),
        },
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&format!("{error}{}", remedy(&error, has_backend(&matches))));
            ExitCode::from(if error.is_input() { 2 } else { 1 })
        }
    }
}

/// Whether the command takes `--backend`.
fn has_backend(matches: &ArgMatches) -> bool {
    // It has a default: where it is taken, it is there.
    matches.subcommand().is_some_and(|(_, own)| matches!(own.try_contains_id("backend"), Ok(true)))
}

/// What the command line offers where the device allows too little, beyond what the library advises.
fn remedy(error: &relievo::Error, has_backend: bool) -> &'static str {
    match error {
        relievo::Error::Gpu(relievo::gpu::GpuError::Limit { .. }) if has_backend => "; or give --backend cpu",
        _ => "",
    }
}

/// Prints one line that says what is wrong with the arguments, or prints the help or version that they ask
/// for.
fn refused(error: &clap::Error) -> ExitCode {
    if error.exit_code() == 0 {
        // A closed pipe is no error: the reader has read enough.
        let _ = error.print();
        return ExitCode::SUCCESS;
    }
    if let Some(input) = error.source().and_then(|source| source.downcast_ref::<relievo::InputError>()) {
        complain(&input.to_string());
        return ExitCode::from(2);
    }
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        complain("which command? `relievo --help` lists them");
        return ExitCode::from(2);
    }
    let text = error.to_string();
    let what = text.split("\n\nUsage:").next().unwrap_or_default().split("\n\nFor more").next();
    let what = what.unwrap_or_default().trim_start_matches("error: ").trim_end();
    let what = what.replace("\n\n  tip: ", "; ");
    complain(&format!("{what}; see --help"));
    ExitCode::from(2)
}

/// Prints one line on standard error; ignores it if standard error is closed.
fn complain(text: &str) {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let _ = writeln!(std::io::stderr(), "relievo: {line}");
}

#[cfg(test)]
mod tests {
    use super::{Arguments, has_backend, remedy};
    use clap::CommandFactory as _;
    use relievo::gpu::GpuError;
    use relievo::{Error, InputError};

    #[test]
    fn commands_with_backends_offer_the_cpu_where_the_device_allows_too_little() {
        let parsed =
            |words: &[&str]| has_backend(&Arguments::command().try_get_matches_from(words).expect("valid"));
        assert!(parsed(&["relievo", "relief", "--builtin", "bricks", "--out", "out"]));
        assert!(!parsed(&["relievo", "info"]));
        let (pass, limit, remedy_of_pass) =
            ("terrain/height", "maxStorageBufferBindingSize", "split the batch");
        let limit = GpuError::Limit { pass, limit, needed: 2, available: 1, remedy: remedy_of_pass };
        let limit = Error::Gpu(limit);
        assert_eq!([true, false].map(|has| remedy(&limit, has)), ["; or give --backend cpu", ""]);
        assert_eq!(remedy(&InputError::new("size", 0, "must be at least 1").into(), true), "");
    }
}
