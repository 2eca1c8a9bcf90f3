//! The caller's shading: a WGSL text with a function `shade` that replaces the crate's own.
//!
//! The text stands in front of the crate's, so that every message about it has the caller's own lines. The crate's names
//! begin with [`PREFIX`] there; only `Surface` and `View` do not.

use std::borrow::Cow;

use naga::front::wgsl::parse_str;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Block, Function, GlobalVariable, Handle, Module, Span, Statement, Type, TypeInner};

use crate::gpu::shaders::{RENDER_SCENE_MESH, Shader};
use crate::gpu::{Gpu, GpuError};
use crate::render::format::TargetFormat;
use crate::render::layer::Layer;
use crate::scene::layouts::SceneLayouts;
use crate::{Error, InputError};

/// What the crate's names begin with beside the caller's text.
pub(super) const PREFIX: &str = "relievo_";

/// Where the function begins that the caller's text replaces. It is the last one of each shader.
const REPLACED: &str = "fn shade(";

/// The bind group that belongs to the caller.
const OWN_GROUP: u32 = 3;

/// A checked text.
#[derive(Debug, Clone)]
pub(super) struct Shading {
    source: String,
    /// The layout of bind group 3.
    pub layout: Option<wgpu::BindGroupLayout>,
}

impl Shading {
    /// Checks a text. Without a layout it must not bind anything.
    ///
    /// # Errors
    /// [`InputError`] whose path is `shading:LINE:COLUMN`, both counted from 1.
    pub fn new(source: &str, layout: Option<&wgpu::BindGroupLayout>) -> Result<Self, InputError> {
        let text = with_structures(source);
        let own = Own { source, text: &text };
        let module = parse_str(&text)
            .map_err(|error| own.refused(error.labels().map(|(span, _)| span), error.message().to_owned()))?;
        own.check_names()?;
        own.check(&module, layout.is_some())?;
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
        validator.validate(&module).map_err(|error| {
            // A function, and in it the place: the shortest is the most exact.
            let mut spans: Vec<Span> = error.spans().map(|(span, _)| *span).collect();
            spans.sort_by_key(|span| span.to_range().map_or(usize::MAX, |range| range.len()));
            own.refused(spans.into_iter(), chain(error.as_inner()))
        })?;
        Ok(Self { source: source.to_owned(), layout: layout.cloned() })
    }

    /// The same text with another layout of bind group 3.
    pub fn with_layout(self, layout: &wgpu::BindGroupLayout) -> Self {
        Self { layout: Some(layout.clone()), ..self }
    }

    /// Checks the layout of bind group 3 against what the text binds, and that the device's limits allow it beside the crate's
    /// own groups: compiles the text alone. In a browser the device tells the errors later.
    ///
    /// # Errors
    /// [`InputError`] for `shading.layout`, with what wgpu says; [`GpuError`] for other failures of the device.
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
        for groups in [layouts.of_mesh(), layouts.of_relief(), layouts.of_terrain()] {
            let groups: Vec<_> = groups.into_iter().chain([own]).map(Some).collect();
            let compiled = gpu.scoped_with(|| self.compile(gpu, format, &groups));
            let compiled = compiled.map_err(|error| match error {
                GpuError::Validation { reason } => {
                    let bound = format!("must fit the text and the device's limits: {reason}");
                    InputError::new("shading.layout", "bind group 3", bound).into()
                }
                error => Error::from(error),
            })?;
            if compiled.is_none() {
                let bound = "must be of the renderer's device";
                return Err(InputError::new("shading.layout", "of another wgpu::Instance", bound).into());
            }
        }
        Ok(())
    }

    /// Compiles the text with entry points that draw nothing.
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

    /// The text of a shader that shades as the caller does.
    pub fn text(&self, shader: &'static Shader) -> Cow<'static, str> {
        let ours = shader.source.find(REPLACED).map_or(shader.source, |end| &shader.source[..end]);
        format!("{}\n{ours}", self.source).into()
    }
}

/// A vertex and a fragment stage for a text alone.
const ENTRIES: &str = "
@vertex fn relievo_vertex() -> @builtin(position) vec4<f32> { return vec4<f32>(); }
@fragment fn relievo_fragment() -> @location(0) vec4<f32> { return shade(Surface(), View()); }
";

/// A text of the caller's with the structs that it uses.
fn with_structures(source: &str) -> String {
    format!("{source}\n{}\n{}\n", structure("Surface"), structure("View"))
}

