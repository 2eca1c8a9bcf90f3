//! Compiles `relievo-web-scene` for browsers: with the suite's own Rust where it has the target `wasm32-unknown-unknown`,
//! and otherwise with Debian's Rust for browsers, which compiles the standard library too.

use std::path::{Path, PathBuf};
use std::process::Command;

use wasm_bindgen_cli_support::Bindgen;

const TARGET: &str = "wasm32-unknown-unknown";

/// What compiles for browsers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Toolchain {
    /// The suite's own cargo and rustc.
    Own,
    /// Debian's `rustc-web`, `cargo-web` and `rust-web-src` below a folder, and a linker for WebAssembly.
    Debian { folder: PathBuf, linker: PathBuf },
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

/// Compiles the scene, and returns the folder of its WebAssembly and JavaScript: `scene_bg.wasm` and `scene.js`.
pub fn scene(out: &Path) -> Result<(), String> {
    let toolchain = Toolchain::find()?;
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("web");
    let mut cargo = toolchain.cargo();
    cargo
        .current_dir(relievo_testing::root())
        .args(["build", "--locked", "--package", "relievo-web-scene", "--target", TARGET, "--target-dir"])
        .arg(&target);
    if toolchain != Toolchain::Own {
        cargo.arg("-Zbuild-std=std,panic_abort");
    }
    let output = cargo.output().map_err(|error| format!("{cargo:?}: {error}"))?;
    if !output.status.success() {
        return Err(format!("{cargo:?}:\n{}", String::from_utf8_lossy(&output.stderr)));
    }
    let compiled = target.join(TARGET).join("debug/scene.wasm");
    let mut bindgen = Bindgen::new();
    let result =
        bindgen.input_path(compiled).web(true).and_then(|bindgen| bindgen.typescript(false).generate(out));
    result.map_err(|error| format!("{error:#}"))
}

#[test]
fn without_a_toolchain_the_remedy_is_named_in_one_line() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (own, debian) = (folder.path().join("own"), folder.path().join("debian"));
    let file = |path: &str| {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writable");
        std::fs::write(path, "").expect("writable");
    };
    let fails = || {
        let error = Toolchain::among(&own, &debian).expect_err("there is none");
        assert!(
            error.contains("rustup target add") && error.contains("apt-get install rustc-web"),
            "{error}"
        );
        assert_eq!(error.lines().count(), 1);
    };
    fails();
    file("debian/bin/cargo");
    file("debian/bin/rustc");
    file("debian/lib/rustlib/src/rust/library/std/Cargo.toml");
    // Every part is needed.
    fails();
    file("debian/bin/wasm-ld-14");
    file("debian/bin/wasm-ld-22");
    let linker = debian.join("bin/wasm-ld-22");
    let expected = Toolchain::Debian { folder: debian.join("bin"), linker };
    assert_eq!(Toolchain::among(&own, &debian), Ok(expected));
    file("own/lib/rustlib/wasm32-unknown-unknown/lib/libstd.rlib");
    assert_eq!(Toolchain::among(&own, &debian), Ok(Toolchain::Own));
}
