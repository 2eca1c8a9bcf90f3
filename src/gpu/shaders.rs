//! The flat, validated WGSL of every pass, with a description of its bindings. `relievo-shaders` generates both.

/// A stage of a pipeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Vertex stage (`@vertex`).
    Vertex,
    /// Fragment stage (`@fragment`).
    Fragment,
    /// Compute stage (`@compute`).
    Compute,
}

/// An entry point of a shader: a function that a pipeline can run.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct EntryPoint {
    /// Name of the function.
    pub name: &'static str,
    /// Pipeline stage of the entry point.
    pub stage: Stage,
    /// Threads per workgroup along x, y and z; zeros outside the compute stage.
    pub workgroup_size: [u32; 3],
    /// Vertex attributes of the entry point; empty outside the vertex stage.
    pub inputs: &'static [Input],
}

/// A vertex attribute of an entry point.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Input {
    /// Number in the attribute's `@location`.
    pub location: u32,
    /// Name of the argument or struct member.
    pub name: &'static str,
    /// WGSL name of the attribute's type, such as `vec3<f32>`.
    #[serde(rename = "type")]
    pub ty: &'static str,
}

/// Kind of the resource at a binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BindingKind {
    /// A uniform buffer.
    Uniform,
    /// A read-only storage buffer.
    StorageRead,
    /// A storage buffer that the shader writes.
    StorageReadWrite,
    /// A filterable 2-D array texture of floats.
    TextureArray,
    /// A filterable 2-D float texture.
    Texture,
    /// A 2-D float texture of any float format. The shader loads its texels and does not filter them.
    LoadedTexture,
    /// A 2-D depth texture.
    DepthTexture,
    /// A sampler that filters.
    Sampler,
    /// A sampler that compares depths.
    ComparisonSampler,
}

/// A resource that a shader binds.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Binding {
    /// Index of the bind group.
    pub group: u32,
    /// Index of the binding in its group.
    pub binding: u32,
    /// Name of the WGSL variable.
    pub name: &'static str,
    /// Kind of the bound resource.
    pub kind: BindingKind,
    /// WGSL name of the variable's type, such as `array<vec4<f32>>`. [`Shader::structs`] describes struct types.
    #[serde(rename = "type")]
    pub ty: &'static str,
    /// The stages in which the shader uses the resource.
    pub stages: &'static [Stage],
}

/// A struct type of a shader, with the layout that naga computes.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Struct {
    /// WGSL name of the struct.
    pub name: &'static str,
    /// Size of the struct in bytes.
    pub size: u32,
    /// Members of the struct, in the order of their offsets.
    pub members: &'static [Member],
}

/// A member of a struct type.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Member {
    /// WGSL name of the member.
    pub name: &'static str,
    /// Offset of the member from the start of the struct, in bytes.
    pub offset: u32,
    /// WGSL name of the member's type.
    #[serde(rename = "type")]
    pub ty: &'static str,
}

/// A pipeline-overridable constant of a shader.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Override {
    /// WGSL name of the constant.
    pub name: &'static str,
    /// WGSL name of the constant's type: `bool`, `i32`, `u32` or `f32`.
    #[serde(rename = "type")]
    pub ty: &'static str,
    /// Default value, as WebGPU's `constants` take it: 0 or 1 for `bool`.
    pub default: f64,
}

/// A flat WGSL shader, with a description of its interface.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Shader {
    /// Path of the shader's root file, without the folder `kernels/` or `wgsl/` and without the extension.
    pub name: &'static str,
    /// The complete WGSL text.
    #[serde(skip)]
    pub source: &'static str,
    /// The entry points of the shader.
    pub entry_points: &'static [EntryPoint],
    /// The resources that the shader binds.
    pub bindings: &'static [Binding],
    /// The pipeline-overridable constants of the shader.
    pub overrides: &'static [Override],
    /// The structs that bindings and functions of the shader use.
    pub structs: &'static [Struct],
}

/// WGSL to put before your own shader, for programs that do not compose their shaders with WESL. It has functions, structs and
/// constants, but no entry points, bindings or override constants. No two modules declare the same name.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Module {
    /// Name of the folder below `wgsl/`: `animation`, `skinning`, `surface` or `terrain`.
    pub name: &'static str,
    /// The complete WGSL text, with a comment on every declaration.
    #[serde(skip)]
    pub source: &'static str,
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
