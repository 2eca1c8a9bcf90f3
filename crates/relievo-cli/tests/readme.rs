//! What README.md, CONTRIBUTING.md and docs/*.md say, held against the program: code, names of items, commands and their options,
//! kernels, fields, links, and figures that are the same on every machine. The commands in `--help` are tried as well.

#[path = "readme/blocks.rs"]
mod blocks;
#[path = "program/mod.rs"]
mod harness;
#[path = "readme/names.rs"]
mod names;

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::sync::LazyLock;

use harness::relievo;
use relievo::InputError;
use relievo::gpu::shaders;
use relievo::ops::animation::{bounds, keyframe_cursor, local_to_model, sample};
use relievo::ops::skinning::collapse::{CollapseOptions, KeptBones, collapse_bones};
use relievo::ops::skinning::{morph, morph_weights, palette, skin};
use relievo::ops::surface::{cone_map, tangent};
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::normals;
use relievo_samples::creature;
use relievo_scene_file::SceneFile;

/// The program that README.md shows whole.
const PROGRAM: &str = include_str!("../../../examples/first.rs");

/// The document of callers' kinds and outputs.
const KINDS: &str = "docs/kinds.md";

/// A Markdown file of the repository, and its text.
struct Document {
    path: String,
    text: String,
}

/// README.md, CONTRIBUTING.md and `docs/*.md`, in the order of their paths.
static DOCUMENTS: LazyLock<Vec<Document>> = LazyLock::new(|| {
    let root = relievo_testing::root();
    let names = std::fs::read_dir(root.join("docs")).expect("docs").map(|entry| entry.expect("an entry"));
    let mut paths: Vec<_> = names.map(|entry| format!("docs/{}", entry.file_name().display())).collect();
    // `docs/devices/` has measurements.
    paths.retain(|path| path.ends_with(".md"));
    paths.extend(["README.md", "CONTRIBUTING.md"].map(str::to_owned));
    paths.sort();
    let read = |path: String| Document {
        text: std::fs::read_to_string(root.join(&path)).expect("a document"),
        path,
    };
    paths.into_iter().map(read).collect()
});

impl Document {
    /// Its code blocks, each with its language.
    fn blocks(&self) -> Vec<[&str; 2]> {
        let fenced = self.text.split("\n```").skip(1).step_by(2);
        fenced
            .map(|block| block.split_once('\n').map_or([block, ""], |(language, code)| [language, code]))
            .collect()
    }

    /// Its text without code blocks.
    fn prose(&self) -> String {
        self.text.split("\n```").step_by(2).collect()
    }

    /// The text in `quote`s of its prose.
    fn quoted(&self) -> Vec<String> {
        quoted(&self.prose()).into_iter().map(str::to_owned).collect()
    }

    /// The anchors of its headings.
    fn anchors(&self) -> Vec<String> {
        let prose = self.prose();
        let headings = prose.lines().filter_map(|line| line.strip_prefix('#'));
        let is_kept = |c: &char| c.is_alphanumeric() || *c == '-' || *c == '_';
        let anchor = |line: &str| {
            let words = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
            words.chars().filter(is_kept).collect()
        };
        headings.map(anchor).collect()
    }

    /// The targets of its links inside the repository: the path from the repository's root, and the anchor.
    fn links(&self) -> Vec<(PathBuf, Option<String>)> {
        let prose = self.prose();
        let links = prose.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        let folder = Path::new(&self.path).parent().expect("a folder");
        links
            .filter(|link| !link.starts_with("https://"))
            .map(|link| {
                let (path, anchor) = link.split_once('#').map_or((link, None), |(a, b)| (a, Some(b)));
                let target = if path.is_empty() { PathBuf::from(&self.path) } else { resolved(folder, path) };
                (target, anchor.map(str::to_owned))
            })
            .collect()
    }
}

