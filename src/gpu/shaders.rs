//! The flat, validated WGSL of every pass with a description of its bindings, written by `build.rs`.

/// A pipeline stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// `@vertex`
    Vertex,
    /// `@fragment`
    Fragment,
    /// `@compute`
    Compute,
}

/// An entry point of a shader.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct EntryPoint {
    /// The function's name.
    pub name: &'static str,
    /// Its stage.
    pub stage: Stage,
    /// Invocations per workgroup; zeros outside compute.
    pub workgroup_size: [u32; 3],
    /// Its vertex attributes; empty outside vertex stages.
    pub inputs: &'static [Input],
}

/// A vertex attribute.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Input {
    /// Its `@location`.
    pub location: u32,
    /// The argument's name.
    pub name: &'static str,
    /// WGSL's name of its type: `vec3<f32>`.
    #[serde(rename = "type")]
    pub ty: &'static str,
}

/// The kind of resource at a binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum BindingKind {
    /// A uniform buffer.
    Uniform,
    /// A read-only storage buffer.
    StorageRead,
    /// A storage buffer that the shader writes.
    StorageReadWrite,
    /// A filterable float texture, 2-D array.
    TextureArray,
    /// A filterable float texture, 2-D.
    Texture,
    /// A float texture, 2-D, whose texels the shader only loads: any float format.
    LoadedTexture,
    /// A depth texture, 2-D.
    DepthTexture,
    /// A filtering sampler.
    Sampler,
    /// A sampler that compares depths.
    ComparisonSampler,
}

/// A resource that a shader uses.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Binding {
    /// Bind group.
    pub group: u32,
    /// Index in the group.
    pub binding: u32,
    /// The variable's name.
    pub name: &'static str,
    /// The kind of resource.
    pub kind: BindingKind,
    /// WGSL's name of its type: `array<vec4<f32>>`. Structs are among [`Shader::structs`].
    #[serde(rename = "type")]
    pub ty: &'static str,
    /// The stages that use it.
    pub stages: &'static [Stage],
}

/// A struct of a shader, as naga lays it out.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Struct {
    /// Its name.
    pub name: &'static str,
    /// Size in bytes.
    pub size: u32,
    /// Members in the order of their offsets.
    pub members: &'static [Member],
}

/// A member of a struct.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Member {
    /// Its name.
    pub name: &'static str,
    /// Offset from the struct's start, in bytes.
    pub offset: u32,
    /// WGSL's name of its type.
    #[serde(rename = "type")]
    pub ty: &'static str,
}

/// A pipeline-overridable constant.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Override {
    /// Its name.
    pub name: &'static str,
    /// WGSL's name of its type: `bool`, `i32`, `u32` or `f32`.
    #[serde(rename = "type")]
    pub ty: &'static str,
    /// The default value as WebGPU's `constants` take it: 0 or 1 for `bool`.
    pub default: f64,
}

/// A flat WGSL shader.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Shader {
    /// The path of its root file without `kernels/` or `wgsl/` and extension.
    pub name: &'static str,
    /// The WGSL text.
    #[serde(skip)]
    pub source: &'static str,
    /// The entry points.
    pub entry_points: &'static [EntryPoint],
    /// The resources that it binds.
    pub bindings: &'static [Binding],
    /// Its pipeline-overridable constants.
    pub overrides: &'static [Override],
    /// The structs that its bindings and functions use.
    pub structs: &'static [Struct],
}

/// WGSL to put before your own shader, for programs that do not compose theirs with WESL. It has functions, structs and
/// constants, but no entry points, bindings or override constants. No two modules declare the same name.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Module {
    /// The folder below `wgsl/`: `animation`, `skinning`, `surface` or `terrain`.
    pub name: &'static str,
    /// The WGSL text, with a comment on every declaration.
    #[serde(skip)]
    pub source: &'static str,
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
