//! Shaders of caller-defined kinds.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use naga::valid::ModuleInfo;
use naga::{AddressSpace, Handle, ImageClass, Module, ScalarKind, StorageAccess, TypeInner};

use crate::InputError;
use crate::gpu::shaders::{SCENE_CORE, SCENE_OUTPUTS};
use crate::gpu::{Gpu, GpuError};
use crate::scene::caller_text::{CallerText, without_comments};
use crate::scene::wgsl::entries::{KindText, OutputText, composed, exports, fragments};
use crate::scene::wgsl::prefix::{declared_names, prefixed_with};

/// Index of the bind group with the resources of a caller-defined kind.
const GROUP: u32 = 2;

/// The shader of a [`Kind`](crate::scene::kind::Kind): the caller's checked WGSL, with entry points for every layer.
///
/// Clones share one shader, and the pipelines that renderers compile from it.
#[derive(Debug, Clone)]
pub struct KindProgram(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    name: String,
    text: String,
    /// Names that the text declares.
    declared: Vec<String>,
    /// Whether vertices move in model space. If so, the text has a function for the last position.
    moves: bool,
    entries: Vec<wgpu::BindGroupLayoutEntry>,
}

impl PartialEq for KindProgram {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for KindProgram {}

impl Hash for KindProgram {
    fn hash<H: Hasher>(&self, state: &mut H) {
        Arc::as_ptr(&self.0).hash(state);
    }
}

impl KindProgram {
    /// Checks the caller's WGSL (`source`) and generates entry points for it. No device is needed, and nothing is
    /// compiled.
    ///
    /// All names that the text declares begin with `name`. For the name `grass`, examples are `grass_bend`,
    /// `GRASS_HEIGHT` and `GrassBlade`. The text must have two functions, and a third if vertices move in model space:
    ///
    /// ```wgsl
    /// // The vertex of an instance. `entry` identifies the instance; `vertex` is a value of the index buffer.
    /// fn NAME_place(entry: u32, vertex: u32) -> relievo_SceneVertex
    /// // The visible surface at a fragment. This function must not discard, and runs in uniform control flow.
    /// fn NAME_surface(in: relievo_SceneFragment) -> Surface
    /// // The position of the vertex in the last frame, relative to the corner of the view's cell.
    /// fn NAME_last_position(entry: u32, vertex: u32) -> vec3<f32>
    /// ```
    ///
    /// The text may bind resources in bind group 2: uniform buffers, read-only storage buffers, textures and samplers.
    /// The text can use these names of the crate, which start with `relievo_`:
    ///
    /// ```wgsl
    /// // A vertex. Positions are relative to the corner of the view's cell.
    /// struct relievo_SceneVertex {
    ///     position: vec3<f32>,
    ///     normal: vec3<f32>,   // outwards, of any length but 0
    ///     tangent: vec4<f32>,  // xyz: along u; w: for unit vectors, the bitangent along v is w · normal × tangent
    ///     uv: vec4<f32>,       // two sets of texture coordinates
    ///     values: vec4<f32>,   // free for the kind; interpolated
    ///     words: vec3<u32>,    // free for the kind; the same at all vertices of a triangle
    ///     side: f32,           // -1 if the placement mirrors, else 1
    /// }
    ///
    /// // A fragment: the interpolated values of its vertices, and facts about its instance.
    /// struct relievo_SceneFragment {
    ///     position: vec3<f32>,
    ///     normal: vec3<f32>,
    ///     tangent: vec4<f32>,
    ///     uv: vec4<f32>,
    ///     values: vec4<f32>,
    ///     words: vec3<u32>,
    ///     instance: u32,             // counted from the object's first one
    ///     last_position: vec3<f32>,  // the position in the last frame if the layer needs motion; else `position`
    ///     clip: vec4<f32>,           // the position in the target in pixels, and the depth
    ///     is_outside: bool,          // whether the outer side of the triangle is seen
    ///     level: u32,                // level of detail of the instance, from 0 for the finest
    ///     fade: f32,                 // alpha of an instance that is blended while it fades; else 1
    /// }
    /// ```
    ///
    /// | function | |
    /// |---|---|
    /// | `relievo_scene_placed(entry, position, normal, tangent, uv) -> relievo_SceneVertex` | transforms a vertex in model space by the instance's placement |
    /// | `relievo_scene_surface(fragment) -> Surface` | a white, opaque surface on the visible side, with the instance's tint, user data and numbers; its colour does not contain the tint yet |
    /// | `relievo_scene_last_placed(entry, position) -> vec3<f32>` | position of a model-space point in the last frame |
    /// | `relievo_scene_last_rigid(entry, position) -> vec3<f32>` | last frame's position of a placed point that does not move in model space |
    ///
    /// `relievo_view` holds the uniforms of the view: `clip_from_world`, `eye`, `light`. `Surface` is defined in
    /// [`Renderer::with_shading`](crate::render::Renderer::with_shading).
    ///
    /// WebGPU limits the bindings of each shader stage. Of the default limits, the crate uses 3 storage buffers (4 in
    /// the vertex stage), 2 uniform buffers, 1 texture and 1 sampler. A kind and the caller's shading share the rest:
    /// 5 storage buffers, 10 uniform buffers, 15 textures and 15 samplers in the fragment stage.
    ///
    /// # Errors
    /// [`InputError`] for the first mistake in the text. The error's path is `kind:LINE:COLUMN`, with line and column
    /// counted from 1. [`InputError`] also for a name (`kind.name`) with anything but lower-case letters, digits and
    /// underscores.
    pub fn new(name: &str, source: &str) -> Result<Self, InputError> {
        let is_letter =
            |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
        if !name.starts_with(|letter: char| letter.is_ascii_lowercase()) || !name.chars().all(is_letter) {
            let bound = "must be lower-case letters, digits and underscores, and begin with a letter";
            return Err(InputError::new("kind.name", format!("`{name}`"), bound));
        }
        let code = without_comments(source);
        let declared = declared_names(&code);
        let declares = |what: &str| declared.contains(&format!("{name}_{what}"));
        let kind = KindText { name, blends: true, deep: true, moves: declares("last_position") };
        // Comments are blanked, so that nothing in them is taken for code. All code keeps its line and column.
        let text = format!("{code}\n{}", composed(&kind, SCENE_CORE, SCENE_OUTPUTS));
        let own = CallerText { path: "kind", source, text: &text };
        own.check_declarations(name)?;
        for what in ["place", "surface"] {
            if !declares(what) {
                let error = own.refused(std::iter::empty(), signature(name, what));
                return Err(InputError { value: format!("no function `{name}_{what}`"), ..error });
            }
        }
        let module = own.parsed().map_err(|error| own.explained(name, error))?;
        own.check(&module)?;
        let info = own.validated(&module).map_err(|error| own.explained(name, error))?;
        let entries = bound(&own, &module, &info)?;
        let moves = kind.moves;
        Ok(Self(Arc::new(Inner { name: name.to_owned(), text, declared, moves, entries })))
    }

