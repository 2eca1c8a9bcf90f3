//! The structure of the sources: which folder may use which, an operation's files, and no circle. Reads the
//! sources as text.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The folders with the library's sources. They are read as one tree, because the library re-exports the modules of
/// `relievo-asset`: paths to them begin with `crate` in both.
const ROOTS: [&str; 2] = ["crates/relievo-asset/src", "src"];

/// The folders and files below the roots, lowest floor first; those of one floor do not use each other.
const FLOORS: &[&[&str]] = &[
    &["error", "hash", "ops", "parallel", "shared", "srgb"],
    &["asset", "gpu"],
    &["mesh"],
    &["animation", "surface", "terrain"],
    &["built_ins", "skinning"],
    &["lod"],
    &["scene"],
    &["render"],
];

/// A source file: its path below its root, and its text without comments and tests.
struct Source {
    path: String,
    text: String,
}

impl Source {
    fn new(path: &str, text: &str) -> Self {
        let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
        let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
        Self { path: path.to_owned(), text: lines.collect::<Vec<_>>().join("\n") }
    }

    /// The module path of a file: `a`, `b` and `c` for `a/b/c.rs` and `a/b/c/mod.rs`.
    fn module(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.path.trim_end_matches(".rs").split('/').collect();
        if names.last() == Some(&"mod") {
            names.pop();
        }
        names
    }

    /// Unit tests may use what lies above them: samples.
    fn is_test(&self) -> bool {
        self.module().iter().skip(1).any(|name| *name == "tests")
    }

    /// Whether the file is an operation's CPU reference, or a part of one.
    fn is_reference(&self) -> bool {
        self.module().iter().skip(2).any(|name| *name == "reference")
    }

    /// The modules and items of this crate that the source names by written-out paths.
    fn paths(&self) -> Vec<Vec<String>> {
        let mut found = Vec::new();
        let mut rest = 0;
        while let Some(at) =
            ["crate::", "super::"].iter().filter_map(|start| self.text[rest..].find(start)).min()
        {
            let at = rest + at;
            let is_inside = self.text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
            let mut leaves = Vec::new();
            let read = use_tree(&self.text[at..], &[], &mut leaves);
            if !is_inside {
                found.extend(leaves.iter().map(|leaf| self.absolute(&leaf.path)));
            }
            rest = at + read;
        }
        found
    }

    /// A path from the crate's root for one that starts with `crate`, `super`, `self` or a child of this module.
    fn absolute(&self, path: &[String]) -> Vec<String> {
        let module = self.module();
        let up = path.iter().take_while(|name| *name == "super").count();
        let prefix = match path.first().map(String::as_str) {
            Some("crate") => 0,
            _ => module.len().saturating_sub(up),
        };
        let names = path.iter().filter(|name| !["crate", "super", "self"].contains(&name.as_str()));
        module[..prefix].iter().map(|name| (*name).to_owned()).chain(names.cloned()).collect()
    }

    /// What `use` lines bring into this module: the path that other modules can write, and the item's own.
    fn imports(&self) -> Vec<(String, String)> {
        let mut leaves = Vec::new();
        for (at, _) in self.text.match_indices("use ") {
            if self.text[..at]
                .lines()
                .next_back()
                .is_none_or(|line| ["", "pub ", "pub(crate) "].contains(&line))
            {
                use_tree(&self.text[at + "use ".len()..], &[], &mut leaves);
            }
        }
        let module = self.module().join("::");
        let named = |leaf: Leaf| (format!("{module}::{}", leaf.name), self.absolute(&leaf.path).join("::"));
        leaves.into_iter().map(named).collect()
    }
}

/// An item that a `use` names: its path, and the name that it gets.
struct Leaf {
    path: Vec<String>,
    name: String,
}

