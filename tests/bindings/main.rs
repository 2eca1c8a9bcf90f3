//! What generated bindings refuse: a buffer that is forgotten, and one of another element type, do not compile.
//!
//! The bindings are private, so they are compiled here as a crate of their own: the files that `build.rs` wrote and
//! `src/gpu/bind.rs`, with empty types in place of the device's and of wgpu's and glam's.

use std::path::{Path, PathBuf};
use std::process::Command;

const OUT_DIR: &str = env!("OUT_DIR");
const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// A bind group that compiles.
const RIGHT: &str = "Group { march, heights, acceleration, rays: rays.slice(), hits: hits.slice() }";

/// Compiles a source as a library that uses others; an error is the compiler's message.
fn compile(folder: &Path, name: &str, source: &str, others: &[&str]) -> Result<(), String> {
    let file = folder.join(format!("{name}.rs"));
    std::fs::write(&file, source).expect("written");
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let output = Command::new(compiler)
        .args(["--edition", "2024", "--crate-type", "lib", "--emit", "metadata", "--cap-lints", "allow"])
        .args(["--crate-name", name, "-L"])
        .arg(folder)
        .arg("--out-dir")
        .arg(folder)
        .arg(&file)
        .args(others.iter().flat_map(|other| ["--extern", other]))
        .output()
        .expect("a compiler");
    if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&output.stderr).into_owned()) }
}

/// Compiles a bind group of `surface/relief`, in a folder of its own.
fn bound(group: &str) -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, source) in [("glam", &*vectors()), ("wgpu", RESOURCES)] {
        compile(folder.path(), name, source, &[]).expect("a stand-in compiles");
    }
    let source =
        std::fs::read_to_string(PathBuf::from(ROOT).join("tests/bindings/scratch.rs.in")).expect("there");
    let source = source
        .replace("<OUT_DIR>", &OUT_DIR.replace('\\', "/"))
        .replace("<ROOT>", &ROOT.replace('\\', "/"))
        .replace("<SHADERS>", &shaders())
        .replace("<GROUP>", group);
    compile(folder.path(), "scratch", &source, &["glam", "wgpu"])
}

/// Stubs of wgpu's types.
const RESOURCES: &str = "
    #[derive(Debug)] pub struct Buffer;
    #[derive(Debug)] pub struct TextureView;
    #[derive(Debug)] pub struct Sampler;
    pub enum BindingResource<'a> { Buffer(&'a Buffer), TextureView(&'a TextureView), Sampler(&'a Sampler) }
    impl Buffer {
        pub fn as_entire_binding(&self) -> BindingResource<'_> { BindingResource::Buffer(self) }
    }
";

/// Stubs of glam's types.
fn vectors() -> String {
    let of = |name: &str| format!("#[derive(Debug, Clone, Copy, PartialEq)] pub struct {name};\n");
    ["Vec", "IVec", "UVec"]
        .iter()
        .flat_map(|vector| (2..=4).map(move |size| format!("{vector}{size}")))
        .chain(["Mat4".to_owned()])
        .map(|name| of(&name))
        .collect()
}

/// The names of shaders that the bindings mention.
fn shaders() -> String {
    let bindings =
        std::fs::read_to_string(Path::new(OUT_DIR).join("bindings.rs")).expect("written by build.rs");
    let mut names: Vec<&str> = bindings
        .split("shaders::")
        .skip(1)
        .filter_map(|rest| rest.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next())
        .collect();
    names.sort_unstable();
    names.dedup();
    assert!(names.contains(&"SURFACE_RELIEF"), "{names:?}");
    names.iter().map(|name| format!("pub static {name}: Shader = Shader;\n")).collect()
}

#[test]
fn a_group_with_every_resource_of_its_type_compiles() {
    assert_eq!(bound(RIGHT), Ok(()));
}

#[test]
fn a_forgotten_buffer_does_not_compile() {
    let said = bound(&RIGHT.replace(", hits: hits.slice()", "")).expect_err("refused");
    assert!(said.contains("error[E0063]") && said.contains("missing field `hits`"), "{said}");
    assert_eq!(said.matches("error[").count(), 1, "{said}");
}

#[test]
fn a_buffer_of_another_element_type_does_not_compile() {
    let said = bound(&RIGHT.replace("hits: hits", "hits: rays")).expect_err("refused");
    assert!(said.contains("error[E0308]") && said.contains("Slice<'_, SurfaceHit>"), "{said}");
    assert_eq!(said.matches("error[").count(), 1, "{said}");
}

#[test]
fn a_sampler_in_place_of_a_texture_does_not_compile() {
    let said = bound(&RIGHT.replace("heights,", "heights: sampler,")).expect_err("refused");
    assert!(said.contains("error[E0308]") && said.contains("TextureView"), "{said}");
    assert_eq!(said.matches("error[").count(), 1, "{said}");
}

#[test]
fn a_cast_to_elements_that_the_bytes_are_not_does_not_compile() {
    let said = bound(&RIGHT.replace("hits: hits.slice()", "hits: rays.slice().cast()")).expect_err("refused");
    assert!(said.contains("error[E0277]") && said.contains("`SurfaceRay: SeenAs<"), "{said}");
    assert_eq!(said.matches("error[").count(), 1, "{said}");
}
