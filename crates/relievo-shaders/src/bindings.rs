//! Generates Rust from the composed WGSL: structs and constants that shaders and host share. For every shader it also generates
//! the override constants, and the resources of each bind group by name and type.
//!
//! `shared.rs` needs no graphics library. It has one module per WGSL file, with the file's constants and the structs that lie in
//! buffers. `bindings.rs` needs the feature `gpu` and has one module per shader.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;

use naga::{AddressSpace, Handle, TypeInner};

use crate::shaders::{Shader, is_kind, output_files, refuse};
use crate::sources::Sources;
use crate::types::{Use, constant_text, literal_text, scalar_name};

/// Structs and constants of a WGSL file as Rust text, by name.
pub type Items = BTreeMap<String, String>;

/// The generated modules. `shared` has the modules of `shared.rs` by the path of their WGSL file, without `kernels/` or `wgsl/`.
/// `shaders` has the modules of `bindings.rs` by the name of their shader.
#[derive(Default)]
pub struct Bindings {
    shared: BTreeMap<String, Items>,
    shaders: BTreeMap<String, String>,
}

impl Bindings {
    /// Adds the module of a shader, and the structs and constants that the shader shares with the host.
    pub fn add(&mut self, root: &Path, file: &Path, shader: &Shader) {
        let mut sources = Sources::of(root, file);
        if is_kind(file) {
            let outputs = output_files(root).into_iter().map(|(file, _)| file);
            let files = outputs.chain([root.join("wgsl/render/output_depth.wgsl")]);
            files.for_each(|file| sources.follow(root, &file));
        }
        let bindings = ShaderBindings { root, file, shader, sources: &sources };
        bindings.constants(&mut self.shared);
        for (path, word) in sources.packed(root) {
            self.shared.entry(path).or_default().extend(word.rust());
        }
        let text = bindings.module(&mut self.shared);
        self.shaders.insert(shader.name.clone(), text);
    }

    /// The generated files `shared.rs` and `bindings.rs`: name and text.
    pub fn texts(&self) -> [(String, String); 2] {
        let shared = nested(&self.shared.iter().map(|(path, items)| (path.clone(), joined(items))).collect());
        [("shared.rs".to_owned(), shared), ("bindings.rs".to_owned(), nested(&self.shaders))]
    }
}

fn joined(items: &Items) -> String {
    items.values().map(String::as_str).collect::<Vec<_>>().join("\n")
}

/// Nests modules, given as path `domain/file` and text, into Rust modules.
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

/// Formats a comment as a Rust doc comment; without a comment it uses `fallback`.
pub fn doc(indent: &str, comment: &[&str], fallback: &str) -> String {
    let lines = if comment.is_empty() { vec![fallback] } else { comment.to_vec() };
    // Intra-doc links are turned into plain code, because they would not resolve in the generated module.
    let plain = |line: &&str| line.replace("[`", "`").replace("`]", "`");
    lines.iter().map(|line| format!("{indent}/// {}\n", plain(line))).collect()
}

/// A shader for which bindings are generated, with its sources.
pub struct ShaderBindings<'a> {
    pub root: &'a Path,
    file: &'a Path,
    pub shader: &'a Shader,
    pub sources: &'a Sources,
}

