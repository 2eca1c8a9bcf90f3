//! Caller-defined outputs: colours that the caller's WGSL writes, besides the crate's own layers.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use crate::InputError;
use crate::scene::caller_text::{CallerText, without_comments};
use crate::scene::program::{KindProgram, with_output};
use crate::scene::specialization::Program;
use crate::scene::wgsl::entries::{OutputText, targets_of};
use crate::scene::wgsl::prefix::declared_names;

/// A caller-defined output: colours that the caller's WGSL computes for each surface.
///
/// Use it with [`TargetFormat::of_output`](super::TargetFormat::of_output) and [`Layer::Own`](super::Layer::Own). An output works
/// with every kind of object.
///
/// # Examples
///
/// An output of alpha and texture coordinates, and of velocities in the same pass:
///
/// ```
/// use relievo::render::{OutputProgram, TargetFormat};
/// use wgpu::TextureFormat;
///
/// let uv = OutputProgram::new("uv", "
///     struct UvTargets {
///         @location(0) uv: vec4<f32>,
///         @location(1) velocity: vec4<f32>,
///     }
///     fn uv_write(surface: Surface) -> UvTargets {
///         let now = relievo_view.clip_from_world * vec4<f32>(surface.position, 1.0);
///         let last = relievo_view.last_clip_from_world * vec4<f32>(surface.last_position, 1.0);
///         let moved = 0.5 * (now.xy / now.w - last.xy / last.w);
///         return UvTargets(vec4<f32>(surface.uv, surface.alpha, 1.0), vec4<f32>(moved.x, -moved.y, 0.0, 1.0));
///     }")?;
/// let format = TargetFormat::of_output(&uv, &[TextureFormat::Rgba16Float, TextureFormat::Rg16Float]);
/// format.validate()?;
/// # Ok::<(), relievo::InputError>(())
/// ```
#[derive(Debug, Clone)]
pub struct OutputProgram(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    output: OutputText,
    /// The WGSL without comments.
    code: String,
    /// The names that the WGSL declares.
    declared: Vec<String>,
}

impl PartialEq for OutputProgram {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for OutputProgram {}

impl Hash for OutputProgram {
    fn hash<H: Hasher>(&self, state: &mut H) {
        Arc::as_ptr(&self.0).hash(state);
    }
}

impl OutputProgram {
    /// Creates an output from WGSL, and checks the text. This needs no device and compiles nothing.
    ///
    /// `name` is the prefix of every name that the text declares. For the name `uv`, the text has a struct `UvTargets` and a
    /// function `fn uv_write(surface: Surface) -> UvTargets`, which must not discard. The members of the struct are the colours
    /// at `@location(0)` and so on. [`Renderer::with_shading`](super::Renderer::with_shading) documents the struct `Surface`.
    ///
    /// `surface.last_position` is filled only if the text names it. The output then needs
    /// [`Scene::keep_motion_history`](crate::scene::Scene::keep_motion_history). `relievo_view` is the view (`clip_from_world`,
    /// `last_clip_from_world`, `eye`). `relievo_lit(surface) -> vec4<f32>` returns the shaded colour. The text must not bind
    /// resources.
    ///
    /// # Errors
    /// [`InputError`] for the first mistake in the text, with the path `output:LINE:COLUMN`. Lines and columns are counted
    /// from 1. [`InputError`] with the path `output.name` for a name that has other characters than lower-case letters and
    /// digits, or does not begin with a letter.
    pub fn new(name: &str, source: &str) -> Result<Self, InputError> {
        let is_letter = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit();
        if !name.starts_with(|letter: char| letter.is_ascii_lowercase()) || !name.chars().all(is_letter) {
            let bound = "must be lower-case letters and digits, and begin with a letter";
            return Err(InputError::new("output.name", format!("`{name}`"), bound));
        }
        let code = without_comments(source);
        let (targets, writes) = (targets_of(name), format!("{name}_write"));
        let declared = declared_names(&code);
        for what in [&targets, &writes] {
            if !declared.contains(what) {
                let own = CallerText { path: "output", source, text: source };
                let form =
                    format!("must be `struct {targets}` and `fn {writes}(surface: Surface) -> {targets}`");
                let error = own.refused(std::iter::empty(), form);
                return Err(InputError { value: format!("no `{what}`"), ..error });
            }
        }
        let least = Program::Own(KindProgram::least()?);
        // The members of the output's struct are not known yet. Entry points that write no depth do not use these members.
        let mut generated = least.generated();
        generated.kind.deep = false;
        let moves = ["last_position", "velocity_write"].iter().any(|name| code.contains(name));
        let text = with_output(&generated, &code, &OutputText::own(name, Vec::new(), moves));
        let own = CallerText { path: "output", source, text: &text };
        own.check_declarations(name)?;
        let module = own.parsed()?;
        own.check(&module)?;
        own.validated(&module)?;
        for (handle, variable) in module.global_variables.iter() {
            let at = module.global_variables.get_span(handle);
            if variable.binding.is_some() && own.is_in(&at) {
                return Err(own.refused(std::iter::once(at), "must not be bound".to_owned()));
            }
        }
        let output = OutputText::own(name, members(&own, &module, &targets)?, moves);
        Ok(Self(Arc::new(Inner { output, code, declared })))
    }

