//! Composes and describes shaders.

use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use naga::common::wgsl::TypeContext as _;
use naga::{AddressSpace, Binding, Expression, Literal, ShaderStage, StorageAccess, TypeInner};
use wgsl_parse::SyntaxNode as _;

use crate::bindings::Bindings;
use crate::digest::{digest, shader_files};
use crate::entries::{KindText, OutputText, composed, entries, exports};
use crate::{modules, packed, prefix};

/// The generated files: name and text. `root` is the folder of `kernels/` and `wgsl/`. An unknown import, an unused binding or an
/// invalid shader ends the program with file and line.
pub fn generated(root: &Path) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    let core = flatten(root, &root.join(CORE), Keep::All, wesl::ManglerKind::None);
    let mut bindings = Bindings::default();
    let mut manifest = String::new();
    let mut all = Vec::new();
    for (folder, prefix) in [("kernels", ""), ("wgsl/render", "render/")] {
        for file in shader_files(&root.join(folder)) {
            if folder != "kernels" && !is_kind(&file) {
                continue;
            }
            let stem = file.strip_prefix(root.join(folder)).expect("found below it").with_extension("");
            let name = format!("{prefix}{}", stem.display());
            let shader = Shader::compose(root, &file, name, Keep::Entries);
            let path = format!("{}.wgsl", shader.constant().to_lowercase());
            bindings.add(root, &file, &shader);
            let shader = shader.published(root, &file);
            shader.describe(&mut manifest, &core, &path);
            files.insert(path, shader.flat.clone());
            all.push(shader);
        }
    }
    files.extend(bindings.texts());
    add_core(root, &core, &mut files, &mut manifest);
    refuse_unused_module_bindings(root, &all);
    add_modules(root, &mut files, &mut manifest);
    let list = all.iter().map(|shader| format!("&{}", shader.constant())).collect::<Vec<_>>().join(", ");
    writeln!(manifest, "/// Every shader of the crate.\npub static ALL: &[&Shader] = &[{list}];")
        .expect("a string");
    files.insert("shaders.rs".to_owned(), manifest);
    files.insert("digest.txt".to_owned(), digest(root).expect("readable"));
    files
}

/// Rust text that includes a generated shader.
fn included(path: &str) -> String {
    format!("include_str!(concat!(env!(\"OUT_DIR\"), \"/{path}\"))")
}

/// Path of a generated module, the scene core. It imports everything that the shader of a caller's kind of object needs.
const CORE: &str = "wgsl/render/scene_core.wgsl";

/// Adds the scene core to `texts`: what callers' kinds of objects stand beside at run time. Validates it with a minimal kind.
fn add_core(root: &Path, core: &str, texts: &mut BTreeMap<String, String>, manifest: &mut String) {
    let files = output_files(root);
    let (outputs, _) = outputs(&files, root, true);
    let outputs: Vec<_> = outputs.iter().map(|output| (&*output.name, output.moves)).collect();
    let file = root.join(CORE);
    let kind = KindText { name: "least", blends: true, deep: true, moves: false };
    let entries = composed(&kind, core, &outputs);
    let least = "fn least_place(entry: u32, vertex: u32) -> relievo_SceneVertex {
    return relievo_scene_placed(entry, vec3<f32>(), vec3<f32>(), vec4<f32>(), vec4<f32>());
}
fn least_surface(in: relievo_SceneFragment) -> Surface { return relievo_scene_surface(in); }
";
    Shader::validated(root, &file, "render/scene_core".to_owned(), format!("{least}\n{entries}"));
    let path = "scene_core.wgsl";
    texts.insert(path.to_owned(), core.to_owned());
    let text = included(path);
    writeln!(
        manifest,
        "/// What the texts of kinds stand beside, without entry points; its names have no prefix yet.\n\
             pub static SCENE_CORE: &str = {text};\n\
             /// The outputs in it: name, and whether it needs motion.\n\
             pub static SCENE_OUTPUTS: &[(&str, bool)] = &{outputs:?};"
    )
    .expect("a string");
}

