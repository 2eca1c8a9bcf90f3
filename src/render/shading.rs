//! The caller's shading: WGSL with a function `shade` that replaces the crate's own.
//!
//! The caller's text is placed before the crate's text ([`CallerText`]).

use naga::{Function, GlobalVariable, Handle, Module, Span, Type, TypeInner};

use crate::gpu::shaders::RENDER_SCENE_MESH;
use crate::gpu::{Gpu, GpuError};
use crate::render::format::TargetFormat;
use crate::render::layer::Layer;
use crate::scene::caller_text::{CallerText, discard_in, without_comments};
use crate::scene::layouts::SceneLayouts;
use crate::scene::specialization::Program;
use crate::scene::wgsl::prefix::declared_names;
use crate::{Error, InputError};

/// Start of the crate's function that the caller's text replaces. This function is the last one of each shader.
const REPLACED: &str = "fn shade(";

/// Index of the caller's bind group.
const OWN_GROUP: u32 = 3;

/// Checked WGSL of the caller's shading.
#[derive(Debug, Clone)]
pub(super) struct Shading {
    source: String,
    /// The names that the text declares.
    declared: Vec<String>,
    /// Layout of bind group 3, if the text may bind resources.
    pub layout: Option<wgpu::BindGroupLayout>,
}

impl Shading {
    /// Checks the WGSL of a shading. Without a layout, the text must not bind resources.
    ///
    /// # Errors
    /// [`InputError`] whose path is `shading:LINE:COLUMN`. Lines and columns are counted from 1.
    pub fn new(source: &str, layout: Option<&wgpu::BindGroupLayout>) -> Result<Self, InputError> {
        let text = with_structures(source);
        let own = Own(CallerText { path: "shading", source, text: &text });
        let module = own.0.parsed()?;
        own.0.check_names()?;
        own.check(&module, layout.is_some())?;
        own.0.validated(&module)?;
        let code = without_comments(source);
        Ok(Self { source: source.to_owned(), declared: declared_names(&code), layout: layout.cloned() })
    }

    /// The names that the text declares.
    pub fn declared(&self) -> &[String] {
        &self.declared
    }

    /// This shading with another layout of bind group 3.
    pub fn with_layout(self, layout: &wgpu::BindGroupLayout) -> Self {
        Self { layout: Some(layout.clone()), ..self }
    }

    /// Checks the layout of bind group 3 against the text's bindings, and against the device's limits together with the crate's
    /// own groups. For these checks, the text is compiled alone. In a browser, the device reports errors later.
    ///
    /// # Errors
    /// [`InputError`] for `shading.layout`, with wgpu's message; [`GpuError`] for other failures of the device.
    pub fn check_layout(
        &self,
        gpu: &Gpu,
        format: &TargetFormat,
        layouts: &SceneLayouts,
    ) -> Result<(), Error> {
        let Some(own) = self.layout.as_ref().filter(|_| format.layers().any(|layer| layer == Layer::Color))
        else {
            return Ok(());
        };
        for program in [Program::Mesh, Program::Relief, Program::Terrain] {
            let groups = layouts.of(gpu, &program)?;
            let groups: Vec<_> = groups.iter().chain([own]).map(Some).collect();
            let compiled = gpu.scoped_with(|| self.compile(gpu, format, &groups));
            let compiled = compiled.map_err(|error| match error {
                GpuError::Validation { reason } => {
                    let bound = format!("must fit the text and the device's limits: {reason}");
                    InputError::new("shading.layout", "bind group 3", bound).into()
                }
                error => Error::from(error),
            })?;
            let bound = || "must be of the renderer's device";
            InputError::check(compiled.is_some(), "shading.layout", "of another wgpu::Instance", bound)?;
        }
        Ok(())
    }

    /// Compiles the text with entry points that do no work.
    fn compile(&self, gpu: &Gpu, format: &TargetFormat, groups: &[Option<&wgpu::BindGroupLayout>]) {
        let (device, label) = (gpu.device(), Some("shading"));
        let source = wgpu::ShaderSource::Wgsl(format!("{}{ENTRIES}", with_structures(&self.source)).into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let layout = wgpu::PipelineLayoutDescriptor { label, bind_group_layouts: groups, immediate_size: 0 };
        let _ = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label,
            layout: Some(&device.create_pipeline_layout(&layout)),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: format.depth_state(Layer::Color),
            multisample: wgpu::MultisampleState { count: format.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &format.targets(Layer::Color),
            }),
            multiview_mask: None,
            cache: None,
        });
    }

    /// The source of a shader, with the caller's shading in place of the crate's.
    pub fn text(&self, shader: &str) -> String {
        let ours = shader.rfind(REPLACED).map_or(shader, |end| &shader[..end]);
        format!("{}\n{ours}", self.source)
    }
}

