//! The flat, validated WGSL of every pass, with what its bindings are. Written by `build.rs`.

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

/// A function that a pipeline starts in.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct EntryPoint {
    /// The function's name.
    pub name: &'static str,
    /// Its stage.
    pub stage: Stage,
    /// Invocations a workgroup; zeros outside compute.
    pub workgroup_size: [u32; 3],
}

/// What a binding takes.
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
    /// A float texture, 2-D, of which the shader only loads texels: any float format.
    LoadedTexture,
    /// A filtering sampler.
    Sampler,
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
    /// What it takes.
    pub kind: BindingKind,
    /// The stages that use it.
    pub stages: &'static [Stage],
}

/// A struct of a shader, as naga lays it out.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Struct {
    /// Its name.
    pub name: &'static str,
    /// Bytes.
    pub size: u32,
    /// Names and byte offsets.
    pub members: &'static [(&'static str, u32)],
}

/// A flat WGSL shader.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Shader {
    /// The path of its root file without `kernels/` or `wgsl/` and extension.
    pub name: &'static str,
    /// WGSL.
    #[serde(skip)]
    pub source: &'static str,
    /// Where pipelines start.
    pub entry_points: &'static [EntryPoint],
    /// What it binds.
    pub bindings: &'static [Binding],
    /// Names of its pipeline-overridable constants.
    pub overrides: &'static [&'static str],
    /// Its structs.
    #[serde(skip)]
    pub structs: &'static [Struct],
}

/// WGSL to put before your own shader, for programs that do not compose theirs with WESL: functions and structs
/// without entry points or bindings.
#[derive(Debug, Clone, Copy)]
pub struct Module {
    /// The folder below `wgsl/`.
    pub name: &'static str,
    /// WGSL.
    pub source: &'static str,
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
