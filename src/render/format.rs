//! Formats of render targets.

use wgpu::TextureFormat as Format;

use super::attachments::{Attachments, can_blend};
use super::layer::Layer;
use super::output::OutputProgram;
use crate::InputError;

/// The attachments of the render passes or render bundles into which a [`Renderer`](super::Renderer) draws.
///
/// The renderer writes the first colour attachments. [`Attachments`] decides their number and their contents. Further
/// attachments may belong to the caller's own draws; the renderer leaves them unchanged.
///
/// # Examples
///
/// ```
/// use relievo::render::{DepthFormat, TargetFormat};
/// use wgpu::TextureFormat;
///
/// // A window with four samples, and depth of 1 near and 0 far. Clear it to 0.
/// let window = TargetFormat::new(TextureFormat::Bgra8UnormSrgb).with_samples(4).reversed();
///
/// // An engine's pass with a second attachment of its own, and a stencil.
/// let depth = DepthFormat { format: TextureFormat::Depth24PlusStencil8, reversed: false };
/// let engine = TargetFormat::new(TextureFormat::Rgba16Float)
///     .with_color(Some(TextureFormat::R32Uint.into()))
///     .with_depth(Some(depth));
///
/// let shadow_map = TargetFormat::depth_only(TextureFormat::Depth32Float);
/// for format in [window, engine, shadow_map] {
///     format.validate()?;
/// }
/// # Ok::<(), relievo::InputError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TargetFormat {
    /// Colour attachments, at most 8, with `None` where the pass has none. The renderer writes the first ones, with the blending
    /// and write mask of each; [`TargetFormat::attachments`] decides their number. Shading writes values in linear light; a
    /// format with `Srgb` in its name encodes them. Formats for shading must hold floats or normalized integers.
    pub color: Vec<Option<wgpu::ColorTargetState>>,
    /// Contents of the first colour attachments.
    pub attachments: Attachments,
    /// The depth attachment. Without depth, later draws cover earlier ones.
    pub depth: Option<DepthFormat>,
    /// Samples per pixel: 1 or 4.
    pub samples: u32,
}

/// A depth attachment and the direction of its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DepthFormat {
    /// A texture format with depth. A stencil aspect is left unchanged.
    pub format: wgpu::TextureFormat,
    /// Whether depth is reversed: 1 at the near plane, falling with distance. Clear the attachment to 0 if depth is reversed, and
    /// to 1 otherwise. The camera must have the same direction of depth.
    pub reversed: bool,
}

impl TargetFormat {
    /// A format with one colour attachment without blending, `Depth32Float` that grows with distance, and one sample.
    pub fn new(color: wgpu::TextureFormat) -> Self {
        Self { color: vec![Some(color.into())], ..Self::depth_only(wgpu::TextureFormat::Depth32Float) }
    }

    /// A format with `Rgba8UnormSrgb` (the encoding of PNG files) without blending, `Depth32Float` that grows with distance, and
    /// one sample.
    pub fn srgb() -> Self {
        Self::new(wgpu::TextureFormat::Rgba8UnormSrgb)
    }

    /// A format without colour, for shadow maps and separate depth prepasses: depth that grows with distance, and one sample.
    pub fn depth_only(format: wgpu::TextureFormat) -> Self {
        let depth = Some(DepthFormat { format, reversed: false });
        Self { color: Vec::new(), attachments: Attachments::Color, depth, samples: 1 }
    }

    /// A format for [`Layer::Surface`]: `Rgba16Float`, `Rgba8Unorm` and `Rg16Uint`, `Depth32Float` that grows with distance, and
    /// one sample. The colours take 20 of the 32 bytes per sample that WebGPU allows.
    pub fn surface() -> Self {
        Self::holding(Attachments::Surface, &[Format::Rgba16Float, Format::Rgba8Unorm, Format::Rg16Uint])
    }

    /// A format for [`Layer::Velocity`]: `Rg16Float`, `Depth32Float` that grows with distance, and one sample.
    pub fn velocity() -> Self {
        Self::holding(Attachments::Velocity, &[Format::Rg16Float])
    }

    /// A format for [`Layer::Levels`]: `Rgba8UnormSrgb`, `Depth32Float` that grows with distance, and one sample.
    pub fn levels() -> Self {
        Self::holding(Attachments::Levels, &[Format::Rgba8UnormSrgb])
    }

    /// A format for [`Layer::Measure`]: `Rgba32Float` and `Rg32Uint`, `Depth32Float` that grows with distance, and one sample.
    /// The colours take 24 of the 32 bytes per sample that WebGPU allows.
    pub fn measure() -> Self {
        Self::holding(Attachments::Measure, &[Format::Rgba32Float, Format::Rg32Uint])
    }

    /// A format for [`Layer::Own`] and this output, with one sample. `formats` has one colour format for each colour that the
    /// output writes. Depth is `Depth32Float` that grows with distance.
    pub fn of_output(output: &OutputProgram, formats: &[Format]) -> Self {
        Self::holding(Attachments::Own(output.clone()), formats)
    }