/// Adds the modules for shaders outside the crate to `files`. A module is the file `module.wgsl` of a folder, with all of its imports.
fn add_modules(root: &Path, files: &mut BTreeMap<String, String>, manifest: &mut String) {
    let mut all = Vec::new();
    for file in shader_files(&root.join("wgsl")) {
        if file.file_stem().is_none_or(|stem| stem != "module") {
            continue;
        }
        let folder = file.parent().and_then(|folder| folder.file_name()).expect("below wgsl/");
        let name = folder.to_string_lossy().into_owned();
        // This composition is only a check: WESL reports imports that do not exist.
        Shader::compose(root, &file, name.clone(), Keep::All);
        let source = modules::joined(root, &file);
        let module = Shader::validated(root, &file, name.clone(), source);
        if let Some(what) = modules::unfit(&module.module) {
            refuse(file.strip_prefix(root).unwrap_or(&file), &what);
        }
        let path = format!("module_{name}.wgsl");
        all.push(format!("Module {{ name: {name:?}, source: {} }}", included(&path)));
        files.insert(path, module.flat);
    }
    writeln!(
        manifest,
        "/// Every module for others' shaders.\npub static MODULES: &[Module] = &[{}];",
        all.join(", ")
    )
    .expect("a string");
}

/// Whether a WGSL file declares a kind of object. The entry points of such a file are generated.
pub fn is_kind(file: &Path) -> bool {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    KindText::declared(&text).unwrap_or_else(|why| refuse(file, &why)).is_some()
}

/// The WGSL files that declare outputs, each with its text.
pub fn output_files(root: &Path) -> Vec<(PathBuf, String)> {
    let files = shader_files(&root.join("wgsl/render")).into_iter();
    let read = |file: PathBuf| (file.clone(), std::fs::read_to_string(file).unwrap_or_default());
    files.map(read).filter(|(_, text)| text.contains("\n// output ")).collect()
}

/// The outputs that all files declare, and the import lines that the outputs' entry points need. Without `blends`, the output
/// `transparent` is left out.
fn outputs(files: &[(PathBuf, String)], root: &Path, blends: bool) -> (Vec<OutputText>, String) {
    let (mut all, mut imports) = (Vec::new(), String::new());
    for (file, text) in files {
        let relative = file.strip_prefix(root).expect("below the root");
        let outputs = OutputText::declared(text).unwrap_or_else(|why| refuse(relative, &why));
        for output in outputs.into_iter().filter(|output| blends || output.name != "transparent") {
            let (targets, name) = (output.targets(), &output.name);
            writeln!(imports, "import {}::{{{targets}, {name}_write}};", module_path(relative))
                .expect("a string");
            all.push(output);
        }
    }
    (all, imports)
}

/// WGSL text with the generated entry points of a kind, and the imports that these entry points need.
fn kind_root(root: &Path, relative: &Path, kind: &KindText<'_>) -> String {
    let files = output_files(root);
    let (outputs, imports) = outputs(&files, root, kind.blends);
    let mut text = String::from(
        "import package::wgsl::render::scene_fade::{is_left_out, scene_clip};\n\
             import package::wgsl::render::scene_kind::{SceneFragment, scene_words, words_fade, words_instance, words_level, words_outside};\n",
    );
    if kind.deep {
        text += "import package::wgsl::render::output_depth::depth_behind;\n";
    }
    text += &imports;
    let module = module_path(relative);
    writeln!(text, "import {module}::{{{}}};\n", exports(kind).join(", ")).expect("a string");
    text + &entries(kind, &outputs)
}

/// Refuses a module with a binding that no shader uses.
fn refuse_unused_module_bindings(root: &Path, shaders: &[Shader]) {
    for file in shader_files(&root.join("wgsl")) {
        for name in declared_bindings(root, &file) {
            let prefixed = format!("{}{name}", prefix::PREFIX);
            if !shaders.iter().any(|shader| shader.uses(&name) || shader.uses(&prefixed)) {
                refuse_binding(root, &file, &name);
            }
        }
    }
}

/// Which declarations stay in a composed shader.
#[derive(Clone, Copy, PartialEq)]
enum Keep {
    /// Only declarations that an entry point uses, directly or indirectly.
    Entries,
    /// Declarations that an entry point uses, and all declarations of the root file.
    Root,
    /// All declarations, including those of imported modules.
    All,
}