/// A path relative to a folder, without `..`.
fn resolved(folder: &Path, path: &str) -> PathBuf {
    let mut target = folder.to_owned();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir => assert!(target.pop(), "{path} leads out of the repository"),
            part => target.push(part),
        }
    }
    target
}

/// The text in `quote`s of a piece of Markdown.
fn quoted(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// Whether a document says this.
fn is_said(words: &str) -> bool {
    DOCUMENTS.iter().any(|document| document.text.contains(words))
}

/// The cells of a table's rows, from the row whose first cell is `head` to the table's end. One document has it.
fn table(head: &str) -> Vec<Vec<&'static str>> {
    let cells = |line: &'static str| line.trim_matches('|').split(" | ").map(str::trim).collect::<Vec<_>>();
    let rows = |document: &'static Document| -> Vec<_> {
        (document.text.lines().skip_while(|line| !line.starts_with(head)).skip(2))
            .take_while(|line| line.starts_with('|'))
            .map(cells)
            .collect()
    };
    let mut tables: Vec<_> = DOCUMENTS.iter().map(rows).filter(|rows| !rows.is_empty()).collect();
    assert_eq!(tables.len(), 1, "documents with a table {head}");
    tables.remove(0)
}

/// The lines of all code blocks in `language`, without comments.
fn code(language: &str, comment: &str) -> Vec<&'static str> {
    // Texts of kinds and outputs stand by themselves.
    let documents = DOCUMENTS.iter().filter(|document| document.path != KINDS);
    let blocks = documents.flat_map(Document::blocks).filter(|[other, _]| *other == language);
    blocks
        .flat_map(|[_, code]| code.lines())
        .filter_map(|line| line.split(comment).next())
        .map(str::trim)
        .filter(|line| !line.is_empty())
        .collect()
}

/// Checks that a command exists and has the options that it is shown with.
fn check_command(command: &str) {
    let mut words = command.split_whitespace();
    let name = words.next().unwrap_or_default();
    let help = relievo(&[name, "--help"]);
    assert_eq!(help.code, Some(0), "relievo {command}: {}", help.stderr);
    for option in words.filter(|word| word.starts_with("--")) {
        assert!(
            help.stdout.split_whitespace().any(|word| word.trim_end_matches(',') == option),
            "relievo {command}: no {option}"
        );
    }
}

#[test]
fn every_command_has_the_options_that_it_is_shown_with() {
    let lines = code("sh", "#");
    let makefile = std::fs::read_to_string(relievo_testing::root().join("Makefile")).expect("a Makefile");
    for line in &lines {
        let is_target = |name: &str| makefile.contains(&format!("\n{name}:"));
        let is_known = line.starts_with("relievo ")
            || line.starts_with("cargo ")
            || line.strip_prefix("make ").is_some_and(is_target);
        assert!(is_known, "{line}");
    }
    let commands: BTreeSet<_> = lines.into_iter().filter_map(|line| line.strip_prefix("relievo ")).collect();
    assert!(!commands.is_empty());
    commands.into_iter().for_each(check_command);
    let quoted: BTreeSet<_> = DOCUMENTS.iter().flat_map(Document::quoted).collect();
    quoted.iter().filter_map(|text| text.strip_prefix("relievo ")).for_each(check_command);
}

/// A line of a help text that is a command.
#[test]
fn commands_in_help_texts_exist() {
    let help = relievo(&["--help"]).stdout;
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = listed.take_while(|line| !line.is_empty()).filter(|line| !line.starts_with("   "));
    let mut shown = BTreeSet::new();
    for name in names.filter_map(|line| line.split_whitespace().next()) {
        let help = relievo(&[name, "--help"]).stdout;
        let examples = help.lines().filter_map(|line| line.strip_prefix("relievo "));
        shown.extend(examples.filter(|line| line.starts_with(name)).map(str::to_owned));
    }
    assert!(shown.len() > 5, "{shown:?}");
    shown.iter().for_each(|command| check_command(command));
}

