//! The targets into which a scene is drawn: what they are, and nothing of what is drawn.

use wgpu::TextureFormat as Format;

use super::contents::{Contents, can_blend};
use super::renderer::Layer;
use crate::InputError;

/// The attachments of the render passes, or of the render bundles, into which a [`Renderer`](super::Renderer) draws.
///
/// The first colour attachments are written; [`Contents`] says how many, and with what. Others may belong to the caller's
/// own draws: what a renderer draws leaves them as they are.
#[derive(Debug, Clone, PartialEq)]
pub struct TargetFormat {
    /// Colour attachments, at most 8, with holes as in the pass. Those that hold what [`TargetFormat::contents`] says are
    /// written as they say.
    pub color: Vec<Option<wgpu::ColorTargetState>>,
    /// What the first colours hold.
    pub contents: Contents,
    /// The depth attachment. Without one, what is drawn last covers the rest.
    pub depth: Option<DepthFormat>,
    /// Samples per pixel: 1 or 4.
    pub samples: u32,
}

/// A depth attachment, and the direction of its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DepthFormat {
    /// A format with depth. Its stencil, if it has one, stays as it is.
    pub format: wgpu::TextureFormat,
    /// Whether depth falls with distance, from 1 at the near plane, as it does for cameras with reversed depth. Clear the
    /// attachment to 0 then, else to 1.
    pub reversed: bool,
}

impl TargetFormat {
    /// One colour attachment without blending, `Depth32Float` that grows with distance, and one sample.
    pub fn new(color: wgpu::TextureFormat) -> Self {
        Self { color: vec![Some(color.into())], ..Self::depth_only(wgpu::TextureFormat::Depth32Float) }
    }

    /// No colour, for shadow maps and prepasses of their own: depth that grows with distance, and one sample.
    pub fn depth_only(format: wgpu::TextureFormat) -> Self {
        let depth = Some(DepthFormat { format, reversed: false });
        Self { color: Vec::new(), contents: Contents::Color, depth, samples: 1 }
    }

    /// For [`Layer::Surface`]: `Rgba16Float`, `Rgba8Unorm` and `Rg16Uint`, 20 of the 32 bytes that WebGPU allows a sample,
    /// `Depth32Float` that grows with distance, and one sample.
    pub fn surface() -> Self {
        Self::holding(Contents::Surface, &[Format::Rgba16Float, Format::Rgba8Unorm, Format::Rg16Uint])
    }

    /// For [`Layer::Velocity`]: `Rg16Float`, `Depth32Float` that grows with distance, and one sample.
    pub fn velocity() -> Self {
        Self::holding(Contents::Velocity, &[Format::Rg16Float])
    }

    /// For [`Layer::Measure`]: `Rgba32Float` and `Rg32Uint`, 24 of the 32 bytes that WebGPU allows a sample,
    /// `Depth32Float` that grows with distance, and one sample.
    pub fn measure() -> Self {
        Self::holding(Contents::Measure, &[Format::Rgba32Float, Format::Rg32Uint])
    }

    fn holding(contents: Contents, formats: &[Format]) -> Self {
        let color = formats.iter().map(|format| Some((*format).into())).collect();
        Self { color, contents, ..Self::depth_only(Format::Depth32Float) }
    }

    /// The same with one more colour attachment.
    #[must_use]
    pub fn with_color(mut self, color: Option<wgpu::ColorTargetState>) -> Self {
        self.color.push(color);
        self
    }

    /// The same with another depth attachment, or with none.
    #[must_use]
    pub fn with_depth(self, depth: Option<DepthFormat>) -> Self {
        Self { depth, ..self }
    }

    /// The same with depth that falls with distance.
    #[must_use]
    pub fn reversed(self) -> Self {
        let depth = self.depth.map(|depth| DepthFormat { reversed: true, ..depth });
        Self { depth, ..self }
    }

