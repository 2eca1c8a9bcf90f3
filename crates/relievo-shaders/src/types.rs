//! Converts WGSL types and constants to Rust.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use naga::{Handle, Literal, Scalar, ScalarKind, StructMember, Type, TypeInner, VectorSize};

use crate::bindings::{Items, ShaderBindings, doc};

impl ShaderBindings<'_> {
    /// Rust type of an element of a storage buffer.
    pub fn element(&self, ty: Handle<Type>, shared: &mut BTreeMap<String, Items>) -> String {
        match &self.shader.module.types[ty].inner {
            TypeInner::Array { base, stride, .. } => {
                self.refuse_gaps(*base, *stride);
                self.host_type(*base, Use::Storage, shared)
            }
            _ => self.host_type(ty, Use::Storage, shared),
        }
    }

    /// Rust type for a WGSL type in a uniform buffer or in a storage buffer; `used` tells which.
    pub fn host_type(&self, ty: Handle<Type>, used: Use, shared: &mut BTreeMap<String, Items>) -> String {
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
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), stride } => {
                if used == Use::Storage {
                    self.refuse_gaps(*base, *stride);
                }
                format!("[{}; {count}]", self.host_type(*base, used, shared))
            }
            TypeInner::Struct { members, span } => {
                let name = of.name.clone().unwrap_or_default();
                self.structure(&name, members, *span, used, shared)
            }
            other => self.refuse(&format!("{other:?} in a buffer: teach relievo-shaders")),
        }
    }

    /// Adds a struct to the module of its WGSL file. Returns the struct's Rust path.
    fn structure(
        &self,
        name: &str,
        members: &[StructMember],
        span: u32,
        used: Use,
        shared: &mut BTreeMap<String, Items>,
    ) -> String {
        if used == Use::Storage {
            self.refuse_holes(name, members, span);
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
            if used == Use::Uniform && declaration.aligns(&field) {
                fields += "    #[cfg_attr(feature = \"gpu\", shader(align(16)))]\n";
            }
            writeln!(fields, "    pub {field}: {ty},").expect("a string");
        }
        let path = declaration.module(self.root);
        let text = doc("", &declaration.comment, &format!("`{name}` of the shader."))
            + self.derives(members, used)
            + &format!("pub struct {name} {{\n{fields}}}\n");
        let items = shared.entry(path.clone()).or_default();
        if items.get(name).is_some_and(|known| *known != text) {
            self.refuse(&format!("struct {name}: used as a uniform and as an element of a buffer"));
        }
        items.insert(name.to_owned(), text);
        format!("crate::shared::{}::{name}", path.replace('/', "::"))
    }

    /// Refuses a struct with padding bytes. The host casts elements of buffers to and from bytes, so every byte must
    /// belong to a member.
    fn refuse_holes(&self, name: &str, members: &[StructMember], span: u32) {
        let module = &self.shader.module;
        let mut end = 0;
        for member in members {
            let field = member.name.as_deref().unwrap_or_default();
            if member.offset != end {
                self.refuse(&format!(
                    "struct {name}: a hole of {} bytes before `{field}`",
                    member.offset - end
                ));
            }
            end = member.offset + module.types[member.ty].inner.size(module.to_ctx());
        }
        if end != span {
            self.refuse(&format!("struct {name}: a hole of {} bytes at its end", span - end));
        }
    }

    /// Refuses an array with padding bytes between its elements, because the host casts whole buffers to bytes.
    fn refuse_gaps(&self, base: Handle<Type>, stride: u32) {
        let module = &self.shader.module;
        let size = module.types[base].inner.size(module.to_ctx());
        if size != stride {
            self.refuse(&format!("an array of {stride} bytes for elements of {size}"));
        }
    }

    fn derives(&self, members: &[StructMember], used: Use) -> &'static str {
        let types = &self.shader.module.types;
        match used {
            Use::Uniform => {
                "#[derive(Debug, Clone, Copy, PartialEq)]\n\
                 #[cfg_attr(feature = \"gpu\", derive(encase::ShaderType))]\n"
            }
            Use::Storage if members.iter().all(|member| is_whole(&types[member.ty].inner)) => {
                "#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]\n\
                 #[cfg_attr(feature = \"gpu\", derive(bytemuck::Pod, bytemuck::Zeroable))]\n#[repr(C)]\n"
            }
            Use::Storage => {
                "#[derive(Debug, Clone, Copy, PartialEq)]\n\
                 #[cfg_attr(feature = \"gpu\", derive(bytemuck::Pod, bytemuck::Zeroable))]\n#[repr(C)]\n"
            }
        }
    }
}

/// Whether a type is an integer or a vector of integers.
fn is_whole(ty: &TypeInner) -> bool {
    match ty {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) | TypeInner::Vector { scalar, .. } => {
            matches!(scalar.kind, ScalarKind::Sint | ScalarKind::Uint)
        }
        _ => false,
    }
}

/// Where a type is used, which decides its layout on the host.
#[derive(Clone, Copy, PartialEq)]
pub enum Use {
    /// In a uniform buffer, which the crate `encase` writes.
    Uniform,
    /// In a storage buffer, which is cast to and from bytes.
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

/// Rust name of a scalar type.
pub fn scalar_name(scalar: Scalar) -> &'static str {
    match scalar.kind {
        ScalarKind::Bool => "bool",
        ScalarKind::Sint | ScalarKind::AbstractInt => "i32",
        ScalarKind::Uint => "u32",
        ScalarKind::Float | ScalarKind::AbstractFloat => "f32",
    }
}

/// Rust type and value of a constant, which is a literal, a vector or an array. Vectors and arrays become Rust arrays. `None` for
/// others.
pub fn constant_text(module: &naga::Module, init: Handle<naga::Expression>) -> Option<(String, String)> {
    match &module.global_expressions[init] {
        naga::Expression::Literal(literal) => {
            literal_text(*literal).map(|(ty, value)| (ty.to_owned(), value))
        }
        naga::Expression::Compose { components, .. } => {
            let parts: Vec<_> =
                components.iter().map(|part| constant_text(module, *part)).collect::<Option<_>>()?;
            let values: Vec<_> = parts.iter().map(|(_, value)| value.as_str()).collect();
            let (ty, _) = parts.first()?;
            Some((format!("[{ty}; {}]", parts.len()), format!("[{}]", values.join(", "))))
        }
        _ => None,
    }
}

/// Rust type and value of a literal; `None` for types that the generator does not support.
pub fn literal_text(literal: Literal) -> Option<(&'static str, String)> {
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