/// Options that stand alone, as in "`--scene` times …", are those of one of these commands or of all.
#[test]
fn options_that_are_named_exist() {
    let commands = ["crowd", "sweep", "scene", "terrain", "simplify", "serve", "fetch"];
    let help: String = commands.map(|name| relievo(&[name, "--help"]).stdout).concat();
    let options: Vec<_> = DOCUMENTS.iter().flat_map(Document::quoted).collect();
    for option in options.iter().filter(|text| text.starts_with("--")) {
        for word in option.split_whitespace().filter(|word| word.starts_with("--")) {
            assert!(help.split_whitespace().any(|other| other == word), "{option}");
        }
    }
}

#[test]
fn the_table_lists_every_kernel_and_drawing_pass() {
    let listed: BTreeSet<_> = table("| | kernel").into_iter().flat_map(|row| quoted(row[1])).collect();
    let all: BTreeSet<_> = shaders::ALL.iter().map(|shader| shader.name).collect();
    assert_eq!(listed, all);
}

#[test]
fn the_configuration_has_the_fields_and_defaults_of_the_table() {
    let json = |more: &str| format!(r#"{{"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"{more}}}"#);
    assert!(is_said(&json("")));
    let plain = TerrainConfig::from_json(&json("")).expect("the configuration of the documents");
    let rows = table("| field | default");
    let named: BTreeSet<_> = rows.iter().map(|row| quoted(row[0])[0]).collect();
    let unknown = |text: &str| TerrainConfig::from_json(&json(text)).expect_err("unknown").to_string();
    let known = unknown(r#", "nothing": 0"#);
    let known: BTreeSet<_> = quoted(&known).into_iter().filter(|name| *name != "nothing").collect();
    let given = BTreeSet::from(["patchSize", "scaleFactor", "seed"]);
    assert_eq!(named, &known - &given);
    for row in &rows {
        let default = match row[1] {
            "(`patchSize` − 1) / 10" => "25.6".to_owned(),
            "four" | "none" => continue,
            default => default.replace('`', ""),
        };
        let name = quoted(row[0])[0];
        let config =
            TerrainConfig::from_json(&json(&format!(", \"{name}\": {default}"))).expect("the default");
        // Not the words, but what they mean.
        let tiles = (config.tiles_per_patch(), TerrainConfig { texture_tile: None, ..config });
        assert_eq!(tiles, (plain.tiles_per_patch(), plain.clone()), "{name}");
    }
    assert_eq!(plain.zones.len(), 4);
}

#[test]
fn the_scene_file_is_one() {
    let blocks = DOCUMENTS.iter().flat_map(Document::blocks).filter(|[language, _]| *language == "json");
    let scenes: Vec<_> = blocks.map(|[_, text]| SceneFile::from_json(text).expect(text)).collect();
    assert!(!scenes.is_empty());
    assert!(scenes.iter().any(|scene| scene.files().len() == 2), "one names two models");
}

#[test]
fn links_lead_somewhere() {
    let root = relievo_testing::root();
    for document in DOCUMENTS.iter() {
        for (target, anchor) in document.links() {
            assert!(root.join(&target).exists(), "{}: {}", document.path, target.display());
            let Some(anchor) = anchor else { continue };
            let found = DOCUMENTS.iter().find(|document| Path::new(&document.path) == target);
            let found = found.unwrap_or_else(|| panic!("{}: #{anchor} of no document", document.path));
            assert!(found.anchors().contains(&anchor), "{}: {}#{anchor}", document.path, found.path);
        }
        let paths = document.quoted().into_iter();
        let is_path = |text: &String| [".rs", ".wgsl", ".py"].iter().any(|end| text.ends_with(end));
        for path in paths.filter(is_path).filter(|path| !path.contains('<')) {
            let is_below = ["", "src/terrain", "src/terrain/height", "wgsl/terrain"]
                .iter()
                .any(|folder| root.join(folder).join(&path).exists());
            assert!(is_below, "{}: {path}", document.path);
        }
    }
    assert!(!document("README.md").links().is_empty());
}

/// A document by its path.
fn document(path: &str) -> &'static Document {
    DOCUMENTS.iter().find(|document| document.path == path).expect("a document")
}

/// A document that nobody finds helps nobody.
#[test]
fn every_document_is_listed() {
    let listed: Vec<_> = document("docs/README.md").links().into_iter().map(|(target, _)| target).collect();
    for Document { path, .. } in DOCUMENTS.iter().filter(|document| document.path.starts_with("docs/")) {
        assert!(path == "docs/README.md" || listed.contains(&PathBuf::from(path)), "{path}");
    }
}

/// A program in `examples/` that nobody finds helps nobody.
#[test]
fn every_example_is_named() {
    let links: Vec<_> = DOCUMENTS.iter().flat_map(Document::links).map(|(target, _)| target).collect();
    let folder = relievo_testing::root().join("examples");
    let mut programs = 0;
    for path in std::fs::read_dir(folder).expect("examples").map(|entry| entry.expect("an entry").path()) {
        if path.extension().is_some_and(|extension| extension == "rs") || path.join("main.rs").exists() {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            let program = Path::new("examples").join(&name);
            assert!(links.iter().any(|target| target.starts_with(&program)), "{name}");
            programs += 1;
        }
    }
    assert!(programs > 1);
}

/// README.md shows a whole program, which `cargo test` compiles.
#[test]
fn the_program_is_the_example() {
    let shown = document("README.md").blocks().into_iter().filter(|[_, code]| code.contains("fn main()"));
    let shown: Vec<_> = shown.collect();
    assert_eq!(shown, [["rust", PROGRAM.trim_end()]], "README.md and examples/first.rs differ");
}

#[test]
fn the_readme_is_short() {
    for (path, most) in [("README.md", 150), ("CONTRIBUTING.md", 120), ("docs/drivers.md", 60)] {
        let lines = document(path).text.lines().count();
        assert!(lines <= most, "{path}: {lines} lines, at most {most}");
    }
}

#[test]
fn every_block_is_in_a_language_that_is_checked() {
    for document in DOCUMENTS.iter() {
        for [language, code] in document.blocks() {
            let is_checked = ["rust", "json", "sh", "wgsl"].contains(&language);
            assert!(is_checked, "{}: ```{language}\n{code}", document.path);
        }
    }
}

#[test]
fn rust_is_compiled_as_it_stands_there() {
    let mut written = Vec::new();
    for document in DOCUMENTS.iter() {
        let rust = document.blocks().into_iter().filter(|[language, _]| *language == "rust");
        let rust = rust.filter(|[_, code]| *code != PROGRAM.trim_end());
        written.extend(rust.map(|[_, code]| format!("{}\n{code}", document.path)));
    }
    let compiled = include_str!("readme/blocks.rs").split("\n    // begin ").skip(1);
    let compiled: Vec<String> = compiled
        .filter_map(|rest| rest.split_once("\n    // end"))
        .map(|(block, _)| block.replace("\n    ", "\n"))
        .collect();
    assert!(!written.is_empty());
    for (written, compiled) in written.iter().zip(&compiled) {
        assert_eq!(written, compiled, "tests/readme/blocks.rs has another text");
    }
    assert_eq!(
        written.len(),
        compiled.len(),
        "blocks without a function in tests/readme/blocks.rs, or the reverse"
    );
}

/// The paths in the prose, such as `Scene::new` or `mesh::simplify`, and names of types, such as `SunShadow`.
fn names_in(prose: &str) -> BTreeSet<String> {
    let is_word =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let is_type = |name: &str| {
        name.starts_with(|c: char| c.is_ascii_uppercase())
            && name.contains(|c: char| c.is_ascii_lowercase())
            && name.chars().filter(char::is_ascii_uppercase).count() > 1
    };
    quoted(prose)
        .into_iter()
        .map(|text| text.trim_end_matches("()"))
        .filter(|text| text.split("::").all(is_word) && (text.contains("::") || is_type(text)))
        .map(str::to_owned)
        .collect()
}

/// Each name that the documents mention is in `tests/readme/names.rs`, which the compiler reads.
#[test]
fn names_in_the_prose_exist() {
    let mentioned: BTreeSet<String> =
        DOCUMENTS.iter().flat_map(|document| names_in(&document.prose())).collect();
    let mut compiled = BTreeSet::new();
    for (code, name) in include_str!("readme/names.rs").lines().filter_map(|line| line.split_once("; // ")) {
        // A field is named after a value of its type.
        let (owner, last) = name.rsplit_once("::").unwrap_or(("", name));
        let is_module = owner.starts_with(|c: char| c.is_ascii_lowercase());
        let of_crate = |name: &&str| code.contains(&format!("{name}::{owner}"));
        let is_named = if is_module {
            ["relievo", "relievo_lab", "relievo_delivery"].iter().any(of_crate)
        } else {
            code.contains(owner)
        };
        assert!(is_named && code.contains(last), "`{code}` is not {name}");
        compiled.insert(name.to_owned());
    }
    assert!(mentioned.len() > 30, "{mentioned:?}");
    assert_eq!(mentioned, compiled, "tests/readme/names.rs has other names than the documents");
}

/// Compiles the WGSL of the documents as a fragment shader after the module, on the device.
#[test]
fn wgsl_is_compiled_as_it_stands_there() {
    let gpu = harness::gpu();
    let module = shaders::MODULES.iter().find(|module| module.name == "surface").expect("a module");
    let source = format!(
        "{}
         @group(0) @binding(0) var heights: texture_2d<f32>;
         @group(0) @binding(1) var pyramid: texture_2d<f32>;
         @group(0) @binding(2) var colors: texture_2d<f32>;
         @group(0) @binding(3) var filtering: sampler;
         @fragment
         fn fragment(@location(0) uv: vec2<f32>, @location(1) to_eye: vec3<f32>) -> @location(0) vec4<f32> {{
             let scale = 0.08;
             let march = SurfaceMarch(SURFACE_WRAP, 1u, 1u, 8u, 0u);
             let uv_dx = dpdx(uv);
             let uv_dy = dpdy(uv);
             {}
             return albedo;
         }}",
        module.source,
        code("wgsl", "//").join("\n")
    );
    let scope = gpu.device().push_error_scope(wgpu::ErrorFilter::Validation);
    let source = wgpu::ShaderSource::Wgsl(source.into());
    let _ =
        gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("documents"), source });
    let error = pollster::block_on(scope.pop());
    assert!(error.is_none(), "{error:?}");
}