/// Reads a path or a tree of paths, such as `a::{b::{c, d as e}, self}`, from the beginning of a text; appends an
/// item for each of its ends. Returns how many bytes it read.
fn use_tree(text: &str, prefix: &[String], found: &mut Vec<Leaf>) -> usize {
    let spaces = |at: usize| at + text[at..].len() - text[at..].trim_start().len();
    let word = |at: usize| {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        &text[at..at + text[at..].find(|c: char| !is_part(c)).unwrap_or(text[at..].len())]
    };
    let mut path = prefix.to_vec();
    let mut at = spaces(0);
    loop {
        if text[at..].starts_with('{') {
            at = spaces(at + 1);
            while at < text.len() && !text[at..].starts_with('}') {
                // What is neither a path nor a comma is no `use`: the text is skipped a character at a time.
                let read = use_tree(&text[at..], &path, found);
                at = spaces(at + read);
                let other = text[at..].chars().next().filter(|c| *c == ',' || (read == 0 && *c != '}'));
                at = spaces(at + other.map_or(0, char::len_utf8));
            }
            return (at + 1).min(text.len());
        }
        let name = word(at);
        if name.is_empty() {
            if text[at..].starts_with('*') {
                found.push(Leaf { path, name: "*".to_owned() });
                return at + 1;
            }
            break;
        }
        at += name.len();
        if name != "self" || path.is_empty() {
            path.push(name.to_owned());
        }
        let Some(rest) = text[spaces(at)..].strip_prefix("::") else { break };
        at = spaces(text.len() - rest.len());
    }
    if path.len() > prefix.len() || at > 0 {
        let renamed = text[spaces(at)..].strip_prefix("as ").map(|rest| text.len() - rest.len());
        let name = renamed.map(|start| word(start).to_owned()).or_else(|| path.last().cloned());
        at = renamed.map_or(at, |start| start + word(start).len());
        found.extend(name.map(|name| Leaf { path, name }));
    }
    at
}