/// Composes a file and all of its imports into one flat text.
fn flatten(root: &Path, file: &Path, keep: Keep, mangler: wesl::ManglerKind) -> String {
    let relative = file.strip_prefix(root).expect("below the root");
    let resolver = sources(root);
    let mut compiler = wesl::Wesl::new(root).set_custom_resolver(&resolver);
    // Not lazy, so that unused imports are also checked for existence.
    compiler.set_options(wesl::CompileOptions {
        lazy: false,
        strip: keep != Keep::All,
        keep_root: keep == Keep::Root,
        ..Default::default()
    });
    compiler.set_mangler(mangler);
    compiler.set_missing_feature_behavior(wesl::Feature::Error);
    let path =
        module_path(&if is_kind(file) { Path::new("entries").join(relative) } else { relative.to_owned() });
    match compiler.compile(&path) {
        Ok(mut result) => {
            let place = places(&resolver, &result.modules, &path);
            let at = |declaration: &wesl::syntax::GlobalDeclarationNode| {
                declaration.ident().and_then(|ident| place.get(&*ident.name()).copied())
            };
            result.syntax.global_declarations.sort_by_key(at);
            result.to_string()
        }
        Err(error) => refuse(relative, &error.to_string()),
    }
}

/// The order of declarations in a flat text: by module, the root last, and as in their files. WESL's own order changes from run to
/// run.
fn places(
    resolver: &impl wesl::Resolver,
    modules: &[wesl::ModulePath],
    last: &wesl::ModulePath,
) -> HashMap<String, (usize, usize)> {
    let mut modules: Vec<_> = modules.iter().map(|path| (path == last, path.to_string(), path)).collect();
    modules.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
    let mut places = HashMap::new();
    for (module, (_, name, path)) in modules.into_iter().enumerate() {
        let unit = resolver
            .resolve_module(path)
            .unwrap_or_else(|error| refuse(Path::new(&name), &error.to_string()));
        let names = unit.global_declarations.iter().filter_map(|declaration| declaration.ident());
        places.extend(names.enumerate().map(|(at, ident)| (ident.name().to_string(), (module, at))));
    }
    places
}

/// Resolver with all WGSL files. Packed words and the entry points of kinds are expanded in it.
fn sources(root: &Path) -> wesl::VirtualResolver<'static> {
    let mut resolver = wesl::VirtualResolver::new();
    for file in ["kernels", "wgsl"].iter().flat_map(|folder| shader_files(&root.join(folder))) {
        let relative = file.strip_prefix(root).expect("below the root");
        let text =
            std::fs::read_to_string(&file).unwrap_or_else(|error| refuse(relative, &error.to_string()));
        if let Some(kind) = KindText::declared(&text).unwrap_or_else(|why| refuse(relative, &why)) {
            let path = module_path(&Path::new("entries").join(relative));
            resolver.add_module(path, kind_root(root, relative, &kind).into());
        }
        let text = packed::expanded(text).unwrap_or_else(|why| refuse(relative, &why));
        resolver.add_module(module_path(relative), text.into());
    }
    let files = output_files(root);
    let (_, imports) = outputs(&files, root, true);
    let core = "import package::wgsl::render::output_depth::depth_behind;
import package::wgsl::render::scene_instances::{scene_last_placed, scene_last_rigid, scene_placed, scene_surface};
import package::wgsl::render::scene_fade::{is_left_out, scene_clip};
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex, scene_words, words_fade, words_instance, words_level, words_outside};
import package::wgsl::render::scene_view::view;
";
    resolver.add_module(module_path(Path::new(CORE)), format!("{core}{imports}").into());
    resolver
}

/// WESL path of a WGSL file: `package::wgsl::lod::object` for `wgsl/lod/object.wgsl`.
fn module_path(relative: &Path) -> wesl::ModulePath {
    let path = format!("package::{}", relative.with_extension("").display()).replace('/', "::");
    path.parse().expect("a module path")
}