/// The declaration of one of the structs that the caller's text uses.
fn structure(name: &str) -> &'static str {
    let text = RENDER_SCENE_MESH.source;
    let start = text.find(&format!("struct {name} {{")).unwrap_or(text.len());
    let end = text[start..].find('}').map_or(text.len(), |end| start + end + 1);
    &text[start..end]
}

/// An error with its causes.
fn chain(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    causes.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}

/// The caller's text, and the one that is parsed, which begins with it.
struct Own<'a> {
    source: &'a str,
    text: &'a str,
}

impl Own<'_> {
    /// The error at the first of these places that lies in the caller's text, else at its end.
    fn refused(&self, spans: impl Iterator<Item = Span>, bound: String) -> InputError {
        let mut ranges = spans.filter_map(Span::to_range);
        let range = ranges.find(|range| range.start < self.source.len());
        let range = range.unwrap_or(self.source.len()..self.source.len());
        let before = &self.text[..range.start];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |text| text.chars().count()) + 1;
        let quoted = self.text[range.start..range.end.min(self.source.len())].lines().next();
        let value: String = quoted.unwrap_or_default().chars().take(60).collect();
        InputError::new(format!("shading:{line}:{column}"), value, bound)
    }

    /// What a valid text must not do here.
    fn check(&self, module: &Module, has_layout: bool) -> Result<(), InputError> {
        let at = |span: Span, bound: &str| Err(self.refused([span].into_iter(), bound.to_owned()));
        if let Some((handle, _)) = module.overrides.iter().next() {
            return at(module.overrides.get_span(handle), "must not declare override constants");
        }
        if let Some(entry) = module.entry_points.first() {
            let name = self.source.find(entry.name.as_str()).unwrap_or(0) as u32;
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

    /// Names with the crate's prefix are the crate's. naga drops constants and aliases that nothing uses, so this reads the text.
    fn check_names(&self) -> Result<(), InputError> {
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
        let code = without_comments(self.source);
        let begins = |(at, _): &(usize, &str)| !code[..*at].ends_with(is_part);
        let Some((at, _)) = code.match_indices(PREFIX).find(begins) else { return Ok(()) };
        let length = code[at..].find(|letter| !is_part(letter)).unwrap_or(code.len() - at);
        let span = Span::new(at as u32, (at + length) as u32);
        Err(self.refused([span].into_iter(), OURS.to_owned()))
    }

    /// `shade` must be there, and have the right arguments and result.
    fn check_function(&self, module: &Module) -> Result<(), InputError> {
        let named = |(_, function): &(_, &Function)| function.name.as_deref() == Some("shade");
        let Some((handle, shade)) = module.functions.iter().find(named) else {
            let refused = self.refused(std::iter::empty(), SIGNATURE.to_owned());
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
        Err(self.refused([module.functions.get_span(handle)].into_iter(), SIGNATURE.to_owned()))
    }
}

const SIGNATURE: &str = "must be `fn shade(surface: Surface, view: View) -> vec4<f32>`";

const OURS: &str = "must not begin with `relievo_`, as the crate's own names do";

/// A valid text with spaces in the place of its comments: each byte stays where it is.
fn without_comments(source: &str) -> String {
    let (mut code, mut rest) = (String::with_capacity(source.len()), source);
    while let Some(at) = rest.find("//").into_iter().chain(rest.find("/*")).min() {
        let (before, comment) = rest.split_at(at);
        let length = match comment.starts_with("//") {
            true => comment.find('\n').unwrap_or(comment.len()),
            false => block_comment(comment),
        };
        code.push_str(before);
        code.extend(std::iter::repeat_n(' ', length));
        rest = &comment[length..];
    }
    code + rest
}

/// The length of the block comment with which a text begins. Such comments nest.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while let Some(mark) = text[at..].find("/*").into_iter().chain(text[at..].find("*/")).min() {
        depth += if text[at + mark..].starts_with("/*") { 1 } else { -1 };
        at += mark + 2;
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

/// Why a variable of module scope is refused.
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

/// Where a block discards.
fn discard_in(block: &Block) -> Option<Span> {
    block.span_iter().find_map(|(statement, span)| match statement {
        Statement::Kill => Some(*span),
        Statement::Block(block) => discard_in(block),
        Statement::If { accept, reject, .. } => discard_in(accept).or_else(|| discard_in(reject)),
        Statement::Switch { cases, .. } => cases.iter().find_map(|case| discard_in(&case.body)),
        Statement::Loop { body, continuing, .. } => discard_in(body).or_else(|| discard_in(continuing)),
        _ => None,
    })
}