/// Every source file below the roots except `lib.rs`.
fn sources() -> Vec<Source> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).expect("a readable folder") {
            let path = entry.expect("a readable folder").path();
            if path.is_dir() {
                walk(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    let of_root = |root: &str| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(root);
        let mut files = Vec::new();
        walk(&root, &mut files);
        files.sort();
        let relative = |file: &PathBuf| file.strip_prefix(&root).expect("below it").display().to_string();
        let read =
            |file: &PathBuf| Source::new(&relative(file), &std::fs::read_to_string(file).expect("text"));
        files.iter().filter(|file| relative(file) != "lib.rs").map(read).collect::<Vec<_>>()
    };
    ROOTS.iter().flat_map(|root| of_root(root)).collect()
}

fn floor(name: &str) -> Option<usize> {
    FLOORS.iter().position(|floor| floor.contains(&name))
}

/// The uses of folders that do not lie below the user's.
fn arrows_upward(sources: &[Source]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for source in sources.iter().filter(|source| !source.is_test()) {
        let own = source.module()[0].to_owned();
        let Some(here) = floor(&own) else {
            found.insert(format!("{own} is on no floor"));
            continue;
        };
        for path in source.paths() {
            let Some(there) = path.first().and_then(|name| floor(name)) else { continue };
            if path[0] != own && there >= here {
                found.insert(format!("{} uses {}", source.path, path.join("::")));
            }
        }
    }
    found
}

/// What modules import: the path that others can write, and the path of the item itself. A module's own path
/// names the module, also where an item with the same name is imported.
fn imports(sources: &[Source]) -> BTreeMap<String, String> {
    let modules = modules(sources);
    let all = sources.iter().flat_map(Source::imports);
    all.filter(|(path, item)| path != item && !modules.contains(path)).collect()
}

fn modules(sources: &[Source]) -> BTreeSet<String> {
    sources.iter().map(|source| source.module().join("::")).collect()
}

/// Where the item of a path is declared: follows imports, eight of them at most.
fn origin(path: &[String], imports: &BTreeMap<String, String>) -> Vec<String> {
    let mut path = path.to_vec();
    for _ in 0..8 {
        let Some((length, item)) = (1..=path.len())
            .rev()
            .find_map(|length| Some((length, imports.get(&path[..length].join("::"))?)))
        else {
            break;
        };
        path = item.split("::").map(str::to_owned).chain(path[length..].iter().cloned()).collect();
    }
    path
}

/// Which rooms use which: a room is an operation's folder, or a file beside such folders.
fn rooms(sources: &[Source]) -> BTreeMap<String, BTreeSet<String>> {
    let (modules, imports) = (modules(sources), imports(sources));
    let room = |module: &str| module.split("::").take(2).collect::<Vec<_>>().join("/");
    let mut rooms: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for source in sources.iter().filter(|source| !source.is_test() && source.module().len() > 1) {
        let own = room(&source.module().join("::"));
        for path in source.paths() {
            let path = origin(&path, &imports);
            let known = (1..=path.len())
                .rev()
                .map(|length| path[..length].join("::"))
                .find(|path| modules.contains(path));
            let other = known.map(|known| room(&known)).filter(|other| other.contains('/') && *other != own);
            rooms.entry(own.clone()).or_default().extend(other);
        }
    }
    rooms
}

/// The rooms that can be reached from themselves, each with the way back to it.
fn circles(rooms: &BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    let way_back = |start: &String| {
        let mut ways: Vec<Vec<&String>> = rooms[start].iter().map(|next| vec![next]).collect();
        let mut seen = BTreeSet::new();
        while let Some(way) = ways.pop() {
            let last = way[way.len() - 1];
            if last == start {
                let names: Vec<&str> = way.iter().map(|name| name.as_str()).collect();
                return Some(format!("{start} → {}", names.join(" → ")));
            }
            if seen.insert(last) {
                let next = rooms.get(last).into_iter().flatten();
                ways.extend(next.map(|next| way.iter().copied().chain([next]).collect()));
            }
        }
        None
    };
    rooms.keys().filter_map(way_back).collect()
}

#[test]
fn no_arrow_goes_upward() {
    assert_eq!(arrows_upward(&sources()), BTreeSet::new());
}

#[test]
fn a_planted_arrow_is_found() {
    let planted = [
        Source::new("asset/mesh.rs", "use crate::skinning::skin::Vertex;\n"),
        Source::new("terrain/height/pass.rs", "fn f() { crate::surface::map::f() }\n"),
        Source::new("gpu/buffer.rs", "use super::super::{animation::Crowd, error};\n"),
        Source::new("attic/mod.rs", ""),
        // These uses are allowed.
        Source::new("terrain/height/tests.rs", "use crate::samples::creature;\n"),
        Source::new("skinning/pose.rs", "use crate::animation::Frame; // crate::render::no\n"),
        Source::new("mesh/mod.rs", "#[cfg(test)]\nmod tests { use crate::samples::creature; }\n"),
    ];
    let found: Vec<String> = arrows_upward(&planted).into_iter().collect();
    let expected = [
        "asset/mesh.rs uses skinning::skin::Vertex",
        "attic is on no floor",
        "gpu/buffer.rs uses animation::Crowd",
        "terrain/height/pass.rs uses surface::map::f",
    ];
    assert_eq!(found, expected);
}

/// The sources that name `relievo_asset` itself, except the one that re-exports its modules. The other tests do not see such
/// paths.
fn ways_around(sources: &[Source]) -> Vec<&str> {
    let names_it = |source: &&Source| source.path != "ops.rs" && source.text.contains("relievo_asset");
    sources.iter().filter(names_it).map(|source| source.path.as_str()).collect()
}

#[test]
fn modules_of_the_asset_crate_are_used_as_the_librarys_own() {
    assert_eq!(ways_around(&sources()), Vec::<&str>::new());
}

#[test]
fn a_planted_way_around_is_found() {
    let planted = [
        Source::new("gpu/buffer.rs", "use relievo_asset::asset::Mesh;\n"),
        // These are allowed.
        Source::new("gpu/bind.rs", "// As in relievo_asset.\nuse crate::error::Error;\n"),
        Source::new("ops.rs", "pub use relievo_asset::{hash, mesh};\n"),
    ];
    assert_eq!(ways_around(&planted), ["gpu/buffer.rs"]);
}

#[test]
fn no_room_can_be_reached_from_itself() {
    assert_eq!(circles(&rooms(&sources())), Vec::<String>::new());
}

#[test]
fn a_planted_circle_is_found() {
    let planted = [
        Source::new("animation/mod.rs", "pub use gate::{Gate, Frame};\n"),
        Source::new("animation/gate/mod.rs", "mod pass;\n"),
        Source::new("animation/gate/pass.rs", "use crate::animation::compact::{Active, Lists};\n"),
        Source::new("animation/compact/mod.rs", "use super::super::animation::Frame;\n"),
        Source::new("animation/lod.rs", "use super::gate::Gate;\n"),
    ];
    let found = circles(&rooms(&planted));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("animation/compact → ") && found[1].starts_with("animation/gate → "));
}

