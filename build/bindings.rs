//! Generates the Rust that kernels and host share from the composed WGSL: structs and constants, and for every
//! kernel its override constants and the resources of each bind group, by name and type.
//!
//! `shared.rs` needs no graphics library. It has one module per WGSL file, with the constants of that file and
//! its structs that lie in buffers. `bindings.rs` needs the feature `gpu` and has one module per kernel.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use naga::{AddressSpace, Handle, Literal, Scalar, ScalarKind, StructMember, Type, TypeInner, VectorSize};

use crate::shaders::{Shader, refuse};

/// A WGSL file's structs and constants as Rust, by name.
type Items = BTreeMap<String, String>;

/// The generated modules: those of `shared.rs`, by the path of their WGSL file without `kernels/` or `wgsl/`,
/// and those of `bindings.rs`.
#[derive(Default)]
pub struct Bindings {
    shared: BTreeMap<String, Items>,
    kernels: BTreeMap<String, String>,
}

impl Bindings {
    /// Adds the items that a kernel shares with the host.
    pub fn add(&mut self, root: &Path, file: &Path, shader: &Shader) {
        let sources = Sources::of(root, file);
        let kernel = KernelBindings { root, file, shader, sources: &sources };
        kernel.constants(&mut self.shared);
        let text = kernel.module(&mut self.shared);
        self.kernels.insert(shader.name.clone(), text);
    }

    /// Writes `shared.rs` and `bindings.rs`.
    pub fn write(&self, out: &Path) {
        let shared = nested(&self.shared.iter().map(|(path, items)| (path.clone(), joined(items))).collect());
        std::fs::write(out.join("shared.rs"), shared).expect("OUT_DIR is writable");
        std::fs::write(out.join("bindings.rs"), nested(&self.kernels)).expect("OUT_DIR is writable");
    }
}

fn joined(items: &Items) -> String {
    items.values().map(String::as_str).collect::<Vec<_>>().join("\n")
}

/// Modules given as `domain/file` and text, as nested Rust modules.
fn nested(modules: &BTreeMap<String, String>) -> String {
    let mut text = String::new();
    let mut domain = "";
    for (path, body) in modules {
        let (next, name) = path.split_once('/').unwrap_or(("", path));
        if next != domain {
            if !domain.is_empty() {
                text += "}\n";
            }
            if !next.is_empty() {
                writeln!(text, "/// Of `{next}/`.\npub mod {next} {{").expect("a string");
            }
            domain = next;
        }
        writeln!(text, "/// Of `{path}.wgsl`.\npub mod {name} {{\n{body}}}").expect("a string");
    }
    if domain.is_empty() { text } else { text + "}\n" }
}

/// The files of which a shader is composed, its own first.
struct Sources(Vec<(PathBuf, String)>);

impl Sources {
    fn of(root: &Path, file: &Path) -> Self {
        let mut found = Self(Vec::new());
        found.follow(root, file);
        found
    }

    fn follow(&mut self, root: &Path, file: &Path) {
        if self.0.iter().any(|(known, _)| known == file) {
            return;
        }
        let Ok(text) = std::fs::read_to_string(file) else { return };
        let imports: Vec<PathBuf> = text
            .lines()
            .filter_map(|line| line.trim().strip_prefix("import package::"))
            .filter_map(|path| {
                let names = path.trim_end_matches(';').split("::").map(str::trim);
                let mut file = root.to_path_buf();
                // The last one or two names are items; the longest prefix that is a file counts.
                names.filter(|name| !name.starts_with('{')).find_map(|name| {
                    file.push(name);
                    let module = file.with_extension("wgsl");
                    module.exists().then_some(module)
                })
            })
            .collect();
        self.0.push((file.to_path_buf(), text));
        imports.iter().for_each(|file| self.follow(root, file));
    }