    /// The same with so many samples per pixel.
    #[must_use]
    pub fn with_samples(self, samples: u32) -> Self {
        Self { samples, ..self }
    }

    /// Checks what the library needs of the attachments. What the device allows is checked when pipelines are compiled.
    ///
    /// # Errors
    /// [`InputError`] that names the field: no attachment, more than 8 colours, a first colour of integers, a colour or
    /// a depth of a format that is none, and other numbers of samples than 1 and 4.
    pub fn validate(&self) -> Result<(), InputError> {
        if self.color.len() > MAX_COLORS {
            let bound = format!("must be at most {MAX_COLORS}");
            return Err(InputError::new("format.color.len", self.color.len(), bound));
        }
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
        let is_plain = self.contents == Contents::Color;
        for (at, (fits, bound)) in self.contents.wanted().iter().enumerate() {
            match self.color.get(at).and_then(Option::as_ref) {
                Some(color) if !fits(color.format) => return refused(at, color.format, bound),
                Some(color) if !is_plain && color.blend.is_some() => {
                    let path = format!("format.color[{at}].blend");
                    return Err(InputError::new(path, "blending", "must be none for these contents"));
                }
                None if !is_plain => {
                    return Err(InputError::new(format!("format.color[{at}]"), "nothing", *bound));
                }
                _ => {}
            }
        }
        if !is_plain && self.depth.is_none() {
            return Err(InputError::new("format.depth", "nothing", "must be there for these contents"));
        }
        if self.contents == Contents::Measure && self.samples != 1 {
            return Err(InputError::new("format.samples", self.samples, "must be 1 for positions"));
        }
        Ok(())
    }

    /// Checks that a device with these limits allows as many bytes of colour a sample.
    ///
    /// # Errors
    /// [`InputError`] if there are more.
    pub(super) fn check_bytes(&self, limits: &wgpu::Limits) -> Result<(), InputError> {
        let aligned = |sum: u32, format: Format| {
            let (bytes, alignment) = (format.target_pixel_byte_cost(), format.target_component_alignment());
            sum.next_multiple_of(alignment.unwrap_or(1)) + bytes.unwrap_or(0)
        };
        let bytes = self.color.iter().flatten().map(|color| color.format).fold(0, aligned);
        let most = limits.max_color_attachment_bytes_per_sample;
        if bytes > most {
            let bound = format!("must be at most {most} bytes a sample, the device's limit");
            return Err(InputError::new("format.color", bytes, bound));
        }
        Ok(())
    }

    /// The layers that can be drawn.
    pub(super) fn layers(&self) -> impl Iterator<Item = Layer> + use<> {
        let first = self.color.first().and_then(Option::as_ref);
        let [own, other] = match self.contents {
            Contents::Color => {
                let blends = first.filter(|color| can_blend(color.format));
                [first.map(|_| Layer::Color), blends.map(|_| Layer::Transparent)]
            }
            Contents::Surface => [Some(Layer::Surface), None],
            Contents::Velocity => [Some(Layer::Velocity), None],
            Contents::Measure => [Some(Layer::Measure), None],
        };
        own.into_iter().chain(other).chain(self.depth.map(|_| Layer::Depth))
    }

    /// Whether depth falls with distance.
    pub(super) fn is_reversed(&self) -> bool {
        self.depth.is_some_and(|depth| depth.reversed)
    }

