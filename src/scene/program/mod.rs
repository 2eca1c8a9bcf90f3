//! The shader of a kind of object, from the caller's text.

// Both are build.rs's, which uses more of them.
#[allow(dead_code)]
#[path = "../../../build/entries.rs"]
pub(crate) mod entries;
#[allow(dead_code)]
#[path = "../../../build/prefix.rs"]
pub(crate) mod prefix;

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use naga::valid::ModuleInfo;
use naga::{AddressSpace, Handle, ImageClass, Module, ScalarKind, Span, StorageAccess, TypeInner};

use crate::InputError;
use crate::gpu::Gpu;
use crate::gpu::shaders::{SCENE_CORE, SCENE_OUTPUTS};
use crate::scene::caller_text::{CallerText, PREFIX, discard_in, without_comments};
use entries::{KindText, OutputText, composed, fragments};
use prefix::{declarations, prefixed_behind};

/// The bind group of a kind's own resources.
const GROUP: u32 = 2;

/// The shader of a [`Kind`](crate::scene::kind::Kind): the caller's WGSL, checked, with entry points for every layer.
///
/// Clones share one shader, and with it the pipelines that renderers compile.
#[derive(Debug, Clone)]
pub struct KindProgram(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    name: String,
    text: String,
    /// Whether vertices move in the model's space.
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
    /// Checks a text and writes its entry points. It needs no device, and compiles nothing.
    ///
    /// `name` is what the names begin with that the text declares at module scope: `grass_bend`, `GRASS_HEIGHT`, `GrassBlade`.
    /// The text has two functions, and a third if vertices move in the model's space:
    ///
    /// ```wgsl
    /// // Where an instance has a vertex: the entry says which instance, the vertex is an index of the index buffer.
    /// fn NAME_place(entry: u32, vertex: u32) -> relievo_SceneVertex
    /// // What is seen of a fragment. It must not discard, and runs in uniform control flow.
    /// fn NAME_surface(in: relievo_SceneFragment) -> Surface
    /// // Where the vertex was in the last frame, relative to the corner of the view's cell.
    /// fn NAME_last_position(entry: u32, vertex: u32) -> vec3<f32>
    /// ```
    ///
    /// Its resources are in bind group 2: uniform buffers, storage buffers that are read, textures and samplers. The crate's
    /// own names begin with `relievo_`. These are what a kind uses, with that prefix:
    ///
    /// ```wgsl
    #[doc = include_str!("../../../wgsl/render/scene_kind.wgsl")]
    #[doc = ""]
    #[doc = include_str!("../../../wgsl/render/scene_instances.wgsl")]
    /// ```
    ///
    /// `Surface` is that of [`Renderer::with_shading`](crate::render::Renderer::with_shading).
    ///
    /// Of WebGPU's default limits for a stage, the crate's part is 3 storage buffers, 3 uniform buffers, 1 texture and 1
    /// sampler; a caller's shading may need some of the rest in the fragment stage.
    ///
    /// # Errors
    /// [`InputError`] for the first mistake, with the path `kind:LINE:COLUMN`, both counted from 1, and for a name that is not
    /// one of lower-case letters, digits and underscores (`kind.name`).
    pub fn new(name: &str, source: &str) -> Result<Self, InputError> {
        let is_letter =
            |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
        if !name.starts_with(|letter: char| letter.is_ascii_lowercase()) || !name.chars().all(is_letter) {
            let bound = "must be lower-case letters, digits and underscores, and begin with a letter";
            return Err(InputError::new("kind.name", format!("`{name}`"), bound));
        }
        let code = without_comments(source);
        let declared = declarations(&code);
        let declares = |what: &str| {
            let wanted = format!("{name}_{what}");
            declared.iter().any(|range| code[range.clone()] == wanted)
        };
        let kind =
            KindText { name, discards: true, blends: true, deep: true, moves: declares("last_position") };
        let text = format!("{source}\n{}", composed(&kind, SCENE_CORE, SCENE_OUTPUTS));
        let own = CallerText { path: "kind", source, text: &text };
        for range in &declared {
            if !is_of(name, &code[range.clone()]) {
                let bound = format!("must begin with `{name}`, as every name that the text declares");
                return Err(own.refused(std::iter::once(span(range)), bound));
            }
        }
        for what in ["place", "surface"] {
            if !declares(what) {
                let error = own.refused(std::iter::empty(), signature(name, what));
                return Err(InputError { value: format!("no function `{name}_{what}`"), ..error });
            }
        }
        let in_own = |error: InputError| own.explained(name, error);
        let module = own.parsed().map_err(in_own)?;
        let info = own.validated(&module).map_err(in_own)?;
        check(&own, &module)?;
        let entries = bound(&own, &module, &info)?;
        let moves = kind.moves;
        Ok(Self(Arc::new(Inner { name: name.to_owned(), text: text.clone(), moves, entries })))
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The WGSL, which ends with the function `shade`.
    pub(crate) fn text(&self) -> &str {
        &self.0.text
    }

    /// What its entry points are generated from.
    pub(crate) fn kind(&self) -> KindText<'_> {
        KindText { name: &self.0.name, discards: true, blends: true, deep: true, moves: self.0.moves }
    }

    /// A kind that shows nothing.
    pub(crate) fn least() -> Result<Self, InputError> {
        Self::new("least", LEAST)
    }

    /// The layout of bind group 2: what the text binds, visible where entry points use it.
    pub fn layout(&self, gpu: &Gpu) -> wgpu::BindGroupLayout {
        gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(&self.0.name),
            entries: &self.0.entries,
        })
    }

    /// Bind group 2, from the resources of its bindings in any order, for a [`KindPart`](crate::scene::kind::KindPart).
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`] for a resource that does not fit.
    pub fn bind(
        &self,
        gpu: &Gpu,
        resources: &[(u32, wgpu::BindingResource<'_>)],
    ) -> Result<wgpu::BindGroup, crate::Error> {
        let entries: Vec<_> = (resources.iter())
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding: *binding, resource: resource.clone() })
            .collect();
        let layout = self.layout(gpu);
        let descriptor =
            wgpu::BindGroupDescriptor { label: Some(&self.0.name), layout: &layout, entries: &entries };
        Ok(gpu.scoped(|| gpu.device().create_bind_group(&descriptor))?)
    }
}

const LEAST: &str = "
fn least_place(entry: u32, vertex: u32) -> relievo_SceneVertex {
    return relievo_scene_placed(entry, vec3<f32>(), vec3<f32>(), vec4<f32>(), vec4<f32>());
}
fn least_surface(in: relievo_SceneFragment) -> Surface {
    return relievo_scene_surface(in);
}
";

/// The function that the caller's shading replaces: the last one of every shader.
const SHADE: &str = "fn shade(";

/// The shader of a kind with an output of the caller's: `source` in front, and entry points for it.
pub(crate) fn with_output(
    shader: &str,
    kind: &KindText<'_>,
    source: &str,
    output: &OutputText<'_>,
) -> String {
    let (ours, shade) = shader.split_at(shader.find(SHADE).unwrap_or(shader.len()));
    format!("{source}\n{ours}\n{}\n{shade}", prefixed_behind(shader, &fragments(kind, output)))
}

/// Whether a text may declare a name: `grass_bend`, `GRASS_HEIGHT` and `GrassBlade` are of `grass`.
pub(crate) fn is_of(kind: &str, name: &str) -> bool {
    let plain = |text: &str| text.replace('_', "").to_lowercase();
    plain(name).starts_with(&plain(kind)) && !name.starts_with(PREFIX)
}

fn span(range: &std::ops::Range<usize>) -> Span {
    Span::new(range.start as u32, range.end as u32)
}

/// The function that a text must have.
fn signature(name: &str, what: &str) -> String {
    let rest = match what {
        "place" => "(entry: u32, vertex: u32) -> relievo_SceneVertex",
        "surface" => "(in: relievo_SceneFragment) -> Surface",
        _ => "(entry: u32, vertex: u32) -> vec3<f32>",
    };
    format!("must be `fn {name}_{what}{rest}`")
}

impl CallerText<'_> {
    /// An error of naga's: one outside of the caller's text is in an entry point, which calls a function of another form.
    fn explained(&self, name: &str, error: InputError) -> InputError {
        let end = self.refused(std::iter::empty(), String::new());
        if error.path != end.path {
            return error;
        }
        let forms = ["place", "surface", "last_position"].map(|what| signature(name, what));
        let bound = format!("{} (the functions {})", error.bound, forms.join(", "));
        InputError { value: "a function of another form".to_owned(), bound, ..error }
    }
}

/// What a valid text must not do here.
fn check(own: &CallerText<'_>, module: &Module) -> Result<(), InputError> {
    let refuse = |at: Span, bound: &str| Err(own.refused(std::iter::once(at), bound.to_owned()));
    if let Some(entry) = module.entry_points.iter().find(|entry| !entry.name.starts_with(PREFIX)) {
        let at = own.source.find(&entry.name).unwrap_or(0);
        return refuse(span(&(at..at + entry.name.len())), "must not be an entry point: these are generated");
    }
    for (handle, _) in module.overrides.iter() {
        let at = module.overrides.get_span(handle);
        if own.is_in(&at) {
            return refuse(at, "must not be an override constant");
        }
    }
    for (handle, function) in module.functions.iter() {
        if let Some(at) = discard_in(&function.body).filter(|_| own.is_in(&module.functions.get_span(handle)))
        {
            return refuse(
                at,
                "must not discard: parts that are cut out leave out pixels (KindPart::cut_out)",
            );
        }
    }
    Ok(())
}

/// The entries of bind group 2: what the text binds, visible where it is used.
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
        entries.push(wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None });
    }
    entries.sort_by_key(|entry| entry.binding);
    Ok(entries)
}

/// What a layout says of a variable; `None` for what kinds do not bind.
fn layout_type(
    module: &Module,
    info: &ModuleInfo,
    handle: Handle<naga::GlobalVariable>,
) -> Option<wgpu::BindingType> {
    let variable = &module.global_variables[handle];
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
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