    /// The file that declares `name`, the text before its name, and the comment above it.
    fn declaring(&self, keyword: &str, name: &str) -> Option<Declaration<'_>> {
        self.0.iter().find_map(|(file, text)| {
            let mut comment = Vec::new();
            for (number, line) in text.lines().enumerate() {
                let rest = line.strip_prefix(keyword).map(str::trim_start).unwrap_or_default();
                let word = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next();
                if word == Some(name) {
                    return Some(Declaration { file, text, line: number, comment });
                }
                match line.strip_prefix("//") {
                    Some(words) => comment.push(words.trim_start_matches('/').trim()),
                    None => comment.clear(),
                }
            }
            None
        })
    }
}

struct Declaration<'a> {
    file: &'a Path,
    text: &'a str,
    line: usize,
    comment: Vec<&'a str>,
}

impl Declaration<'_> {
    /// `domain/file`, or `file`.
    fn module(&self, root: &Path) -> String {
        let relative = self.file.strip_prefix(root).expect("below the root").with_extension("");
        let path = relative.display().to_string();
        path.split_once('/').map_or(path.clone(), |(_, rest)| rest.to_owned())
    }

    /// The comments above the members of a struct, in order.
    fn members(&self) -> BTreeMap<String, Vec<&str>> {
        let mut members = BTreeMap::new();
        let mut comment = Vec::new();
        for line in self.text.lines().skip(self.line + 1).map(str::trim) {
            if line.starts_with('}') {
                break;
            }
            if let Some(words) = line.strip_prefix("//") {
                comment.push(words.trim_start_matches('/').trim());
            } else if let Some((before, _)) = line.split_once(':') {
                let name = before.rsplit(' ').next().unwrap_or_default();
                members.insert(name.to_owned(), std::mem::take(&mut comment));
            }
        }
        members
    }
}

/// A doc comment, or `fallback` if there is no comment.
fn doc(indent: &str, comment: &[&str], fallback: &str) -> String {
    let lines = if comment.is_empty() { vec![fallback] } else { comment.to_vec() };
    // Links would not resolve from the generated module.
    let plain = |line: &&str| line.replace("[`", "`").replace("`]", "`");
    lines.iter().map(|line| format!("{indent}/// {}\n", plain(line))).collect()
}

struct KernelBindings<'a> {
    root: &'a Path,
    file: &'a Path,
    shader: &'a Shader,
    sources: &'a Sources,
}