    /// The kind's name, as given to [`KindProgram::new`].
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The complete WGSL of the kind, which ends with the function `shade`.
    pub(crate) fn text(&self) -> &str {
        &self.0.text
    }

    /// Names that the text declares.
    pub(crate) fn declared(&self) -> &[String] {
        &self.0.declared
    }

    /// Facts about the kind from which its entry points are generated.
    pub(crate) fn kind(&self) -> KindText<'_> {
        KindText { name: &self.0.name, blends: true, deep: true, moves: self.0.moves }
    }

    /// A program without bindings, which draws nothing.
    pub(crate) fn least() -> Result<Self, InputError> {
        Self::new("least", LEAST)
    }

    /// The layout of bind group 2: all resources that the text binds, each visible to the shader stages that use it.
    ///
    /// # Errors
    /// [`GpuError`] if the text binds more resources than the device allows.
    pub fn layout(&self, gpu: &Gpu) -> Result<wgpu::BindGroupLayout, GpuError> {
        gpu.scoped(|| {
            gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(&self.0.name),
                entries: &self.0.entries,
            })
        })
    }

    /// Creates bind group 2 for a [`KindPart`](crate::scene::kind::KindPart). The entries may be in any order.
    ///
    /// # Errors
    /// [`GpuError`] for a resource that does not fit its binding.
    pub fn bind(&self, gpu: &Gpu, entries: &[wgpu::BindGroupEntry<'_>]) -> Result<wgpu::BindGroup, GpuError> {
        let layout = self.layout(gpu)?;
        let descriptor = wgpu::BindGroupDescriptor { label: Some(&self.0.name), layout: &layout, entries };
        gpu.scoped(|| gpu.device().create_bind_group(&descriptor))
    }
}