/// Names of the bindings that a file declares itself, without imported ones.
fn declared_bindings(root: &Path, file: &Path) -> Vec<String> {
    // Only imported names are mangled, so a name that occurs in the file belongs to the file.
    let flat = flatten(root, file, Keep::Root, wesl::ManglerKind::Escape);
    let module = naga::front::wgsl::parse_str(&flat)
        .unwrap_or_else(|error| refuse(file, &error.emit_to_string(&flat)));
    let names = module.global_variables.iter().filter(|(_, variable)| variable.binding.is_some());
    names.filter_map(|(_, variable)| variable.name.clone()).filter(|name| line_of(file, name) > 0).collect()
}

/// Number of the line that declares `name`, counted from 1; 0 if no line declares it.
fn line_of(file: &Path, name: &str) -> usize {
    let source = std::fs::read_to_string(file).unwrap_or_default();
    let declares = |line: &str| {
        line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name)
            && !line.trim_start().starts_with("//")
    };
    source.lines().position(declares).map_or(0, |index| index + 1)
}

fn refuse_binding(root: &Path, file: &Path, name: &str) -> ! {
    let relative = file.strip_prefix(root).unwrap_or(file);
    refuse(relative, &format!("line {}: nothing uses the binding `{name}`", line_of(file, name)))
}

pub struct Shader {
    pub name: String,
    flat: String,
    pub module: naga::Module,
    info: naga::valid::ModuleInfo,
}

impl Shader {
    fn compose(root: &Path, file: &Path, name: String, keep: Keep) -> Self {
        let relative = file.strip_prefix(root).expect("below the root");
        // Names are not mangled, so that the flat shader reads like its sources. If two names clash, naga reports an error.
        let flat = flatten(root, file, keep, wesl::ManglerKind::None);
        let flat = format!("// relievo {name}: generated from {}\n\n{flat}", relative.display());
        let shader = Self::validated(root, file, name, flat);
        shader.refuse_unused_bindings(root, file);
        shader
    }