/// Vertex and fragment entry points with which the caller's text compiles alone.
const ENTRIES: &str = "
@vertex fn relievo_vertex() -> @builtin(position) vec4<f32> { return vec4<f32>(); }
@fragment fn relievo_fragment() -> @location(0) vec4<f32> { return shade(Surface(), View()); }
";

/// The caller's text, followed by the crate's structs that it uses.
fn with_structures(source: &str) -> String {
    format!("{source}\n{}\n{}\n", structure("Surface"), structure("View"))
}

/// WGSL declaration of one of the crate's structs that the caller's text uses.
fn structure(name: &str) -> &'static str {
    let text = RENDER_SCENE_MESH.source;
    let start = text.find(&format!("struct {name} {{")).unwrap_or(text.len());
    let end = text[start..].find('}').map_or(text.len(), |end| start + end + 1);
    &text[start..end]
}

/// The caller's text with the crate's structs that it uses.
struct Own<'a>(CallerText<'a>);

impl Own<'_> {
    /// Checks the restrictions of shading that go beyond valid WGSL.
    fn check(&self, module: &Module, has_layout: bool) -> Result<(), InputError> {
        let at = |span: Span, bound: &str| Err(self.0.refused([span].into_iter(), bound.to_owned()));
        if let Some((handle, _)) = module.overrides.iter().next() {
            return at(module.overrides.get_span(handle), "must not declare override constants");
        }
        if let Some(entry) = module.entry_points.first() {
            let name = self.0.source.find(entry.name.as_str()).unwrap_or(0) as u32;
            let span = Span::new(name, name + entry.name.len() as u32);
            return at(span, "must not declare entry points");
        }
        for (handle, variable) in module.global_variables.iter() {
            if let Some(bound) = refused_variable(variable, has_layout) {
                return at(module.global_variables.get_span(handle), bound);
            }
        }
        for (_, function) in module.functions.iter() {
            if let Some(span) = discard_in(&function.body) {
                return at(span, "must not discard: cut-out materials leave out pixels");
            }
        }
        self.check_function(module)
    }

    /// Checks that `shade` exists and has the right parameters and result.
    fn check_function(&self, module: &Module) -> Result<(), InputError> {
        let named = |(_, function): &(_, &Function)| function.name.as_deref() == Some("shade");
        let Some((handle, shade)) = module.functions.iter().find(named) else {
            let refused = self.0.refused(std::iter::empty(), SIGNATURE.to_owned());
            return Err(InputError { value: "no function `shade`".to_owned(), ..refused });
        };
        let is_named = |ty: Handle<Type>, name: &str| module.types[ty].name.as_deref() == Some(name);
        let arguments: Vec<_> = shade.arguments.iter().map(|argument| argument.ty).collect();
        let takes = matches!(arguments[..], [surface, view] if is_named(surface, "Surface") && is_named(view, "View"));
        let is_color = |ty: Handle<Type>| {
            let color = TypeInner::Vector { size: naga::VectorSize::Quad, scalar: naga::Scalar::F32 };
            module.types[ty].inner == color
        };
        if takes && shade.result.as_ref().is_some_and(|result| is_color(result.ty)) {
            return Ok(());
        }
        Err(self.0.refused([module.functions.get_span(handle)].into_iter(), SIGNATURE.to_owned()))
    }
}

const SIGNATURE: &str = "must be `fn shade(surface: Surface, view: View) -> vec4<f32>`";

/// The reason to refuse a module-scope variable of the caller's text; `None` if the variable is allowed.
fn refused_variable(variable: &GlobalVariable, has_layout: bool) -> Option<&'static str> {
    if variable.space == naga::AddressSpace::WorkGroup {
        return Some("must not lie in workgroup memory, which fragment stages do not have");
    }
    let binding = variable.binding.as_ref()?;
    match (binding.group == OWN_GROUP, has_layout) {
        (true, true) => None,
        (true, false) => Some("must not be bound: no layout of bind group 3 was given"),
        (false, _) => Some("must be in bind group 3: groups 0 to 2 are the crate's"),
    }
}