/// The texts of a kind and of an output are what the library takes.
#[test]
fn kinds_and_outputs_are_valid_as_they_stand_there() {
    let texts: Vec<_> =
        document(KINDS).blocks().into_iter().filter(|[language, _]| *language == "wgsl").collect();
    let [[_, kind], [_, output]] = texts[..] else { panic!("{} texts", texts.len()) };
    relievo::scene::kind::KindProgram::new("card", kind).expect("a kind");
    assert_eq!(relievo::render::OutputProgram::new("uv", output).expect("an output").colors(), 1);
}

#[test]
fn bounds_of_the_table_are_those_that_parity_holds() {
    let bounds = [
        ("terrain/normals", normals::NORMAL_BOUND),
        ("surface/tangent", tangent::TANGENT_BOUND),
        ("surface/cone_map", cone_map::RADIUS_BOUND),
        ("animation/keyframe_cursor", keyframe_cursor::KEYFRAME_CURSOR_BOUND),
        ("animation/sample", sample::SAMPLE_BOUND),
        ("animation/sample", sample::LAYER_GROWTH),
        ("animation/local_to_model", local_to_model::LOCAL_TO_MODEL_BOUND),
        ("animation/bounds", bounds::BOUNDS_BOUND),
        ("skinning/palette", palette::PALETTE_BOUND),
        ("skinning/morph_weights", morph_weights::MORPH_WEIGHTS_BOUND),
        ("skinning/morph", morph::MORPH_BOUND),
        ("skinning/skin", skin::SKIN_BOUND),
    ];
    let rows = table("| | kernel");
    for (stem, bound) in bounds {
        let row = rows.iter().find(|row| quoted(row[1]).contains(&stem)).expect(stem);
        let text = if bound < 1.0 { format!("{bound:e}") } else { bound.to_string() };
        assert!(row[3].split([' ', ',', ';']).any(|word| word == text), "{stem}: {text}, not {}", row[3]);
    }
}

