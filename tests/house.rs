//! The structure of the sources: which folder may use which, an operation's files, and no circle. Reads the
//! sources as text.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The folders and files below `src/`, lowest floor first; those of one floor do not use each other.
const FLOORS: &[&[&str]] = &[
    &["error", "hash", "shared", "srgb"],
    &["asset", "files", "gpu", "plot"],
    &["harness", "mesh"],
    &["animation", "surface", "terrain"],
    &["baseline", "skinning"],
    &["lod"],
    &["render"],
    &["samples"],
    &["bench", "measure", "verify"],
];

/// A source file: its path below `src/`, and its text without comments and tests.
struct Source {
    path: String,
    text: String,
}

impl Source {
    fn new(path: &str, text: &str) -> Self {
        let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
        let text = text.split("#[cfg(all(test, ").next().unwrap_or_default();
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

    /// Parity cases and benchmarks may use what lies above them: samples.
    fn is_case(&self) -> bool {
        self.module().iter().skip(1).any(|name| ["verify", "bench"].contains(name))
    }

    /// The modules and items of this crate that the source names by written-out paths.
    fn paths(&self) -> Vec<Vec<String>> {
        let mut found = Vec::new();
        for start in ["crate::", "super::"] {
            for (at, _) in self.text.match_indices(start) {
                let is_inside =
                    self.text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
                if !is_inside {
                    found.extend(self.resolved(&self.text[at..]));
                }
            }
        }
        found
    }

    /// The paths at the beginning of a text: `crate::a::{b, c}` has two.
    fn resolved(&self, text: &str) -> Vec<Vec<String>> {
        let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')).unwrap_or(text.len());
        let names: Vec<&str> = text[..end].split("::").filter(|name| !name.is_empty()).collect();
        let up = names.iter().take_while(|name| **name == "super").count();
        let module = self.module();
        let mut path: Vec<String> = if up > 0 { &module[..module.len().saturating_sub(up)] } else { &[] }
            .iter()
            .map(|name| (*name).to_owned())
            .collect();
        path.extend(names.iter().skip(up.max(1)).map(|name| (*name).to_owned()));
        let Some(list) = text[end..].strip_prefix('{') else { return vec![path] };
        let inside = list.split('}').next().unwrap_or_default();
        let words =
            inside.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|word| !word.is_empty());
        words.map(|word| path.iter().cloned().chain([word.to_owned()]).collect()).collect()
    }
}

/// Every source file below `src/` except those of the program.
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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    walk(&root, &mut files);
    files.sort();
    let relative = |file: &PathBuf| file.strip_prefix(&root).expect("below it").display().to_string();
    let read = |file: &PathBuf| Source::new(&relative(file), &std::fs::read_to_string(file).expect("text"));
    files
        .iter()
        .filter(|file| !relative(file).starts_with("bin/") && relative(file) != "lib.rs")
        .map(read)
        .collect()
}

fn floor(name: &str) -> Option<usize> {
    FLOORS.iter().position(|floor| floor.contains(&name))
}

/// The uses of folders that do not lie below the user's.
fn arrows_upward(sources: &[Source]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for source in sources.iter().filter(|source| !source.is_case()) {
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

/// What a domain's `mod.rs` exports: the path that users write, and the module that it comes from.
fn exports(sources: &[Source]) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for source in sources.iter().filter(|source| source.path.ends_with("/mod.rs")) {
        let module = source.module().join("::");
        for (at, _) in source.text.match_indices("pub use ") {
            let rest = &source.text[at + "pub use ".len()..];
            let statement = rest.split(';').next().unwrap_or_default();
            let Some((child, items)) = statement.split_once("::") else { continue };
            let items =
                items.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|item| !item.is_empty());
            for item in items {
                found.insert(format!("{module}::{item}"), format!("{module}::{child}"));
            }
        }
    }
    found
}

/// Which rooms use which: a room is an operation's folder, or a file beside such folders.
fn rooms(sources: &[Source]) -> BTreeMap<String, BTreeSet<String>> {
    let modules: BTreeSet<String> = sources.iter().map(|source| source.module().join("::")).collect();
    let exports = exports(sources);
    let room = |module: &str| module.split("::").take(2).collect::<Vec<_>>().join("/");
    let mut rooms: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for source in sources.iter().filter(|source| !source.is_case() && source.module().len() > 1) {
        let own = room(&source.module().join("::"));
        for path in source.paths() {
            let known = (1..=path.len()).rev().map(|length| path[..length].join("::")).find_map(|path| {
                exports.get(&path).cloned().or_else(|| modules.contains(&path).then_some(path))
            });
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
        Source::new("terrain/height/verify.rs", "use crate::samples::creature;\n"),
        Source::new("skinning/pose.rs", "use crate::animation::Frame; // crate::render::no\n"),
        Source::new("mesh/mod.rs", "#[cfg(test)]\nmod tests { use crate::samples::creature; }\n"),
    ];
    let found: Vec<String> = arrows_upward(&planted).into_iter().collect();
    let expected = [
        "asset/mesh.rs uses skinning::skin::Vertex",
        "attic is on no floor",
        "gpu/buffer.rs uses animation",
        "terrain/height/pass.rs uses surface::map::f",
    ];
    assert_eq!(found, expected);
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

/// The files that make an operation, below its folder.
const FILES: [&str; 4] = ["mod", "reference", "verify", "bench"];

/// What an operation lacks. A pass of few lines may stand in `mod.rs`.
fn lacking(operation: &str) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(operation);
    let exists = |name: &str| {
        [format!("{name}.rs"), format!("{name}/mod.rs")].iter().any(|file| root.join(file).exists())
    };
    FILES.into_iter().filter(|name| !exists(name)).map(|name| format!("{operation}/{name}.rs")).collect()
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
fn every_kernel_has_a_folder_with_all_its_files() {
    let kernels = kernels();
    assert!(!kernels.is_empty());
    for kernel in kernels {
        assert_eq!(lacking(&kernel), Vec::<String>::new());
    }
    assert_eq!(lacking("terrain/nothing").len(), FILES.len());
}