/// WGSL of a kind that draws nothing and binds no resources.
pub(crate) const LEAST: &str = "
fn least_place(entry: u32, vertex: u32) -> relievo_SceneVertex {
    return relievo_scene_placed(entry, vec3<f32>(), vec3<f32>(), vec4<f32>(), vec4<f32>());
}
fn least_surface(in: relievo_SceneFragment) -> Surface {
    return relievo_scene_surface(in);
}
";

/// The shader of a kind for an output that the caller defines: the text of the output, then the kind's text with entry
/// points for that output.
pub(crate) fn with_output(program: &Program<'_>, source: &str, output: &OutputText) -> String {
    let Program { text, kind, is_own } = program;
    let mut kept = vec![output.targets(), format!("{}_write", output.name)];
    if *is_own {
        kept.extend(exports(kind));
    }
    format!("{source}\n{}", prefixed_with(text, &fragments(kind, output), &kept))
}

/// The shader of a kind: its WGSL (`text`), the facts from which entry points are generated (`kind`), and whether the
/// caller wrote it (`is_own`).
pub(crate) struct Program<'a> {
    pub text: &'a str,
    pub kind: KindText<'a>,
    pub is_own: bool,
}

/// The signature of a function that the caller's text must have, for error messages.
fn signature(name: &str, what: &str) -> String {
    let rest = match what {
        "place" => "(entry: u32, vertex: u32) -> relievo_SceneVertex",
        "surface" => "(in: relievo_SceneFragment) -> Surface",
        _ => "(entry: u32, vertex: u32) -> vec3<f32>",
    };
    format!("must be `fn {name}_{what}{rest}`")
}

impl CallerText<'_> {
    /// Adds the required signatures to an error of naga about a type mismatch outside the caller's text. Such an error is
    /// in a generated entry point, because a function of the caller that it calls has a wrong signature.
    fn explained(&self, name: &str, error: InputError) -> InputError {
        let end = self.refused(std::iter::empty(), String::new());
        let is_of_types = ["Call to", "type"].iter().any(|word| error.bound.contains(word));
        if error.path != end.path || !is_of_types {
            return error;
        }
        let forms = ["place", "surface", "last_position"].map(|what| signature(name, what));
        let bound = format!("{} (the functions {})", error.bound, forms.join(", "));
        InputError { value: "a function of another form".to_owned(), bound, ..error }
    }
}

/// Layout entries of bind group 2: all resources that the caller's text binds, each visible to the shader stages that
/// use it.
fn bound(
    own: &CallerText<'_>,
    module: &Module,
    info: &ModuleInfo,
) -> Result<Vec<wgpu::BindGroupLayoutEntry>, InputError> {
    let mut entries = Vec::new();
    for (handle, variable) in module.global_variables.iter() {
        let at = module.global_variables.get_span(handle);
        let refuse = |bound: &str| Err(own.refused(std::iter::once(at), bound.to_owned()));
        let Some(binding) = variable.binding.as_ref().filter(|_| own.is_in(&at)) else { continue };
        if binding.group != GROUP {
            return refuse("must be in bind group 2: groups 0, 1 and 3 are not the kind's");
        }
        let Some(ty) = layout_type(module, info, handle) else {
            return refuse(
                "must be a uniform, a storage buffer that is read, a sampled texture or a sampler",
            );
        };
        let mut visibility = wgpu::ShaderStages::NONE;
        for (index, entry) in module.entry_points.iter().enumerate() {
            if !info.get_entry_point(index)[handle].is_empty() {
                visibility |= match entry.stage {
                    naga::ShaderStage::Vertex => wgpu::ShaderStages::VERTEX,
                    _ => wgpu::ShaderStages::FRAGMENT,
                };
            }
        }
        let binding = binding.binding;
        if entries.iter().any(|entry: &wgpu::BindGroupLayoutEntry| entry.binding == binding) {
            return refuse("must have a binding of its own");
        }
        entries.push(wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None });
    }
    entries.sort_by_key(|entry| entry.binding);
    Ok(entries)
}