impl KernelBindings<'_> {
    fn refuse(&self, what: &str) -> ! {
        refuse(self.file.strip_prefix(self.root).unwrap_or(self.file), what)
    }

    /// The constants that the shader uses, from all its files.
    fn constants(&self, shared: &mut BTreeMap<String, Items>) {
        let module = &self.shader.module;
        for (_, constant) in module.constants.iter() {
            let Some(name) = &constant.name else { continue };
            let naga::Expression::Literal(literal) = module.global_expressions[constant.init] else {
                continue;
            };
            let Some(declaration) = self.sources.declaring("const", name) else { continue };
            let Some((ty, value)) = literal_text(literal) else { continue };
            let text = doc("", &declaration.comment, &format!("`{name}` of the shader."))
                + &format!("pub const {name}: {ty} = {value};\n");
            shared.entry(declaration.module(self.root)).or_default().insert(name.clone(), text);
        }
    }

    /// The kernel's module of `bindings.rs`.
    fn module(&self, shared: &mut BTreeMap<String, Items>) -> String {
        let mut text = String::from("use crate::gpu::bind::prelude::*;\n\n");
        text += &self.overrides();
        let module = &self.shader.module;
        let mut groups: BTreeMap<u32, BTreeMap<u32, Handle<naga::GlobalVariable>>> = BTreeMap::new();
        for (handle, variable) in module.global_variables.iter() {
            if let Some(binding) = &variable.binding {
                groups.entry(binding.group).or_default().insert(binding.binding, handle);
            }
        }
        for (group, variables) in &groups {
            text += &self.group(*group, variables, shared);
        }
        text
    }

    fn overrides(&self) -> String {
        let shader = &self.shader;
        let mut fields = String::new();
        let mut list = String::new();
        let mut defaults = String::new();
        for (_, constant) in shader.module.overrides.iter() {
            let name = constant.name.clone().unwrap_or_default();
            let field = name.to_lowercase();
            let ty = match shader.module.types[constant.ty].inner {
                TypeInner::Scalar(scalar) => scalar_name(scalar),
                _ => self.refuse(&format!("override {name}: must be a scalar")),
            };
            let comment =
                self.sources.declaring("override", &name).map(|found| found.comment).unwrap_or_default();
            fields += &doc("    ", &comment, &format!("`{name}` of the kernel."));
            writeln!(fields, "    pub {field}: {ty},").expect("a string");
            let init = constant.init.map(|init| &shader.module.global_expressions[init]);
            let Some(naga::Expression::Literal(literal)) = init else {
                self.refuse(&format!("override {name}: must have a literal default"))
            };
            let value = literal_text(*literal).map(|(_, value)| value).unwrap_or_default();
            writeln!(defaults, "            {field}: {value},").expect("a string");
            let number =
                if ty == "f32" { format!("f64::from(self.{field})") } else { format!("self.{field}.into()") };
            writeln!(list, "            ({name:?}, {number}),").expect("a string");
        }
        let constant = shader.constant();
        let name = &shader.name;
        if fields.is_empty() {
            return format!(
                "/// The kernel `{name}`.\n///\n/// # Errors\n/// What the driver's compiler reports.\n\
                 pub fn kernel(gpu: &Gpu) -> Result<Kernel, GpuError> {{\n    \
                 Kernel::new(gpu, &shaders::{constant}, &[])\n}}\n\n"
            );
        }
        format!(
            "/// Override constants of `{name}`.\n#[derive(Debug, Clone, Copy, PartialEq)]\npub struct Constants {{\n{fields}}}\n\n\
             impl Default for Constants {{\n    fn default() -> Self {{\n        Self {{\n{defaults}        }}\n    }}\n}}\n\n\
             /// The kernel `{name}` with these constants.\n///\n/// # Errors\n/// What the driver's compiler reports.\n\
             pub fn kernel(gpu: &Gpu, constants: &Constants) -> Result<Kernel, GpuError> {{\n    \
             Kernel::new(gpu, &shaders::{constant}, &constants.list())\n}}\n\n\
             impl Constants {{\n    fn list(&self) -> Vec<(&'static str, f64)> {{\n        vec![\n{list}        ]\n    }}\n}}\n\n"
        )
    }

    fn group(
        &self,
        group: u32,
        variables: &BTreeMap<u32, Handle<naga::GlobalVariable>>,
        shared: &mut BTreeMap<String, Items>,
    ) -> String {
        let shader = self.shader;
        let mut fields = String::new();
        let mut resources = String::new();
        for (binding, handle) in variables {
            let variable = &shader.module.global_variables[*handle];
            let name = variable.name.clone().unwrap_or_default();
            let (ty, resource) = match (variable.space, &shader.module.types[variable.ty].inner) {
                (AddressSpace::Uniform, _) => {
                    let ty = self.host_type(variable.ty, Use::Uniform, shared);
                    (format!("&'a Uniform<{ty}>"), format!("self.{name}.raw().as_entire_binding()"))
                }
                (AddressSpace::Storage { .. }, _) => {
                    let ty = self.element(variable.ty, shared);
                    (format!("Slice<'a, {ty}>"), format!("self.{name}.resource()"))
                }
                (_, TypeInner::Image { .. }) => (
                    "&'a wgpu::TextureView".to_owned(),
                    format!("wgpu::BindingResource::TextureView(self.{name})"),
                ),
                (_, TypeInner::Sampler { .. }) => {
                    ("&'a wgpu::Sampler".to_owned(), format!("wgpu::BindingResource::Sampler(self.{name})"))
                }
                (space, _) => self.refuse(&format!("binding `{name}` in {space:?}: teach build/bindings.rs")),
            };
            let comment = self.binding_comment(&name);
            fields += &doc("    ", &comment, &format!("`{name}` of the kernel."));
            writeln!(fields, "    pub {name}: {ty},").expect("a string");
            writeln!(resources, "            ({binding}, {resource}),").expect("a string");
        }
        let of = if group == 0 { "Group".to_owned() } else { format!("Group{group}") };
        let (name, constant) = (&shader.name, shader.constant());
        format!(
            "/// Resources of bind group {group} of `{name}`.\n#[derive(Debug, Clone, Copy)]\npub struct {of}<'a> {{\n{fields}}}\n\n\
             impl {of}<'_> {{\n    /// Binds them.\n    ///\n    /// # Errors\n    /// [`GpuError::Validation`] where the device refuses one.\n    \
             pub fn bind(&self, gpu: &Gpu, kernel: &Kernel) -> Result<BindGroup, GpuError> {{\n        \
             kernel.bind_group(gpu, &shaders::{constant}, {group}, &[\n{resources}        ])\n    }}\n}}\n\n"
        )
    }

    fn binding_comment(&self, name: &str) -> Vec<&str> {
        let marks = [format!("> {name}:"), format!(" {name}:")];
        for (_, text) in &self.sources.0 {
            let mut comment = Vec::new();
            for line in text.lines() {
                if line.starts_with("@group") && marks.iter().any(|mark| line.contains(mark.as_str())) {
                    return comment;
                }
                match line.strip_prefix("//") {
                    Some(words) => comment.push(words.trim_start_matches('/').trim()),
                    None => comment.clear(),
                }
            }
        }
        Vec::new()
    }

    /// The element type of a storage buffer.
    fn element(&self, ty: Handle<Type>, shared: &mut BTreeMap<String, Items>) -> String {
        match &self.shader.module.types[ty].inner {
            TypeInner::Array { base, .. } => self.host_type(*base, Use::Storage, shared),
            _ => self.host_type(ty, Use::Storage, shared),
        }
    }

    fn host_type(&self, ty: Handle<Type>, used: Use, shared: &mut BTreeMap<String, Items>) -> String {
        let module = &self.shader.module;
        let of = &module.types[ty];
        match &of.inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => scalar_name(*scalar).to_owned(),
            TypeInner::Vector { size, scalar } => used.vector(*size, *scalar),
            TypeInner::Matrix { columns: VectorSize::Quad, rows: VectorSize::Quad, .. }
                if used == Use::Uniform =>
            {
                "glam::Mat4".to_owned()
            }
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
                format!("[{}; {count}]", self.host_type(*base, used, shared))
            }
            TypeInner::Struct { members, span } => {
                let name = of.name.clone().unwrap_or_default();
                self.structure(&name, members, *span, used, shared)
            }
            other => self.refuse(&format!("{other:?} in a buffer: teach build/bindings.rs")),
        }
    }

    /// Adds a struct to its file's module. Returns its path or, for a struct with padding, an array of words.
    fn structure(
        &self,
        name: &str,
        members: &[StructMember],
        span: u32,
        used: Use,
        shared: &mut BTreeMap<String, Items>,
    ) -> String {
        let module = &self.shader.module;
        let size = |ty| module.types[ty].inner.size(module.to_ctx());
        let mut end = 0;
        let has_holes = members.iter().any(|member| {
            let hole = member.offset != end;
            end = member.offset + size(member.ty);
            hole
        }) || end != span;
        if used == Use::Storage && has_holes {
            return format!("[u32; {}]", span / 4);
        }
        let Some(declaration) = self.sources.declaring("struct", name) else {
            self.refuse(&format!("struct {name}: not found in the sources"))
        };
        let comments = declaration.members();
        let mut fields = String::new();
        for member in members {
            let field = member.name.clone().unwrap_or_default();
            let ty = self.host_type(member.ty, used, shared);
            let comment = comments.get(&field).cloned().unwrap_or_default();
            fields += &doc("    ", &comment, &format!("`{field}` of the shader."));
            // An aligned member of a uniform, which encase must know.
            if used == Use::Uniform
                && declaration
                    .text
                    .lines()
                    .any(|line| line.trim().starts_with("@align(16)") && line.contains(&format!(" {field}:")))
            {
                fields += "    #[shader(align(16))]\n";
            }
            writeln!(fields, "    pub {field}: {ty},").expect("a string");
        }
        let derive = match used {
            Use::Uniform => "#[cfg(feature = \"gpu\")]\n#[derive(Debug, Clone, Copy, encase::ShaderType)]\n",
            Use::Storage if members.iter().all(|member| is_whole(&module.types[member.ty].inner)) => {
                "#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]\n\
                 #[cfg_attr(feature = \"gpu\", derive(bytemuck::Pod, bytemuck::Zeroable))]\n#[repr(C)]\n"
            }
            Use::Storage => {
                "#[derive(Debug, Clone, Copy, PartialEq)]\n\
                 #[cfg_attr(feature = \"gpu\", derive(bytemuck::Pod, bytemuck::Zeroable))]\n#[repr(C)]\n"
            }
        };
        let path = declaration.module(self.root);
        let text = doc("", &declaration.comment, &format!("`{name}` of the shader."))
            + derive
            + &format!("pub struct {name} {{\n{fields}}}\n");
        let items = shared.entry(path.clone()).or_default();
        if items.get(name).is_some_and(|known| *known != text) {
            self.refuse(&format!("struct {name}: used as a uniform and as an element of a buffer"));
        }
        items.insert(name.to_owned(), text);
        format!("crate::shared::{}::{name}", path.replace('/', "::"))
    }
}