    /// Parses and validates a flat shader with naga. An invalid shader is refused.
    fn validated(root: &Path, file: &Path, name: String, flat: String) -> Self {
        let relative = file.strip_prefix(root).expect("below the root");
        let module = naga::front::wgsl::parse_str(&flat).unwrap_or_else(|error| {
            let at = error.location(&flat).map_or(0, |location| location.line_number as usize);
            refuse(relative, &format!("{}{}", origin(root, &flat, at), error.emit_to_string(&flat)))
        });
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::default(),
        );
        let info = validator.validate(&module).unwrap_or_else(|error| {
            let at = error.location(&flat).map_or(0, |location| location.line_number as usize);
            refuse(relative, &format!("{}{}", origin(root, &flat, at), error.emit_to_string(&flat)))
        });
        Self { name, flat, module, info }
    }

    /// Prefix of the override constants' names in the published shader; empty if the shader takes no shading of the caller.
    pub fn prefix(&self) -> &'static str {
        if self.takes_shading() { prefix::PREFIX } else { "" }
    }

    /// Whether the caller may replace the shader's function `shade`.
    fn takes_shading(&self) -> bool {
        self.module.functions.iter().any(|(_, function)| function.name.as_deref() == Some("shade"))
    }

    /// The shader in the form that is compiled at run time. If the caller may replace `shade`, all of the crate's names get a
    /// prefix.
    fn published(self, root: &Path, file: &Path) -> Self {
        match self.takes_shading() {
            true => Self::validated(root, file, self.name.clone(), prefix::prefixed(&self.flat)),
            false => self,
        }
    }

    /// Refuses a root file with an unused binding. WESL strips unused declarations, so such a binding is
    /// missing in the flat shader.
    fn refuse_unused_bindings(&self, root: &Path, file: &Path) {
        for name in declared_bindings(root, file) {
            if !self.uses(&name) {
                refuse_binding(root, file, &name);
            }
        }
    }

    /// Whether an entry point uses a binding with the given name.
    fn uses(&self, name: &str) -> bool {
        self.module.global_variables.iter().any(|(handle, variable)| {
            let here = variable.binding.is_some() && variable.name.as_deref() == Some(name);
            let mut entries = 0..self.module.entry_points.len();
            here && entries.any(|entry| !self.info.get_entry_point(entry)[handle].is_empty())
        })
    }

    /// Name of the Rust constant for this shader, such as `TERRAIN_HEIGHT` for `terrain/height`.
    pub fn constant(&self) -> String {
        self.name.replace('/', "_").to_uppercase()
    }

    fn describe(&self, manifest: &mut String, core: &str, path: &str) {
        let mut bindings = self.bindings(core);
        bindings.sort();
        let bindings: String = bindings.into_iter().map(|(_, _, text)| text).collect();
        writeln!(
            manifest,
            "/// `{name}`\npub static {constant}: Shader = Shader {{\n    name: {name:?},\n    \
                 source: {source},\n    entry_points: &[\n{entries}    ],\n    \
                 bindings: &[\n{bindings}    ],\n    overrides: &[\n{overrides}    ],\n    \
                 structs: &[\n{structs}    ],\n}};",
            name = self.name,
            source = included(path),
            constant = self.constant(),
            entries = self.entry_points(),
            overrides = self.overrides(),
            structs = self.structs(),
        )
        .expect("a string");
    }

    fn entry_points(&self) -> String {
        let mut text = String::new();
        for entry in &self.module.entry_points {
            let stage = match entry.stage {
                ShaderStage::Vertex => "Stage::Vertex",
                ShaderStage::Fragment => "Stage::Fragment",
                ShaderStage::Compute => "Stage::Compute",
                other => panic!("{}: {other:?} stages are not part of WebGPU", self.name),
            };
            let is_vertex = entry.stage == ShaderStage::Vertex;
            writeln!(
                text,
                "        EntryPoint {{ name: {:?}, stage: {stage}, workgroup_size: {:?}, inputs: &[{}] }},",
                entry.name,
                entry.workgroup_size,
                if is_vertex { self.inputs(&entry.function) } else { String::new() },
            )
            .expect("a string");
        }
        text
    }

    /// Vertex attributes of a vertex entry point, as Rust text.
    fn inputs(&self, function: &naga::Function) -> String {
        let mut inputs = Vec::new();
        for argument in &function.arguments {
            match argument.binding {
                Some(Binding::Location { location, .. }) => {
                    let name = argument.name.as_deref().unwrap_or_default();
                    let ty = self.type_name(argument.ty);
                    inputs.push(format!("Input {{ location: {location}, name: {name:?}, ty: {ty:?} }}"));
                }
                Some(Binding::BuiltIn(_)) => {}
                None => panic!("{}: vertex inputs in a struct: teach relievo-shaders", self.name),
            }
        }
        inputs.join(", ")
    }

    fn overrides(&self) -> String {
        let mut text = String::new();
        for (_, constant) in self.module.overrides.iter() {
            let name = constant.name.as_deref().unwrap_or_default();
            let default = constant.init.map(|init| &self.module.global_expressions[init]);
            let default = match default {
                Some(Expression::Literal(Literal::Bool(value))) => f64::from(u8::from(*value)),
                Some(Expression::Literal(Literal::U32(value))) => f64::from(*value),
                Some(Expression::Literal(Literal::I32(value))) => f64::from(*value),
                Some(Expression::Literal(Literal::F32(value))) => f64::from(*value),
                other => {
                    panic!("{}: override {name}: teach relievo-shaders the default {other:?}", self.name)
                }
            };
            let ty = self.type_name(constant.ty);
            writeln!(text, "        Override {{ name: {name:?}, ty: {ty:?}, default: {default:?} }},")
                .expect("a string");
        }
        text
    }

    fn type_name(&self, ty: naga::Handle<naga::Type>) -> String {
        self.module.to_ctx().type_to_string(ty)
    }

    /// Bindings of the shader as (group, binding, Rust text). `core` is the text of the scene core.
    fn bindings(&self, core: &str) -> Vec<(u32, u32, String)> {
        let mut found = Vec::new();
        for (handle, variable) in self.module.global_variables.iter() {
            let Some(binding) = &variable.binding else { continue };
            let kind = match (variable.space, &self.module.types[variable.ty].inner) {
                (AddressSpace::Uniform, _) => "BindingKind::Uniform",
                (AddressSpace::Storage { access }, _) if access.contains(StorageAccess::STORE) => {
                    "BindingKind::StorageReadWrite"
                }
                (AddressSpace::Storage { .. }, _) => "BindingKind::StorageRead",
                (_, TypeInner::Image { class: naga::ImageClass::Depth { .. }, .. }) => {
                    "BindingKind::DepthTexture"
                }
                (_, TypeInner::Image { arrayed: true, .. }) => "BindingKind::TextureArray",
                (_, TypeInner::Image { .. }) if self.is_sampled(handle) => "BindingKind::Texture",
                (_, TypeInner::Image { .. }) => "BindingKind::LoadedTexture",
                (_, TypeInner::Sampler { comparison: true }) => "BindingKind::ComparisonSampler",
                (_, TypeInner::Sampler { .. }) => "BindingKind::Sampler",
                (space, _) => panic!(
                    "{}: binding {:?} in {space:?}: teach relievo-shaders this kind",
                    self.name, variable.name
                ),
            };
            let mut stages = (self.module.entry_points.iter().enumerate())
                .filter(|(index, _)| !self.info.get_entry_point(*index)[handle].is_empty())
                .map(|(_, entry)| format!("Stage::{:?}", entry.stage))
                .collect::<Vec<_>>();
            stages.dedup();
            let name = variable.name.as_deref().unwrap_or_default();
            // All kinds of objects share the layout of the view's bind group, and a caller's kind may use it in either stage.
            let own = name.strip_prefix(self.prefix()).unwrap_or(name);
            let of_core =
                core.lines().any(|line| line.starts_with("var") && line.contains(&format!(" {own}:")));
            let is_shared = binding.group == 0 && self.takes_shading() && of_core;
            let stages =
                if is_shared { "Stage::Vertex, Stage::Fragment".to_owned() } else { stages.join(", ") };
            let (group, binding) = (binding.group, binding.binding);
            let ty = self.type_name(variable.ty);
            found.push((group, binding, format!(
                    "        Binding {{ group: {group}, binding: {binding}, name: {name:?}, kind: {kind}, ty: {ty:?}, stages: &[{stages}] }},\n"
                )));
        }
        found
    }

    /// Whether a sampler reads the texture. Textures that are only read by `textureLoad` give false.
    fn is_sampled(&self, texture: naga::Handle<naga::GlobalVariable>) -> bool {
        (0..self.module.entry_points.len())
            .any(|entry| self.info.get_entry_point(entry).sampling_set.iter().any(|key| key.image == texture))
    }

    fn structs(&self) -> String {
        let mut text = String::new();
        for (_, ty) in self.module.types.iter() {
            let (Some(name), TypeInner::Struct { members, span }) = (&ty.name, &ty.inner) else {
                continue;
            };
            let members = (members.iter())
                .map(|member| {
                    let (name, offset) = (member.name.as_deref().unwrap_or_default(), member.offset);
                    let ty = self.type_name(member.ty);
                    format!("Member {{ name: {name:?}, offset: {offset}, ty: {ty:?} }}")
                })
                .collect::<Vec<_>>()
                .join(", ");
            writeln!(text, "        Struct {{ name: {name:?}, size: {span}, members: &[{members}] }},")
                .expect("a string");
        }
        text
    }
}

/// Source file and line from which a line of the flat shader comes. WESL writes a statement of several lines as one line.
/// Therefore the longest source line with which the flat line starts is taken, ignoring spaces.
fn origin(root: &Path, flat: &str, line: usize) -> String {
    let squeeze = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    let flat_line =
        line.checked_sub(1).and_then(|index| flat.lines().nth(index)).map(squeeze).unwrap_or_default();
    let mut found = (0, format!("line {line} of the flat shader: "));
    for file in ["kernels", "wgsl"].iter().flat_map(|folder| shader_files(&root.join(folder))) {
        let source = std::fs::read_to_string(&file).unwrap_or_default();
        for (index, text) in source.lines().map(squeeze).enumerate() {
            if text.len() > found.0 && flat_line.starts_with(&text) {
                let name = file.strip_prefix(root).unwrap_or(&file).display().to_string();
                found = (text.len(), format!("{name}:{}: ", index + 1));
            }
        }
    }
    found.1
}

pub fn refuse(file: &Path, what: &str) -> ! {
    eprintln!("{}: {what}", file.display());
    std::process::exit(1)
}