    /// The output's name, which is the prefix of all its declarations.
    pub fn name(&self) -> &str {
        &self.0.output.name
    }

    /// The number of colour attachments that the output writes, counted from the first.
    pub fn colors(&self) -> usize {
        self.0.output.members.len()
    }

    /// Whether the output reads velocities or last positions, and so needs the motion history.
    pub(crate) fn moves(&self) -> bool {
        self.0.output.moves
    }

    /// Prefix of the output's shader entry points.
    pub(super) fn entry(&self) -> &str {
        &self.0.output.entry
    }

    /// The names that the WGSL declares.
    pub(super) fn declared(&self) -> &[String] {
        &self.0.declared
    }

    /// The shader of a kind of object, with entry points for this output.
    pub(super) fn beside(&self, program: &Program) -> String {
        with_output(&program.generated(), &self.0.code, &self.0.output)
    }
}

/// WGSL declarations of the output's colours: the members of the struct named `targets`.
fn members(own: &CallerText<'_>, module: &naga::Module, targets: &str) -> Result<Vec<String>, InputError> {
    let mut found = module.types.iter().filter(|(_, ty)| ty.name.as_deref() == Some(targets));
    let (handle, members) = match found.next() {
        Some((handle, naga::Type { inner: naga::TypeInner::Struct { members, .. }, .. })) => {
            (handle, members)
        }
        _ => return Err(own.refused(std::iter::empty(), format!("must have `struct {targets}`"))),
    };
    let mut declared = Vec::new();
    for (at, member) in members.iter().enumerate() {
        let name = member.name.as_deref().unwrap_or_default();
        let place = match member.binding {
            Some(naga::Binding::Location { location, .. }) => Some(location as usize),
            _ => None,
        };
        let scalar = match module.types[member.ty].inner {
            naga::TypeInner::Scalar(scalar) => Some((scalar, 1)),
            naga::TypeInner::Vector { size, scalar } => Some((scalar, size as usize)),
            _ => None,
        };
        let ty = scalar.and_then(|(scalar, size)| color_type(scalar.kind, size));
        let (Some(ty), true) = (ty, place == Some(at)) else {
            let bound =
                format!("must be at `@location({at})`, the number of the member, and of numbers of 32 bits");
            let error = own.refused(std::iter::once(module.types.get_span(handle)), bound);
            return Err(InputError { value: format!("{targets}.{name}"), ..error });
        };
        declared.push(format!("@location({at}) {name}: {ty}"));
    }
    match declared.is_empty() {
        true => {
            let span = module.types.get_span(handle);
            Err(own.refused(std::iter::once(span), "must have a colour".to_owned()))
        }
        false => Ok(declared),
    }
}

/// The WGSL type of a colour with `size` components.
fn color_type(kind: naga::ScalarKind, size: usize) -> Option<String> {
    let scalar = match kind {
        naga::ScalarKind::Float => "f32",
        naga::ScalarKind::Sint => "i32",
        naga::ScalarKind::Uint => "u32",
        _ => return None,
    };
    Some(if size == 1 { scalar.to_owned() } else { format!("vec{size}<{scalar}>") })
}