#[test]
fn nested_lists_of_uses_are_read() {
    let text = "use crate::{\n    asset::{mesh::{Mesh, Skin as S}, clip::Clip},\n    hash::{self, *},\n};\n\
        pub(super) fn f(a: super::TerrainConfig) -> u32 { crate::hash::<u32>(a) as u32 }\n";
    let paths: Vec<String> =
        Source::new("terrain/pad/mod.rs", text).paths().iter().map(|path| path.join("::")).collect();
    let expected = [
        "asset::mesh::Mesh",
        "asset::mesh::Skin",
        "asset::clip::Clip",
        "hash",
        "hash",
        "terrain::TerrainConfig",
        "hash",
    ];
    assert_eq!(paths, expected);
    let planted =
        [Source::new("gpu/buffer.rs", "use crate::{hash::{a, b}, animation::{crowd::Crowd, pose}};\n")];
    let found: Vec<String> = arrows_upward(&planted).into_iter().collect();
    assert_eq!(found, ["gpu/buffer.rs uses animation::crowd::Crowd", "gpu/buffer.rs uses animation::pose"]);
}

/// The uses of passes by CPU references, which must also be there where no GPU is.
fn references_that_use_a_pass(sources: &[Source]) -> Vec<String> {
    let imports = imports(sources);
    let mut found = Vec::new();
    for source in sources.iter().filter(|source| source.is_reference()) {
        let items = source.paths().into_iter().map(|path| origin(&path, &imports));
        let of_passes = items.filter(|item| item.iter().any(|name| name == "pass"));
        found.extend(of_passes.map(|item| format!("{} uses {}", source.path, item.join("::"))));
    }
    found
}

/// The parameters that are tuples taken apart. Closures may have some.
fn tuple_parameters(sources: &[Source]) -> Vec<String> {
    let takes_apart = |line: &&str| {
        let is_other = line.contains('|') || line.trim_start().starts_with("let ");
        !is_other && line.contains("): (")
    };
    let of = |source: &Source| {
        let lines = source.text.lines().filter(takes_apart);
        lines.map(|line| format!("{}: {}", source.path, line.trim())).collect::<Vec<_>>()
    };
    sources.iter().flat_map(of).collect()
}

#[test]
fn no_function_takes_a_tuple_apart() {
    assert_eq!(tuple_parameters(&sources()), Vec::<String>::new());
}

#[test]
fn planted_tuple_parameters_are_found() {
    let planted = "fn one((a, b): (u32, bool)) {}\nfn two(\n    (a, b): (u32, bool),\n) {\n    \
                   let (a, b): (u32, bool) = c;\n    c.map(|(a, b): (u32, bool)| a);\n}\n";
    let expected = ["a.rs: fn one((a, b): (u32, bool)) {}", "a.rs: (a, b): (u32, bool),"];
    assert_eq!(tuple_parameters(&[Source::new("a.rs", planted)]), expected);
}

#[test]
fn no_reference_uses_a_pass() {
    assert_eq!(references_that_use_a_pass(&sources()), Vec::<String>::new());
}

#[test]
fn a_planted_reference_that_uses_a_pass_is_found() {
    let planted = [
        Source::new("terrain/mod.rs", "pub use pad::{PadPass as Pad, surrounds};\n"),
        Source::new(
            "terrain/pad/mod.rs",
            "mod pass;\npub(crate) use pass::PadPass;\npub fn surrounds() {}\n",
        ),
        Source::new("terrain/pad/pass.rs", "pub struct PadPass;\n"),
        Source::new("terrain/pad/reference.rs", "use super::PadPass;\n"),
        Source::new("terrain/wrap/reference/mod.rs", "use crate::terrain::{Pad, surrounds};\n"),
        Source::new("terrain/blend/reference.rs", "fn f() { super::pass::count() }\n"),
        // This use is allowed.
        Source::new("terrain/pad/job.rs", "use super::pass::PadPass;\n"),
    ];
    let expected = [
        "terrain/pad/reference.rs uses terrain::pad::pass::PadPass",
        "terrain/wrap/reference/mod.rs uses terrain::pad::pass::PadPass",
        "terrain/blend/reference.rs uses terrain::blend::pass::count",
    ];
    assert_eq!(references_that_use_a_pass(&planted), expected);
}