    /// The caller's output whose colours the target holds; `None` for all other attachments.
    pub(super) fn output(&self) -> Option<&OutputProgram> {
        if let Attachments::Own(output) = &self.attachments { Some(output) } else { None }
    }

    fn holding(attachments: Attachments, formats: &[Format]) -> Self {
        let color = formats.iter().map(|format| Some((*format).into())).collect();
        Self { color, attachments, ..Self::depth_only(Format::Depth32Float) }
    }

    /// This format with one more colour attachment.
    #[must_use]
    pub fn with_color(mut self, color: Option<wgpu::ColorTargetState>) -> Self {
        self.color.push(color);
        self
    }

    /// This format with another depth attachment, or with none.
    #[must_use]
    pub fn with_depth(self, depth: Option<DepthFormat>) -> Self {
        Self { depth, ..self }
    }

    /// This format with reversed depth, which falls with distance.
    #[must_use]
    pub fn reversed(self) -> Self {
        let depth = self.depth.map(|depth| DepthFormat { reversed: true, ..depth });
        Self { depth, ..self }
    }

    /// This format with `samples` samples per pixel.
    #[must_use]
    pub fn with_samples(self, samples: u32) -> Self {
        Self { samples, ..self }
    }

    /// Checks the format against the library's requirements. [`Renderer::new`](super::Renderer::new) checks it against
    /// the device.
    ///
    /// # Errors
    /// [`InputError`] that names the field: no attachment, more than 8 colours, a first colour in an integer format, a colour or
    /// depth attachment whose format is not a colour or depth format, and sample counts other than 1 and 4.
    pub fn validate(&self) -> Result<(), InputError> {
        let bound = || format!("must be at most {MAX_COLORS}");
        InputError::check(self.color.len() <= MAX_COLORS, "format.color.len", self.color.len(), bound)?;
        if self.depth.is_none() && self.color.iter().all(Option::is_none) {
            return Err(InputError::new("format", "no attachment", "must have a colour or a depth"));
        }
        self.check_colors()?;
        if let Some(DepthFormat { format, .. }) = self.depth.filter(|depth| !depth.format.has_depth_aspect())
        {
            return Err(InputError::new("format.depth.format", format!("{format:?}"), "must have depth"));
        }
        if ![1, 4].contains(&self.samples) {
            return Err(InputError::new("format.samples", self.samples, "must be 1 or 4"));
        }
        Ok(())
    }

    fn check_colors(&self) -> Result<(), InputError> {
        let refused = |at: usize, format: Format, bound: &str| {
            Err(InputError::new(format!("format.color[{at}].format"), format!("{format:?}"), bound))
        };
        for (at, color) in self.color.iter().enumerate() {
            match color {
                Some(color) if !color.format.has_color_aspect() => {
                    return refused(at, color.format, "must be a colour");
                }
                _ => {}
            }
        }
        let is_plain = self.attachments == Attachments::Color;
        for (at, (fits, bound)) in self.attachments.wanted().iter().enumerate() {
            match self.color.get(at).and_then(Option::as_ref) {
                Some(color) if !fits(color.format) => return refused(at, color.format, bound),
                Some(color) if !is_plain && color.blend.is_some() => {
                    let path = format!("format.color[{at}].blend");
                    return Err(InputError::new(path, "blending", "must be none for these attachments"));
                }
                None if !is_plain => {
                    return Err(InputError::new(format!("format.color[{at}]"), "nothing", *bound));
                }
                _ => {}
            }
        }
        let colors = self.output().map_or(0, OutputProgram::colors);
        if let Some(at) = (0..colors).find(|at| self.color.get(*at).is_none_or(Option::is_none)) {
            let bound = "must be there for the output";
            return Err(InputError::new(format!("format.color[{at}]"), "nothing", bound));
        }
        if !is_plain && self.depth.is_none() {
            return Err(InputError::new("format.depth", "nothing", "must be there for these attachments"));
        }
        if self.attachments == Attachments::Measure && self.samples != 1 {
            return Err(InputError::new("format.samples", self.samples, "must be 1 for positions"));
        }
        Ok(())
    }

    /// Checks the format against the device.
    ///
    /// # Errors
    /// [`InputError`] that names the field: a format that needs a feature the device lacks, a format that cannot be
    /// rendered to, blended or multisampled at this count, and colours that exceed the device's limit of bytes per
    /// sample.
    pub(super) fn check_on(&self, device: &wgpu::Device) -> Result<(), InputError> {
        let mut bytes = 0_u32;
        for (at, color) in self.color.iter().enumerate() {
            let Some(color) = color else { continue };
            let has = self.check_attachment(&format!("format.color[{at}].format"), color.format, device)?;
            // The renderer blends only the first colour.
            let blends = at == 0 && color.blend.is_some();
            let blendable = wgpu::TextureFormatFeatureFlags::BLENDABLE;
            if blends && !has.contains(blendable) {
                let feature = enabling(color.format, device, |has| has.flags.contains(blendable));
                let bound = format!("must be none for {:?}, unless {feature} allows it", color.format);
                return Err(InputError::new("format.color[0].blend", "some", bound));
            }
            let (size, alignment) =
                (color.format.target_pixel_byte_cost(), color.format.target_component_alignment());
            bytes = bytes.next_multiple_of(alignment.unwrap_or(1)) + size.unwrap_or(0);
        }
        let most = device.limits().max_color_attachment_bytes_per_sample;
        if bytes > most {
            let bound = format!("must take at most {most}, the device's limit");
            return Err(InputError::new("format.color", format!("{bytes} bytes a sample"), bound));
        }
        if let Some(depth) = self.depth {
            self.check_attachment("format.depth.format", depth.format, device)?;
        }
        Ok(())
    }