#[test]
fn the_oldest_rust_is_that_of_the_manifest() {
    assert!(
        document("README.md").text.contains(&format!("Rust {} or newer", env!("CARGO_PKG_RUST_VERSION")))
    );
}

#[test]
fn batches_are_split_where_it_says() {
    let patches = Fields::most(&harness::gpu(), 257);
    assert!(is_said(&format!("128 MiB ({patches} patches of 257²)")), "{patches}");
}

/// 8112 as 8,112.
fn thousands(number: usize) -> String {
    if number < 1000 { number.to_string() } else { format!("{},{:03}", number / 1000, number % 1000) }
}

#[test]
fn the_creature_has_as_many_bones_vertices_and_triangles() {
    let model = creature().expect("built in");
    let vertices: usize = model.meshes.iter().map(|mesh| mesh.vertices()).sum();
    let figures = format!("{} bones, {} vertices each", model.skeleton.len(), thousands(vertices));
    assert!(is_said(&figures), "{figures}");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().to_str().expect("UTF-8");
    for millimetres in [15, 29] {
        let within = format!("0.0{millimetres}");
        let common = ["skin", "--model", "builtin", "--clip", "walk", "--time", "0.3", "--out", out];
        let run = relievo(&[&common[..], &["--within", &within]].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let words: Vec<_> = run.stdout.split_whitespace().collect();
        let of = words.iter().position(|word| *word == "of").expect("triangles of all");
        let [left, all] = [words[of - 1], words[of + 1]].map(|word| word.parse::<usize>().expect("a number"));
        for figures in
            [format!("all {} triangles", thousands(all)), format!("{} within {millimetres}", thousands(left))]
        {
            assert!(is_said(&figures), "{figures}: {}", run.stdout);
        }
    }
}

/// Bones that a clip does not move are no part of what gates save.
#[test]
fn the_creature_moves_as_many_bones_in_its_walk() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().to_str().expect("UTF-8");
    let run = relievo(&[
        "crowd",
        "--model",
        "builtin",
        "--clip",
        "walk",
        "--gate",
        "off",
        "--instances",
        "1",
        "--frames",
        "1",
        "--distance",
        "400",
        "--backend",
        "cpu",
        "--out",
        out,
    ]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let report = std::fs::read(folder.path().join("report.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
    let figures =
        format!("{} of the creature's {} bones in its walk", report["animated_bones"], report["bones"]);
    assert!(is_said(&figures), "{figures}");
}

#[test]
fn the_creature_does_with_80_bones() -> Result<(), InputError> {
    let model = creature()?;
    let collapsed = collapse_bones(&model, &CollapseOptions::new(KeptBones::Count(80)))?;
    let [all, left] = [&model, &collapsed.model].map(|model| model.skeleton.len());
    println!("{all} to {left} bones: {:?}", collapsed.error);
    assert!(is_said(&format!("{all} to {left} for less than 2 cm")));
    assert!(collapsed.error.largest < 0.02, "{:?}", collapsed.error);
    Ok(())
}