    /// The colour attachments as a pipeline of a layer sees them.
    pub(super) fn targets(&self, layer: Layer) -> Vec<Option<wgpu::ColorTargetState>> {
        let masked = |(at, color): (usize, &Option<wgpu::ColorTargetState>)| {
            color.clone().map(|color| match at < layer.colors() {
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

    /// The depth test of a layer: nearer, or as near.
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

/// The most colour attachments: WebGPU's default limit.
const MAX_COLORS: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_that_no_pass_has_are_refused_by_field() {
        let good = || TargetFormat::new(Format::Rgba8UnormSrgb);
        let with = |color: Vec<Option<wgpu::ColorTargetState>>| TargetFormat { color, ..good() };
        let depth = |format| Some(DepthFormat { format, reversed: true });
        let surface = |first: Format| {
            let mut color = TargetFormat::surface().color;
            color[0] = Some(first.into());
            color
        };
        let mut blended = surface(Format::Rgba16Float);
        blended[1].as_mut().expect("a colour").blend = Some(wgpu::BlendState::REPLACE);
        for (format, path) in [
            (good().with_samples(2), "format.samples"),
            (good().with_depth(depth(Format::Stencil8)), "format.depth.format"),
            (with(vec![Some(Format::R32Uint.into())]), "format.color[0].format"),
            (with(vec![Some(Format::Depth32Float.into())]), "format.color[0].format"),
            (good().with_color(Some(Format::Depth24Plus.into())), "format.color[1].format"),
            (with(vec![None; 9]), "format.color.len"),
            (with(vec![None]).with_depth(None), "format"),
            (TargetFormat { color: vec![], ..TargetFormat::surface() }, "format.color[0]"),
            (
                TargetFormat { color: surface(Format::Rgba8Unorm), ..TargetFormat::surface() },
                "format.color[0].format",
            ),
            (
                TargetFormat { contents: Contents::Measure, ..TargetFormat::surface() },
                "format.color[0].format",
            ),
            (TargetFormat { color: blended, ..TargetFormat::surface() }, "format.color[1].blend"),
            (TargetFormat::surface().with_depth(None), "format.depth"),
            (TargetFormat::measure().with_samples(4), "format.samples"),
            (TargetFormat { contents: Contents::Velocity, ..good() }, "format.color[0].format"),
        ] {
            assert_eq!(format.validate().expect_err("refused").path, path, "{format:?}");
        }
        for format in [
            good().with_samples(4).reversed(),
            good().with_color(None).with_color(Some(Format::R32Uint.into())).with_depth(None),
            TargetFormat::depth_only(Format::Depth24PlusStencil8),
            with(vec![None, Some(Format::Rgba16Float.into())]),
            TargetFormat::surface().with_samples(4).reversed(),
            TargetFormat { color: surface(Format::Rgba32Float), ..TargetFormat::surface() },
            TargetFormat::measure(),
            TargetFormat::velocity().with_samples(4),
        ] {
            assert_eq!(format.validate(), Ok(()), "{format:?}");
        }
    }

    #[test]
    fn bytes_of_a_sample_are_counted_as_webgpu_counts_them() {
        let limits = wgpu::Limits::default();
        let measure = TargetFormat::measure();
        assert_eq!(measure.check_bytes(&limits), Ok(()));
        // 16 + 8 + 8; a colour of 8 bits a channel counts 8 bytes.
        let full = measure.with_color(Some(Format::Rgba8Unorm.into()));
        assert_eq!(full.check_bytes(&limits), Ok(()));
        let error = full.with_color(Some(Format::R8Unorm.into())).check_bytes(&limits).expect_err("33 bytes");
        assert_eq!((&*error.path, &*error.value), ("format.color", "33"));
    }

    #[test]
    fn only_the_first_color_is_written_and_only_in_color() {
        let blended = wgpu::ColorTargetState {
            format: Format::Rgba8Unorm,
            blend: Some(wgpu::BlendState::ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::COLOR,
        };
        let format = TargetFormat {
            color: vec![Some(blended.clone()), None, Some(blended.clone())],
            ..TargetFormat::new(Format::R8Unorm)
        };
        let masks = |layer| {
            let targets = format.targets(layer);
            targets
                .into_iter()
                .map(|target| target.map(|target| (target.write_mask, target.blend)))
                .collect::<Vec<_>>()
        };
        let left = Some((wgpu::ColorWrites::empty(), None));
        assert_eq!(masks(Layer::Color), [Some((blended.write_mask, blended.blend)), None, left]);
        assert_eq!(masks(Layer::Depth), [left, None, left]);
    }
}