/// The files that make an operation, below its folder.
const FILES: [&str; 3] = ["mod", "reference", "pass"];

/// The folders that have some of these files and no kernel, each with the reason.
const WITHOUT_A_KERNEL: [(&str, &str); 1] =
    [("animation/frame", "records the passes of other operations one after another")];

/// Kernels that only the laboratory runs, each with its folder in `crates/relievo-lab/src`.
const OF_THE_LABORATORY: [(&str, &str); 6] = [
    ("baseline/copy", "baseline/copy"),
    ("baseline/gather", "baseline/gather"),
    ("baseline/loads", "baseline/loads"),
    ("baseline/texels", "baseline/texels"),
    ("baseline/words", "baseline/words"),
    ("surface/shade", "shade"),
];

/// What is wrong with the folders of operations, given the files below `src/` and the kernels' paths below
/// `kernels/` without extension: a kernel without a folder, a folder that lacks a file, a folder without a
/// kernel, and an exception that is none.
fn misplaced(files: &[&str], kernels: &[String], exceptions: &[&str]) -> BTreeSet<String> {
    let is_there = |operation: &str, name: &str| {
        [format!("{operation}/{name}.rs"), format!("{operation}/{name}/mod.rs")]
            .iter()
            .any(|file| files.contains(&file.as_str()))
    };
    let mut found = BTreeSet::new();
    for kernel in kernels {
        if !files.iter().any(|file| file.starts_with(&format!("{kernel}/"))) {
            found.insert(format!("kernels/{kernel}.wgsl has no folder src/{kernel}"));
            continue;
        }
        let lacking = FILES.iter().filter(|name| !is_there(kernel, name));
        found.extend(lacking.map(|name| format!("src/{kernel} has no {name}.rs")));
    }
    let folders: BTreeSet<String> =
        files.iter().map(|file| file.split('/').take(2).collect::<Vec<_>>().join("/")).collect();
    for folder in folders {
        let is_operation = FILES[1..].iter().any(|name| is_there(&folder, name));
        let (has_kernel, is_named) = (kernels.contains(&folder), exceptions.contains(&folder.as_str()));
        if is_operation && !has_kernel && !is_named {
            found.insert(format!("src/{folder} has no kernels/{folder}.wgsl"));
        }
        if is_named && (has_kernel || !is_operation) {
            found.insert(format!("src/{folder} is no exception"));
        }
    }
    let is_gone = |named: &&&str| !files.iter().any(|file| file.starts_with(&format!("{named}/")));
    found.extend(exceptions.iter().filter(is_gone).map(|named| format!("src/{named} is gone")));
    found
}

/// The kernels' paths below `kernels/`, without extension.
fn kernels() -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("kernels");
    let mut found = Vec::new();
    for domain in std::fs::read_dir(root).expect("kernels").map(|entry| entry.expect("an entry").path()) {
        for file in std::fs::read_dir(&domain).expect("a domain").map(|entry| entry.expect("an entry").path())
        {
            let name = |path: &Path| path.file_stem().expect("a name").to_string_lossy().into_owned();
            found.push(format!("{}/{}", name(&domain), name(&file)));
        }
    }
    found
}

#[test]
fn every_kernel_has_a_folder_with_all_its_files_and_every_folder_a_kernel() {
    let (sources, mut kernels) = (sources(), kernels());
    let laboratory = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/relievo-lab/src");
    for (kernel, folder) in OF_THE_LABORATORY {
        assert!(kernels.iter().any(|name| name == kernel), "{kernel} is no kernel");
        for file in FILES {
            assert!(
                laboratory.join(folder).join(file).with_extension("rs").is_file(),
                "{folder} lacks {file}.rs"
            );
        }
    }
    kernels.retain(|name| OF_THE_LABORATORY.iter().all(|(kernel, _)| name != kernel));
    assert!(!kernels.is_empty());
    let files: Vec<&str> = sources.iter().map(|source| source.path.as_str()).collect();
    let exceptions = WITHOUT_A_KERNEL.map(|(folder, _)| folder);
    assert_eq!(misplaced(&files, &kernels, &exceptions), BTreeSet::new());
}