    /// Checks an attachment's format on the device, and returns the format's capabilities.
    fn check_attachment(
        &self,
        path: &str,
        format: wgpu::TextureFormat,
        device: &wgpu::Device,
    ) -> Result<wgpu::TextureFormatFeatureFlags, InputError> {
        let features = device.features();
        let missing = format.required_features() - features;
        if !missing.is_empty() {
            let names: Vec<_> =
                missing.iter_names().map(|(name, _)| format!("wgpu::Features::{name}")).collect();
            let bound = format!("needs {}: open the device with it", names.join(" and "));
            return Err(InputError::new(path, format!("{format:?}"), bound));
        }
        if features.contains(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES) {
            // With this feature, a device may allow more than WebGPU guarantees. Only compiling a pipeline shows whether it does.
            return Ok(wgpu::TextureFormatFeatureFlags::all());
        }
        let has = format.guaranteed_format_features(features);
        let target = wgpu::TextureUsages::RENDER_ATTACHMENT;
        if !has.allowed_usages.contains(target) {
            let feature = enabling(format, device, |has| has.allowed_usages.contains(target));
            let bound = format!("must be a format that the device can render to, unless {feature} allows it");
            return Err(InputError::new(path, format!("{format:?}"), bound));
        }
        if !has.flags.sample_count_supported(self.samples) {
            let feature = enabling(format, device, |has| has.flags.sample_count_supported(self.samples));
            let bound = format!("must be a number of samples of {format:?}, unless {feature} allows it");
            return Err(InputError::new("format.samples", self.samples, bound));
        }
        Ok(has.flags)
    }

    /// The layers that can be drawn into targets of this format.
    pub(super) fn layers(&self) -> impl Iterator<Item = Layer> + use<> {
        let first = self.color.first().and_then(Option::as_ref);
        let is_there = first.is_some();
        let blends = first.is_some_and(|color| can_blend(color.format));
        let is_drawn = move |layer: &Layer| if *layer == Layer::Transparent { blends } else { is_there };
        let own = self.attachments.layers().iter().copied().filter(is_drawn);
        own.chain(self.depth.map(|_| Layer::Depth))
    }

    /// Whether depth is reversed (falls with distance).
    pub(super) fn is_reversed(&self) -> bool {
        self.depth.is_some_and(|depth| depth.reversed)
    }

    /// Colour attachments for a pipeline of this layer. The write mask is empty for attachments that the layer does not write.
    pub(super) fn targets(&self, layer: Layer) -> Vec<Option<wgpu::ColorTargetState>> {
        let masked = |(at, color): (usize, &Option<wgpu::ColorTargetState>)| {
            color.clone().map(|color| match at < self.attachments.colors(layer) {
                true if layer == Layer::Transparent => wgpu::ColorTargetState {
                    blend: color.blend.or(Some(wgpu::BlendState::ALPHA_BLENDING)),
                    ..color
                },
                true => color,
                false => wgpu::ColorTargetState {
                    format: color.format,
                    blend: None,
                    write_mask: wgpu::ColorWrites::empty(),
                },
            })
        };
        self.color.iter().enumerate().map(masked).collect()
    }

    /// The depth test of a layer: a fragment passes if it is nearer or equally near.
    pub(super) fn depth_state(&self, layer: Layer) -> Option<wgpu::DepthStencilState> {
        let DepthFormat { format, reversed } = self.depth?;
        let compare = match reversed {
            true => wgpu::CompareFunction::GreaterEqual,
            false => wgpu::CompareFunction::LessEqual,
        };
        Some(wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(layer != Layer::Transparent),
            depth_compare: Some(compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        })
    }
}

/// Name of the device feature with which a format's capabilities satisfy `allows`.
fn enabling(
    format: wgpu::TextureFormat,
    device: &wgpu::Device,
    allows: impl Fn(&wgpu::TextureFormatFeatures) -> bool,
) -> String {
    let known = wgpu::Features::RG11B10UFLOAT_RENDERABLE | wgpu::Features::FLOAT32_BLENDABLE;
    let with = |feature| format.guaranteed_format_features(device.features() | feature);
    let mut enough = known.iter_names().filter(|(_, feature)| allows(&with(*feature)));
    let name = enough.next().map_or("TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES", |(name, _)| name);
    format!("wgpu::Features::{name}")
}

/// The largest number of colour attachments: WebGPU's default limit.
const MAX_COLORS: usize = 8;

#[cfg(test)]
mod tests;