/// Whether a type consists of integers only.
fn is_whole(ty: &TypeInner) -> bool {
    match ty {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) | TypeInner::Vector { scalar, .. } => {
            matches!(scalar.kind, ScalarKind::Sint | ScalarKind::Uint)
        }
        _ => false,
    }
}

/// The use of a type, which decides its layout on the host.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    /// Written by encase.
    Uniform,
    /// Cast from bytes.
    Storage,
}

impl Use {
    fn vector(self, size: VectorSize, scalar: Scalar) -> String {
        let count = size as u8;
        match (self, scalar.kind) {
            (Self::Storage, _) => format!("[{}; {count}]", scalar_name(scalar)),
            (_, ScalarKind::Float) => format!("glam::Vec{count}"),
            (_, ScalarKind::Sint) => format!("glam::IVec{count}"),
            _ => format!("glam::UVec{count}"),
        }
    }
}

fn scalar_name(scalar: Scalar) -> &'static str {
    match scalar.kind {
        ScalarKind::Bool => "bool",
        ScalarKind::Sint | ScalarKind::AbstractInt => "i32",
        ScalarKind::Uint => "u32",
        ScalarKind::Float | ScalarKind::AbstractFloat => "f32",
    }
}

/// The Rust type and the value of a literal.
fn literal_text(literal: Literal) -> Option<(&'static str, String)> {
    Some(match literal {
        Literal::Bool(value) => ("bool", value.to_string()),
        Literal::U32(value) => ("u32", value.to_string()),
        Literal::I32(value) => ("i32", value.to_string()),
        Literal::F32(value) => ("f32", format!("{value:?}")),
        Literal::AbstractInt(value) => ("i32", i32::try_from(value).ok()?.to_string()),
        Literal::AbstractFloat(value) => ("f32", format!("{:?}", value as f32)),
        _ => return None,
    })
}