impl ShaderBindings<'_> {
    pub fn refuse(&self, what: &str) -> ! {
        refuse(self.file.strip_prefix(self.root).unwrap_or(self.file), what)
    }

    /// Adds the constants that the shader uses, each to the module of its WGSL file.
    fn constants(&self, shared: &mut BTreeMap<String, Items>) {
        let module = &self.shader.module;
        for (_, constant) in module.constants.iter() {
            let Some(name) = &constant.name else { continue };
            let Some(declaration) = self.sources.declaring("const", name) else { continue };
            let Some((ty, value)) = constant_text(module, constant.init) else { continue };
            let text = doc("", &declaration.comment, &format!("`{name}` of the shader."))
                + &format!("pub const {name}: {ty} = {value};\n");
            shared.entry(declaration.module(self.root)).or_default().insert(name.clone(), text);
        }
    }

    /// Text of the shader's module in `bindings.rs`.
    fn module(&self, shared: &mut BTreeMap<String, Items>) -> String {
        let mut text = String::from("use crate::gpu::bind::prelude::*;\n\n");
        text += &self.overrides();
        text += &self.lengths();
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
            fields += &doc("    ", &comment, &format!("`{name}` of the shader."));
            writeln!(fields, "    pub {field}: {ty},").expect("a string");
            let init = constant.init.map(|init| &shader.module.global_expressions[init]);
            let Some(naga::Expression::Literal(literal)) = init else {
                self.refuse(&format!("override {name}: must have a literal default"))
            };
            let value = literal_text(*literal).map(|(_, value)| value).unwrap_or_default();
            writeln!(defaults, "            {field}: {value},").expect("a string");
            let number =
                if ty == "f32" { format!("f64::from(self.{field})") } else { format!("self.{field}.into()") };
            let published = format!("{}{name}", shader.prefix());
            writeln!(list, "            ({published:?}, {number}),").expect("a string");
        }
        let constant = shader.constant();
        let name = &shader.name;
        let (constants, argument, list) = if fields.is_empty() {
            (String::new(), "", "&[]")
        } else {
            let text = format!(
                "/// Override constants of `{name}`.\n#[derive(Debug, Clone, Copy, PartialEq)]\npub struct Constants {{\n{fields}}}\n\n\
                 impl Default for Constants {{\n    fn default() -> Self {{\n        Self {{\n{defaults}        }}\n    }}\n}}\n\n\
                 impl Constants {{\n    /// Name and value of each.\n    pub fn list(&self) -> Vec<(&'static str, f64)> {{\n        vec![\n{list}        ]\n    }}\n}}\n\n"
            );
            (text, ", constants: &Constants", "&constants.list()")
        };
        if !self.is_kernel() {
            return format!(
                "{constants}/// The layouts of the bind groups of `{name}`.\n///\n/// # Errors\n/// [`GpuError::Validation`] where the device's limits do not permit them.\n\
                 pub fn layouts(gpu: &Gpu) -> Result<Layouts, GpuError> {{\n    \
                 Layouts::new(gpu, &shaders::{constant})\n}}\n\n"
            );
        }
        format!(
            "{constants}/// The kernel `{name}`, compiled.\n///\n/// # Errors\n/// What the driver's compiler reports.\n\
             pub fn kernel(gpu: &Gpu{argument}) -> Result<Kernel, GpuError> {{\n    \
             Kernel::new(gpu, &shaders::{constant}, {list})\n}}\n\n"
        )
    }

    /// Whether the shader is a compute kernel, not a shader that draws.
    fn is_kernel(&self) -> bool {
        self.shader.module.entry_points.iter().any(|entry| entry.stage == naga::ShaderStage::Compute)
    }

    /// Struct with the resources of a bind group. Its name is `Group`. If the shader has `// length` comments, the name is
    /// `Buffers`, lengths are checked, and the pass provides `params`.
    fn group(
        &self,
        group: u32,
        variables: &BTreeMap<u32, Handle<naga::GlobalVariable>>,
        shared: &mut BTreeMap<String, Items>,
    ) -> String {
        let shader = self.shader;
        let is_checked = !self.length_counts().is_empty();
        let (mut fields, mut resources, mut checks) = (String::new(), String::new(), String::new());
        let mut arguments = String::new();
        for (binding, handle) in variables {
            let variable = &shader.module.global_variables[*handle];
            let name = variable.name.clone().unwrap_or_default();
            let (mut ty, mut resource) = self.bound(variable, shared);
            if is_checked && matches!(variable.space, AddressSpace::Storage { .. }) {
                ty = ty.replace("Slice<'a, ", "&'a Buffer<");
                resource = format!("self.{name}.slice().resource()");
            }
            if is_checked && name == "params" {
                arguments += &format!(", params: {}", ty.replace("&'a ", "&"));
                writeln!(resources, "            ({binding}, {}),", resource.replace("self.", ""))
                    .expect("a string");
                continue;
            }
            let (comment, length) = self.sources.binding_comment(&name);
            fields += &doc("    ", &comment, &format!("`{name}` of the shader."));
            writeln!(fields, "    pub {name}: {ty},").expect("a string");
            writeln!(resources, "            ({binding}, {resource}),").expect("a string");
            if let Some(length) = length {
                let (path, count) = (length.path.unwrap_or(&name), self.count(length.count).0);
                writeln!(checks, "        self.{name}.check_holds({path:?}, {count})?;").expect("a string");
            }
        }
        let of = match group {
            0 if is_checked => "Buffers".to_owned(),
            0 => "Group".to_owned(),
            group => format!("Group{group}"),
        };
        let (name, constant) = (&shader.name, shader.constant());
        let target = if self.is_kernel() { "kernel: &Kernel" } else { "layouts: &Layouts" };
        let binds = if self.is_kernel() { "kernel.layouts" } else { "layouts" };
        let bound =
            format!("{binds}.bind_group(gpu, &shaders::{constant}, {group}, &[\n{resources}        ])");
        let (errors, error, body) = match is_checked {
            true => {
                arguments += ", lengths: &Lengths";
                let counts = self.length_counts().into_iter().collect::<Vec<_>>().join(", ");
                let body = format!("let Lengths {{ {counts} }} = *lengths;\n{checks}        Ok({bound}?)");
                ("[`InputError`](crate::InputError) for a buffer that is too short; ", "crate::Error", body)
            }
            false => ("", "GpuError", bound),
        };
        format!(
            "/// Resources of bind group {group} of `{name}`.\n#[derive(Debug, Clone, Copy)]\npub struct {of}<'a> {{\n{fields}}}\n\n\
             impl {of}<'_> {{\n    /// Binds them.\n    ///\n    /// # Errors\n    /// {errors}[`GpuError::Validation`] where the device refuses one.\n    \
             pub fn bind(&self, gpu: &Gpu, {target}{arguments}) -> Result<BindGroup, {error}> {{\n        {body}\n    }}\n}}\n\n"
        )
    }

    /// Struct with the counts from which the least lengths of the shader's buffers are computed.
    fn lengths(&self) -> String {
        let counts = self.length_counts();
        if counts.is_empty() {
            return String::new();
        }
        let fields: String = counts
            .iter()
            .map(|count| format!("    /// Number of {}.\n    pub {count}: usize,\n", count.replace('_', " ")))
            .collect();
        format!(
            "/// Counts that give the least lengths of the buffers of `{}`.\n#[derive(Debug, Clone, Copy)]\npub struct Lengths {{\n{fields}}}\n\n",
            self.shader.name
        )
    }

    /// Names of all counts that the shader's `// length` comments mention.
    fn length_counts(&self) -> BTreeSet<String> {
        let module = &self.shader.module;
        let names = (module.global_variables.iter()).filter_map(|(_, variable)| variable.name.as_deref());
        let lengths = names.filter_map(|name| self.sources.binding_comment(name).1);
        lengths.flat_map(|length| self.count(length.count).1).collect()
    }

    /// Converts the formula of a `// length` comment to Rust. Also returns the counts that the formula mentions.
    fn count(&self, text: &str) -> (String, BTreeSet<String>) {
        let mut counts = BTreeSet::new();
        let words = text.split(' ').map(|word| {
            let is_name = |c: char| c.is_alphanumeric() || c == '_';
            match word.chars().next() {
                Some('0'..='9' | '+' | '*') => word.to_owned(),
                Some('a'..='z') if word.chars().all(is_name) => {
                    counts.insert(word.to_owned());
                    word.to_owned()
                }
                Some('A'..='Z') if word.chars().all(is_name) => self.constant_path(word),
                _ => self
                    .refuse(&format!("length: {text}: `{word}` is no count, constant, number, `+` or `*`")),
            }
        });
        (words.collect::<Vec<_>>().join(" "), counts)
    }

    fn constant_path(&self, name: &str) -> String {
        let is_kept =
            self.shader.module.constants.iter().any(|(_, constant)| constant.name.as_deref() == Some(name));
        match self.sources.declaring("const", name).filter(|_| is_kept) {
            Some(found) => {
                format!("crate::shared::{}::{name} as usize", found.module(self.root).replace('/', "::"))
            }
            None => self.refuse(&format!("length: the shader uses no constant {name}")),
        }
    }

    /// Rust type of a binding's field, and the expression that binds the field.
    fn bound(
        &self,
        variable: &naga::GlobalVariable,
        shared: &mut BTreeMap<String, Items>,
    ) -> (String, String) {
        let name = variable.name.clone().unwrap_or_default();
        match (variable.space, &self.shader.module.types[variable.ty].inner) {
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
            (space, _) => self.refuse(&format!("binding `{name}` in {space:?}: teach relievo-shaders")),
        }
    }
}
