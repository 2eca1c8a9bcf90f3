//! Compiles programs for browsers: with the suite's own Rust where it has the target `wasm32-unknown-unknown`,
//! and otherwise with Debian's Rust for browsers, which compiles the standard library too.

use std::path::{Path, PathBuf};
use std::process::Command;

use wasm_bindgen_cli_support::Bindgen;

const TARGET: &str = "wasm32-unknown-unknown";

/// The profile of a page that is served, which has to be small.
pub const SMALL: &str = "web";

/// The profile of a program that is run once, without optimisation.
pub const QUICK: &str = "browser";

/// What compiles for browsers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Toolchain {
    /// The suite's own cargo and rustc.
    Own,
    /// Debian's `rustc-web`, `cargo-web` and `rust-web-src` below a folder, and a linker for WebAssembly.
    Debian {
        /// The folder of `cargo` and `rustc`.
        folder: PathBuf,
        /// The linker.
        linker: PathBuf,
    },
}

impl Toolchain {
    /// The toolchain of the suite. A missing one is a failure, with advice on what to do.
    pub fn find() -> Result<Self, String> {
        let sysroot = Command::new("rustc").args(["--print", "sysroot"]).output();
        let own = sysroot.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
        Self::among(Path::new(&own.unwrap_or_default()), Path::new("/usr"))
    }

    /// [`Toolchain::find`] for the folders of the suite's Rust and of Debian's.
    pub fn among(own: &Path, debian: &Path) -> Result<Self, String> {
        if own.join("lib/rustlib").join(TARGET).is_dir() {
            return Ok(Self::Own);
        }
        let bin = debian.join("bin");
        let has_rust = ["bin/cargo", "bin/rustc", "lib/rustlib/src/rust/library/std/Cargo.toml"]
            .iter()
            .all(|file| debian.join(file).is_file());
        // The newest: an older one may not read what rustc writes.
        let linker =
            (10..100).rev().map(|version| bin.join(format!("wasm-ld-{version}"))).find(|path| path.is_file());
        match linker.filter(|_| has_rust) {
            Some(linker) => Ok(Self::Debian { folder: bin, linker }),
            None => Err(format!(
                "no Rust for {TARGET}: run `rustup target add {TARGET}` or `scripts/setup.sh browser` \
                 (Debian: apt-get install rustc-web cargo-web rust-web-src lld-22)"
            )),
        }
    }

    fn cargo(&self) -> Command {
        let mut command = match self {
            Self::Own => Command::new(env!("CARGO")),
            Self::Debian { folder, linker } => {
                let mut command = Command::new(folder.join("cargo"));
                command
                    .env("RUSTC", folder.join("rustc"))
                    // `-Zbuild-std` is not for stable compilers otherwise.
                    .env("RUSTC_BOOTSTRAP", "1")
                    .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", linker)
                    .env_remove("RUSTUP_TOOLCHAIN");
                command
            }
        };
        // What is meant for the suite's own build.
        for variable in ["LD_LIBRARY_PATH", "RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_TARGET"] {
            command.env_remove(variable);
        }
        command
    }
}

/// A library that is compiled for browsers.
#[derive(Debug, Clone, Copy)]
pub struct Program<'a> {
    /// The package in the workspace.
    pub package: &'a str,
    /// The name of its library, and of the files that are written: `NAME_bg.wasm` and `NAME.js`.
    pub library: &'a str,
    /// The profile of cargo.
    pub profile: &'a str,
    /// The folder of everything that cargo compiles.
    pub target: &'a Path,
}

impl Program<'_> {
    /// Compiles the program, and writes its WebAssembly and its JavaScript into a folder.
    ///
    /// # Errors
    /// Without a toolchain, or if something does not compile: why.
    pub fn build(&self, out: &Path) -> Result<(), String> {
        let Self { package, library, profile, target } = *self;
        let toolchain = Toolchain::find()?;
        let mut cargo = toolchain.cargo();
        cargo
            .current_dir(crate::root())
            .args(["build", "--locked", "--package", package, "--profile", profile])
            .args(["--target", TARGET, "--target-dir"])
            .arg(target);
        if toolchain != Toolchain::Own {
            cargo.arg("-Zbuild-std=std,panic_abort");
            if profile == SMALL {
                // A panic ends the program at once, without a message, and the `Debug` of a struct is its name: the code for
                // both is a tenth of the program.
                cargo.arg("-Zbuild-std-features=optimize_for_size");
                cargo.env(
                    "RUSTFLAGS",
                    "-Zunstable-options -Cpanic=immediate-abort -Zfmt-debug=shallow -Zlocation-detail=none",
                );
            }
        }
        let output = cargo.output().map_err(|error| format!("{cargo:?}: {error}"))?;
        if !output.status.success() {
            return Err(format!("{cargo:?}:\n{}", String::from_utf8_lossy(&output.stderr)));
        }
        let folder = if profile == "dev" { "debug" } else { profile };
        let compiled = target.join(TARGET).join(folder).join(format!("{library}.wasm"));
        let mut bindgen = Bindgen::new();
        let result = bindgen.input_path(compiled).web(true).and_then(|bindgen| {
            bindgen.typescript(false).remove_name_section(profile != "dev").generate_output()
        });
        let text = |error| format!("{error:#}");
        let mut bound = result.map_err(text)?;
        let mut names = Vec::new();
        if profile == SMALL {
            for import in bound.wasm_mut().imports.iter_mut() {
                let short = format!("_{:x}", names.len());
                names.push((std::mem::replace(&mut import.name, short.clone()), short));
            }
        }
        bound.emit(out).map_err(text)?;
        match profile {
            SMALL => shrink(&out.join(format!("{library}.js")), &names),
            _ => Ok(()),
        }
    }
}

/// Gives the functions of a script, which a program imports, other names, and leaves out lines of comments and indentation. The names of
/// wasm-bindgen have hashes, which are a part of the program's size.
fn shrink(script: &Path, names: &[(String, String)]) -> Result<(), String> {
    let text = |error: std::io::Error| format!("{}: {error}", script.display());
    let mut code = std::fs::read_to_string(script).map_err(text)?;
    for (name, short) in names {
        let key = format!(" {name}: ");
        if code.matches(&key).count() != 1 {
            return Err(format!("{}: {name} must be there once", script.display()));
        }
        code = code.replace(&key, &format!(" {short}: "));
    }
    let is_code = |line: &&str| {
        !line.is_empty() && !["//", "/**", "* ", "*/"].iter().any(|start| line.starts_with(start))
    };
    let lines: Vec<&str> = code.lines().map(str::trim).filter(is_code).collect();
    std::fs::write(script, lines.join("\n") + "\n").map_err(text)
}

/// The largest size of the page's WebAssembly and JavaScript together, with brotli, in bytes.
pub const LARGEST: usize = 1_500_000;

/// Number of bytes that are left by brotli at its best.
///
/// # Errors
/// None for bytes in memory, but the library may have one.
pub fn packed(bytes: &[u8]) -> std::io::Result<usize> {
    let mut packed = Vec::new();
    let options = brotli::enc::BrotliEncoderParams { quality: 11, lgwin: 22, ..Default::default() };
    brotli::BrotliCompress(&mut &bytes[..], &mut packed, &options)?;
    Ok(packed.len())
}
