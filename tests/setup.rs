//! `scripts/setup.sh` with everything around it faked: it says the one command to run, or is silent.
#![cfg(target_os = "linux")]

use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::{Command, Output};

/// Runs the script for a user who is not root and whose programs are those in `fakes`, as shell scripts.
fn setup(arguments: &[&str], fakes: &[(&str, &str)], environment: &[(&str, &str)]) -> Output {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for tool in ["uname", "grep", "ldconfig"] {
        let found = ["/usr/bin", "/bin", "/usr/sbin", "/sbin"]
            .map(|place| Path::new(place).join(tool))
            .into_iter()
            .find(|path| path.exists());
        symlink(found.expect("every Linux has it"), folder.path().join(tool)).expect("writable");
    }
    for (name, script) in [("id", "echo 1000")].iter().chain(fakes) {
        let path = folder.path().join(name);
        let _ = std::fs::remove_file(&path);
        std::fs::write(&path, format!("#!/bin/bash\n{script}\n")).expect("writable");
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).expect("writable");
    }
    Command::new("/bin/bash")
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/setup.sh"))
        .args(arguments)
        .env_clear()
        .env("PATH", folder.path())
        .envs(environment.iter().copied())
        .output()
        .expect("bash starts")
}

/// A `rustc` that knows browsers: its folder, which must be kept, and the script.
fn browsers_rustc() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = folder.path().join("lib/rustlib/wasm32-unknown-unknown");
    std::fs::create_dir_all(target).expect("writable");
    let script = format!("echo {}", folder.path().display());
    (folder, script)
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn what_is_missing_is_named_with_the_command_that_gets_it() {
    let output = setup(&[], &[("cargo", "")], &[]);
    assert_eq!(output.status.code(), Some(1));
    let text = stderr(&output);
    assert!(text.contains("g++") && text.contains("sudo apt-get update && sudo apt-get install"), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(stderr(&setup(&[], &[("c++", "")], &[])).contains("cargo is missing"));
}

/// The suite alone needs it: neither `make demo` nor `make lint` does.
#[test]
fn a_browser_is_missing_for_the_tests_alone() {
    let (_folder, rustc) = browsers_rustc();
    let tools = [("cargo", ""), ("c++", ""), ("Xvfb", ""), ("rustc", rustc.as_str())];
    let output = setup(&["browser"], &tools, &[]);
    assert_eq!(output.status.code(), Some(1));
    let text = stderr(&output);
    assert!(text.contains("sudo apt-get install chromium"), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
    let is_silent =
        |output: &Output| output.status.success() && output.stderr.is_empty() && output.stdout.is_empty();
    assert!(is_silent(&setup(&[], &tools, &[])));
    assert!(is_silent(&setup(&["browser"], &tools, &[("RELIEVO_CHROMIUM", "/opt/chrome")])));
    for name in ["chromium", "google-chrome"] {
        assert!(
            is_silent(&setup(&["browser"], &[tools[0], tools[1], tools[2], tools[3], (name, "")], &[])),
            "{name}"
        );
    }
    // No display for windows.
    let output = setup(&["browser"], &[tools[0], tools[1], tools[3], ("chromium", "")], &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("sudo apt-get install xvfb"), "{}", stderr(&output));
}

/// Without `rustc` and a linker for WebAssembly on the search path, and with a `rustc` that lacks the target.
#[test]
fn rust_for_browsers_is_missing_for_the_tests_alone() {
    let (folder, _) = browsers_rustc();
    let other = format!("echo {}", folder.path().join("lib").display());
    let tools = [("cargo", ""), ("c++", ""), ("chromium", ""), ("Xvfb", ""), ("rustc", other.as_str())];
    for tools in [&tools[..4], &tools[..]] {
        let output = setup(&["browser"], tools, &[]);
        assert_eq!(output.status.code(), Some(1));
        let text = stderr(&output);
        assert!(text.contains("sudo apt-get install rustc-web cargo-web rust-web-src lld-22"), "{text}");
        assert_eq!(text.lines().count(), 1, "{text}");
    }
    assert!(setup(&[], &tools, &[]).status.success());
    // Where Debian's packages do not exist, the remedy is rustup's.
    let output = setup(&["browser"], &[tools[0], ("uname", "echo Darwin")], &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("rustup target add wasm32-unknown-unknown"), "{}", stderr(&output));
}

/// Root gets it installed: from the lists that are there, or else from new ones.
#[test]
fn root_gets_the_browser_installed() {
    let (_folder, rustc) = browsers_rustc();
    let root = [("cargo", ""), ("c++", ""), ("id", "echo 0"), ("Xvfb", ""), ("rustc", rustc.as_str())];
    let asked = tempfile::NamedTempFile::new().expect("a temporary file");
    let apt = |exit: &str| format!("echo \"$@\" >> {}; {exit}", asked.path().display());
    for (exit, expected) in [
        ("exit 0", &["install -y --no-install-recommends chromium"][..]),
        (
            // Unknown until the lists are new.
            "[ $1 = update ] || grep -q update \"$MARKS\"",
            &[
                "install -y --no-install-recommends chromium",
                "update",
                "install -y --no-install-recommends chromium",
            ],
        ),
    ] {
        std::fs::write(asked.path(), "").expect("writable");
        let script = apt(exit);
        let fakes = [root[0], root[1], root[2], root[3], root[4], ("apt-get", script.as_str())];
        let marks = asked.path().to_str().expect("UTF-8");
        let output = setup(&["browser"], &fakes, &[("MARKS", marks)]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let text = std::fs::read_to_string(asked.path()).expect("readable");
        assert_eq!(text.lines().collect::<Vec<_>>(), expected);
    }
}

#[test]
fn a_driver_without_a_working_adapter_is_missing() {
    let broken = [("cargo", "[ \"$1\" = build ]"), ("c++", "")];
    let output = setup(&["adapter"], &broken, &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("apt-get install mesa-vulkan-drivers"), "{}", stderr(&output));
    let works = setup(&["adapter"], &[("cargo", ""), ("c++", "")], &[("VK_DRIVER_FILES", "chosen.json")]);
    assert_eq!(works.status.code(), Some(0), "{}", stderr(&works));
    assert!(works.stderr.is_empty() && works.stdout.is_empty());
}