/// The binding type of a variable; `None` if kinds cannot bind variables of that type.
fn layout_type(
    module: &Module,
    info: &ModuleInfo,
    handle: Handle<naga::GlobalVariable>,
) -> Option<wgpu::BindingType> {
    let variable = &module.global_variables[handle];
    let size = u64::from(module.types[variable.ty].inner.size(module.to_ctx()));
    let min_binding_size = std::num::NonZeroU64::new(size);
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size };
    Some(match (variable.space, &module.types[variable.ty].inner) {
        (AddressSpace::Uniform, _) => buffer(wgpu::BufferBindingType::Uniform),
        (AddressSpace::Storage { access }, _) if !access.contains(StorageAccess::STORE) => {
            buffer(wgpu::BufferBindingType::Storage { read_only: true })
        }
        (AddressSpace::Handle, TypeInner::Image { dim, arrayed, class }) => {
            let view_dimension = match (dim, arrayed) {
                (naga::ImageDimension::D1, _) => wgpu::TextureViewDimension::D1,
                (naga::ImageDimension::D2, false) => wgpu::TextureViewDimension::D2,
                (naga::ImageDimension::D2, true) => wgpu::TextureViewDimension::D2Array,
                (naga::ImageDimension::D3, _) => wgpu::TextureViewDimension::D3,
                (naga::ImageDimension::Cube, false) => wgpu::TextureViewDimension::Cube,
                (naga::ImageDimension::Cube, true) => wgpu::TextureViewDimension::CubeArray,
            };
            let is_sampled = (0..module.entry_points.len())
                .any(|entry| info.get_entry_point(entry).sampling_set.iter().any(|key| key.image == handle));
            let (sample_type, multisampled) = match *class {
                ImageClass::Sampled { kind: ScalarKind::Sint, multi } => {
                    (wgpu::TextureSampleType::Sint, multi)
                }
                ImageClass::Sampled { kind: ScalarKind::Uint, multi } => {
                    (wgpu::TextureSampleType::Uint, multi)
                }
                ImageClass::Sampled { multi, .. } => {
                    (wgpu::TextureSampleType::Float { filterable: is_sampled }, multi)
                }
                ImageClass::Depth { multi } => (wgpu::TextureSampleType::Depth, multi),
                _ => return None,
            };
            wgpu::BindingType::Texture { sample_type, view_dimension, multisampled }
        }
        (AddressSpace::Handle, TypeInner::Sampler { comparison }) => {
            wgpu::BindingType::Sampler(match comparison {
                true => wgpu::SamplerBindingType::Comparison,
                false => wgpu::SamplerBindingType::Filtering,
            })
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test's kind uses every documented name, and every field in the documented order.
    #[test]
    fn every_name_of_the_documentation_is_there() {
        let text = "
fn all_place(entry: u32, vertex: u32) -> relievo_SceneVertex {
    let placed = relievo_scene_placed(entry, vec3<f32>(), vec3<f32>(), vec4<f32>(), vec4<f32>());
    return relievo_SceneVertex(
        placed.position, placed.normal, placed.tangent, placed.uv, placed.values, placed.words, placed.side);
}
fn all_last_position(entry: u32, vertex: u32) -> vec3<f32> {
    let rigid = relievo_scene_last_rigid(entry, all_place(entry, vertex).position);
    return rigid + relievo_scene_last_placed(entry, vec3<f32>());
}
fn all_surface(in: relievo_SceneFragment) -> Surface {
    let same = relievo_SceneFragment(
        in.position, in.normal, in.tangent, in.uv, in.values, in.words, in.instance, in.last_position, in.clip,
        in.is_outside, in.level, in.fade);
    var surface = relievo_scene_surface(same);
    surface.color = relievo_view.eye.xyz + relievo_view.light.xyz + relievo_view.clip_from_world[0].xyz;
    return surface;
}";
        KindProgram::new("all", text).expect("valid");
    }
}
