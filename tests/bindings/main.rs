//! What generated bindings refuse: a buffer that is forgotten, and one of another element type, do not compile.
//!
//! The bindings are private, so they are compiled here as a crate of their own: the files in `generated/` and
//! `src/gpu/bind.rs`, with empty types in place of the device's and of wgpu's, glam's and bytemuck's. And what they check on a device:
//! lengths, and the widths of packed words.

use std::path::{Path, PathBuf};
use std::process::Command;

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::lod::sorted::{SortedBuffers, SortedPass};
use relievo::shared::lod::object::{
    decision_level, decision_next, decision_steps, decision_word, list_entry_instance, list_entry_steps,
    list_entry_word,
};

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
    for (name, source) in [("glam", &*vectors()), ("wgpu", RESOURCES), ("bytemuck", "pub trait Pod {}")] {
        compile(folder.path(), name, source, &[]).expect("a stand-in compiles");
    }
    let source =
        std::fs::read_to_string(PathBuf::from(ROOT).join("tests/bindings/scratch.rs.in")).expect("there");
    let source = source
        .replace("<OUT_DIR>", &OUT_DIR.replace('\\', "/"))
        .replace("<ROOT>", &ROOT.replace('\\', "/"))
        .replace("<SHADERS>", &shaders())
        .replace("<GROUP>", group);
    compile(folder.path(), "scratch", &source, &["glam", "wgpu", "bytemuck"])
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
        std::fs::read_to_string(Path::new(OUT_DIR).join("bindings.rs")).expect("copied by build.rs");
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

/// Every buffer of a pass that states its lengths is refused by its name when it is one element short.
#[test]
fn short_buffers_are_refused_by_name() {
    let gpu = relievo_testing::gpu();
    let pass = SortedPass::new(&gpu).expect("compiled");
    for (short, lens) in [("sorted", [2, 3, 3]), ("draws", [3, 2, 3]), ("entries", [3, 3, 2])] {
        let [sorted, draws, entries] = lens;
        let buffers = SortedBuffers {
            sorted: &Buffer::new(&gpu, "sorted", sorted).expect("allocated"),
            decisions: &Buffer::new(&gpu, "decisions", 1).expect("allocated"),
            arguments: &Buffer::new(&gpu, "arguments", 1).expect("allocated"),
            draws: &Buffer::new(&gpu, "draws", draws).expect("allocated"),
            entries: &Buffer::new(&gpu, "entries", entries).expect("allocated"),
            objects: &Buffer::new(&gpu, "objects", 1).expect("allocated"),
        };
        pass.prepare(&gpu, buffers, 2).expect("long enough");
        let Err(Error::Input(error)) = pass.prepare(&gpu, buffers, 3) else { panic!("{short} was accepted") };
        let said = (&*error.path, &*error.value, &*error.bound);
        assert_eq!(said, (short, "[2 elements]", "must hold at least 3"));
    }
}

#[test]
fn packed_words_give_back_their_fields() {
    let word = decision_word(1, 0, 7, 2, 511);
    assert_eq!((word, decision_level(word)), (0x1ff5d, 7));
    assert_eq!((decision_next(word), decision_steps(word)), (2, 511));
    // The last field has the highest bit.
    assert_eq!(list_entry_word(0xf_ffff, 7, 0x1ff), u32::MAX);
    assert_eq!((list_entry_instance(u32::MAX), list_entry_steps(u32::MAX)), (0xf_ffff, 0x1ff));
}

#[test]
#[should_panic(
    expected = "a value exceeds its bits: Decision: seen 1, mirrored 1, level 3, next 3, steps 16"
)]
fn a_value_beyond_its_field_is_refused() {
    decision_word(1, 0, 8, 0, 0);
}
