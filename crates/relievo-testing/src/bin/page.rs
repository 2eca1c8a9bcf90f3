//! Builds the page with the viewer (`make web`).
//!
//! `wasm-opt` is not used: that of Debian 12 breaks the tables that wasm-bindgen writes, and saves 1 % with brotli.
//!
//! `page OUT`: OUT is the folder of the page, beside which it is compiled (`OUT.build`). The sizes of its files are printed, as they are and with brotli.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use relievo_testing::wasm::{LARGEST, Program, SMALL, packed};

/// The files of the page.
const FILES: [&str; 4] = ["index.html", "viewer.js", "viewer_bg.wasm", "creature.rlv"];

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let out = PathBuf::from(arguments.next().unwrap_or_else(|| "target/page".to_owned()));
    match build(&out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("page: {why}");
            ExitCode::FAILURE
        }
    }
}

/// Builds the page into a folder.
fn build(out: &Path) -> Result<(), String> {
    let text = |error: std::io::Error| format!("{}: {error}", out.display());
    std::fs::create_dir_all(out).map_err(text)?;
    let target = out.with_extension("build");
    let program = Program {
        package: "relievo-page",
        library: "viewer",
        profile: SMALL,
        target: &std::path::absolute(&target).map_err(text)?,
    };
    program.build(out)?;
    let page = relievo_testing::root().join("crates/relievo-viewer/web/index.html");
    std::fs::copy(&page, out.join("index.html")).map_err(text)?;
    std::fs::write(out.join("creature.rlv"), creature()?).map_err(text)?;
    let mut program = 0;
    for name in FILES {
        let bytes = std::fs::read(out.join(name)).map_err(text)?;
        let packed = packed(&bytes).map_err(text)?;
        println!("{name}: {} bytes, {packed} with brotli", bytes.len());
        if name.starts_with("viewer") {
            program += packed;
        }
    }
    let verdict = if program > LARGEST { "more than" } else { "of" };
    println!(
        "WebAssembly and JavaScript: {program} bytes with brotli, {verdict} the {LARGEST} that `make test-page` allows"
    );
    Ok(())
}

/// The built-in creature as a package.
fn creature() -> Result<Vec<u8>, String> {
    let model = relievo_samples::creature().map_err(|error| error.to_string())?;
    let watch = &mut |_| std::ops::ControlFlow::Continue(());
    let package = relievo::ops::skinning::cook(&model.into(), watch).map_err(|error| error.to_string())?;
    package.ok_or_else(|| "broken off".to_owned())
}
