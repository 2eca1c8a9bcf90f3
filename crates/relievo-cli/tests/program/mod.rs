//! The program, run as a user runs it, beside the helpers of all tests.
#![allow(dead_code, unused_imports, reason = "each test program uses its own part")]

pub use relievo_testing::*;

/// A run of the program.
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// Runs the program as a user does.
pub fn relievo(arguments: &[&str]) -> Run {
    relievo_with(arguments, &[])
}

/// [`relievo`] with environment variables.
pub fn relievo_with(arguments: &[&str], environment: &[(&str, &str)]) -> Run {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_relievo"))
        .args(arguments)
        .envs(environment.iter().copied())
        .output()
        .expect("the program starts");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Run { code: output.status.code(), stdout: text(&output.stdout), stderr: text(&output.stderr) }
}