#[test]
fn planted_folders_and_kernels_are_found() {
    let complete = |folder: &str| FILES.map(|name| format!("{folder}/{name}.rs")).to_vec();
    let mut files = complete("terrain/pad");
    // This folder has no pass. Its reference is a folder of its own, which is allowed.
    files.extend(complete("terrain/wrap").into_iter().filter(|file| !file.ends_with("/pass.rs")));
    files.retain(|file| file != "terrain/wrap/reference.rs");
    files.extend(["terrain/wrap/reference/mod.rs", "terrain/config/json.rs"].map(str::to_owned));
    // These have no kernel.
    files.extend(
        ["terrain/erode/mod.rs", "terrain/erode/pass.rs", "animation/frame/pass.rs"].map(str::to_owned),
    );
    // The files of a domain are no operations.
    files.extend(
        ["animation/edges/mod.rs", "animation/edges/times.rs", "animation/crowd.rs"].map(str::to_owned),
    );
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let kernels = ["terrain/pad", "terrain/wrap", "terrain/nothing"].map(str::to_owned);
    let found =
        misplaced(&files, &kernels, &["animation/frame", "terrain/pad", "terrain/config", "terrain/old"]);
    let expected = [
        "kernels/terrain/nothing.wgsl has no folder src/terrain/nothing",
        "src/terrain/config is no exception",
        "src/terrain/erode has no kernels/terrain/erode.wgsl",
        "src/terrain/old is gone",
        "src/terrain/pad is no exception",
        "src/terrain/wrap has no pass.rs",
    ];
    assert_eq!(found.iter().map(String::as_str).collect::<Vec<_>>(), expected);
}

/// The units that a command of cargo compiles, each with a hash of all that it depends on.
fn units(arguments: &[&str]) -> BTreeMap<u64, String> {
    let output = std::process::Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(arguments)
        .args(["--unit-graph", "-Z", "unstable-options", "--offline"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("RUSTC_BOOTSTRAP", "1")
        .output()
        .expect("cargo starts");
    let graph: serde_json::Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&output.stderr)));
    let all = graph["units"].as_array().expect("units");
    let mut hashes = vec![None; all.len()];
    (0..all.len())
        .map(|at| (hash_of(all, at, &mut hashes), format!("{} {}", all[at]["pkg_id"], all[at]["features"])))
        .collect()
}

fn hash_of(all: &[serde_json::Value], at: usize, hashes: &mut [Option<u64>]) -> u64 {
    use std::hash::{DefaultHasher, Hash as _, Hasher as _};
    if let Some(hash) = hashes[at] {
        return hash;
    }
    let unit = &all[at];
    let needed = unit["dependencies"].as_array().expect("a list");
    let mut needed: Vec<u64> = needed
        .iter()
        .map(|needed| hash_of(all, needed["index"].as_u64().expect("a number") as usize, hashes))
        .collect();
    needed.sort_unstable();
    let mut hasher = DefaultHasher::new();
    let profile =
        ["opt_level", "debuginfo", "debug_assertions", "overflow_checks"].map(|key| &unit["profile"][key]);
    let own = ["pkg_id", "target", "platform", "mode", "features"].map(|key| &unit[key]);
    (format!("{profile:?} {own:?}"), needed).hash(&mut hasher);
    *hashes[at].insert(hasher.finish())
}

/// A crate of the tests that wants another feature of something below wgpu would have wgpu and the library compiled twice.
#[test]
fn the_program_and_the_tests_share_one_build() {
    let tests = units(&["test", "--no-run"]);
    let program = units(&["build", "--bin", "relievo"]);
    let twice: Vec<_> =
        program.iter().filter(|(hash, _)| !tests.contains_key(hash)).map(|(_, unit)| unit).collect();
    assert!(program.len() > 100 && twice.is_empty(), "see crates/relievo-cli/Cargo.toml: {twice:#?}");
    // The program of `make demo`, which is compiled for itself.
    let demo = units(&["build", "--bin", "relievo", "--no-default-features"]);
    let twice: Vec<_> =
        demo.iter().filter(|(hash, _)| !tests.contains_key(hash)).map(|(_, unit)| unit).collect();
    assert!(
        twice.iter().all(|unit| unit.contains("relievo-cli")) && demo.len() < program.len(),
        "{twice:#?}"
    );
}
