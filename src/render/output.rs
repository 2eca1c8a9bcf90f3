//! Outputs of the caller's: what is written of surfaces, beside the layers that the library has.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use crate::InputError;
use crate::scene::caller_text::{CallerText, discard_in, without_comments};
use crate::scene::program::entries::OutputText;
use crate::scene::program::prefix::declarations;
use crate::scene::program::{KindProgram, is_of, with_output};
use crate::scene::specialization::Program;

/// What a target holds of each surface, from the caller's WGSL: for [`TargetFormat::of_output`](super::TargetFormat::of_output)
/// and [`Layer::Own`](super::Layer::Own). It works with every kind of object.
///
/// # Examples
///
/// Alpha and texture coordinates, and velocities in the same pass:
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
    name: String,
    source: String,
    moves: bool,
    colors: usize,
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
    /// Checks a text. It needs no device, and compiles nothing.
    ///
    /// `name` is what the names begin with that the text declares at module scope. For `uv` the text has a struct `UvTargets`,
    /// whose members are the colours at `@location(0)` and so on, and a function `fn uv_write(surface: Surface) -> UvTargets`,
    /// which must not discard. `Surface` is that of [`Renderer::with_shading`](super::Renderer::with_shading); its
    /// `last_position` is that of the last frame if the text names it, which needs
    /// [`Scene::keep_last_frame`](crate::scene::Scene::keep_last_frame). `relievo_view` is the view
    /// (`clip_from_world`, `last_clip_from_world`, `eye`), and `relievo_lit(surface) -> vec4<f32>` the shaded colour. The text
    /// binds nothing.
    ///
    /// # Errors
    /// [`InputError`] for the first mistake, with the path `output:LINE:COLUMN`, both counted from 1, and for a name that is not
    /// one of lower-case letters and digits (`output.name`).
    pub fn new(name: &str, source: &str) -> Result<Self, InputError> {
        let is_letter = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit();
        if !name.starts_with(|letter: char| letter.is_ascii_lowercase()) || !name.chars().all(is_letter) {
            let bound = "must be lower-case letters and digits, and begin with a letter";
            return Err(InputError::new("output.name", format!("`{name}`"), bound));
        }
        let code = without_comments(source);
        let moves = code.contains("last_position");
        let output = OutputText { name, text: &code, moves };
        let (targets, writes) = (output.targets(), format!("{name}_write"));
        let declared = declarations(&code);
        let least = Program::Own(KindProgram::least()?);
        let is_declared = |what: &str| declared.iter().any(|range| &code[range.clone()] == what);
        let form = format!("must be `struct {targets}` and `fn {writes}(surface: Surface) -> {targets}`");
        for what in [&targets, &writes] {
            if !is_declared(what) {
                let own = CallerText { path: "output", source, text: source };
                let error = own.refused(std::iter::empty(), form);
                return Err(InputError { value: format!("no `{what}`"), ..error });
            }
        }
        let text = with_output(least.text(), &least.kind(), source, &output);
        let own = CallerText { path: "output", source, text: &text };
        for range in &declared {
            if !is_of(name, &code[range.clone()]) {
                let span = naga::Span::new(range.start as u32, range.end as u32);
                let bound = format!("must begin with `{name}`, as every name that the text declares");
                return Err(own.refused(std::iter::once(span), bound));
            }
        }
        let module = own.parsed()?;
        own.validated(&module)?;
        for (handle, variable) in module.global_variables.iter() {
            let at = module.global_variables.get_span(handle);
            if variable.binding.is_some() && own.is_in(&at) {
                return Err(own.refused(std::iter::once(at), "must not be bound".to_owned()));
            }
        }
        for (handle, function) in module.functions.iter() {
            let discard =
                discard_in(&function.body).filter(|_| own.is_in(&module.functions.get_span(handle)));
            if let Some(at) = discard {
                return Err(own.refused(std::iter::once(at), "must not discard".to_owned()));
            }
        }
        let colors = output.members().len();
        Ok(Self(Arc::new(Inner { name: name.to_owned(), source: source.to_owned(), moves, colors })))
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The number of colours that it writes, from the first on.
    pub fn colors(&self) -> usize {
        self.0.colors
    }

    /// Whether it needs the last frame.
    pub(crate) fn moves(&self) -> bool {
        self.0.moves
    }

    /// The shader of a kind with entry points for this output.
    pub(super) fn beside(&self, program: &Program) -> String {
        let Inner { name, source, moves, .. } = &*self.0;
        let output = OutputText { name, text: source, moves: *moves };
        with_output(program.text(), &program.kind(), source, &output)
    }
}
