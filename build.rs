//! Refuses generated shaders (`generated/`) that are older than their sources, and copies them to `OUT_DIR`. `relievo-shaders`
//! generates them.

use std::path::PathBuf;

mod build {
    pub mod digest;
}

fn main() -> std::io::Result<()> {
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let out = PathBuf::from(std::env::var("OUT_DIR").expect("cargo sets it"));
    for input in ["kernels", "wgsl", "generated", "build", "build.rs"] {
        println!("cargo::rerun-if-changed={input}");
    }
    let generated = root.join("generated");
    let digest = build::digest::digest(&root)?;
    if !std::fs::read_to_string(generated.join("digest.txt")).is_ok_and(|known| known.trim() == digest.trim())
    {
        eprintln!("kernels/ or wgsl/ has changed: run `make shaders`, which writes generated/");
        std::process::exit(1);
    }
    for entry in std::fs::read_dir(generated)? {
        let path = entry?.path();
        let text = std::fs::read_to_string(&path)?;
        let name = path.file_name().expect("a file").to_string_lossy();
        // Modules and the core are text to which others add.
        let is_shader = name.ends_with(".wgsl") && !name.starts_with("module_") && name != "scene_core.wgsl";
        std::fs::write(out.join(&*name), if is_shader { compact(&text) } else { text })?;
    }
    Ok(())
}

/// The text of a shader. In a program for browsers that is optimised for size, it has no comments, and no spaces and lines that mean
/// nothing.
fn compact(text: &str) -> String {
    let is = |name: &str, wanted: &str| std::env::var(name).is_ok_and(|value| value == wanted);
    if !is("CARGO_CFG_TARGET_ARCH", "wasm32") || !is("OPT_LEVEL", "z") {
        return text.to_owned();
    }
    let is_code = |line: &&str| !line.trim_start().starts_with("//");
    let words = text.lines().filter(is_code).flat_map(str::split_whitespace);
    let mut small = String::with_capacity(text.len());
    for word in words {
        let needs_space = !small.ends_with(BREAKS) && !word.starts_with(BREAKS) && !small.is_empty();
        small += if needs_space { " " } else { "" };
        small += word;
    }
    assert!(!small.contains("//"), "a comment behind code would hide all that follows");
    small
}

/// Signs beside which a shader needs no space.
const BREAKS: [char; 7] = ['{', '}', '(', ')', ';', ',', ':'];
