//! What the colour attachments of a target hold.

use wgpu::TextureFormat as Format;

use super::layer::Layer;
use super::output::OutputProgram;

/// What the first colour attachments of a target hold, and so, which layers can be drawn into it. All but the first
/// kind need a depth attachment, and no blending.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Attachments {
    /// One colour in linear light, of floats: [`Layer::Color`] if it is there, [`Layer::Transparent`] if WebGPU can blend
    /// it without features, [`Layer::Depth`] if there is depth.
    #[default]
    Color,
    /// Normals, of `Rgba16Float` or `Rgba32Float`; colours, of four floats; and numbers, of `Rg16Uint` or `Rg32Uint`:
    /// [`Layer::Surface`] and [`Layer::Depth`].
    Surface,
    /// Velocities, of two or four floats with a sign: `Rg16Float`, `Rg32Float`, `Rgba16Float` or `Rgba32Float`:
    /// [`Layer::Velocity`] and [`Layer::Depth`].
    Velocity,
    /// Positions, of `Rgba32Float`, and numbers, of `Rg32Uint`, one sample each: [`Layer::Measure`] and [`Layer::Depth`].
    Measure,
    /// What an output of the caller's writes: [`Layer::Own`] and [`Layer::Depth`].
    Own(OutputProgram),
}

/// What a colour must be, and in words.
type Wanted = (fn(Format) -> bool, &'static str);

impl Attachments {
    /// The layers that such a target shows besides depth.
    pub(super) fn layers(&self) -> &'static [Layer] {
        match self {
            Self::Color => &[Layer::Color, Layer::Transparent],
            Self::Surface => &[Layer::Surface],
            Self::Velocity => &[Layer::Velocity],
            Self::Measure => &[Layer::Measure],
            Self::Own(_) => &[Layer::Own],
        }
    }

    /// The number of colours that a layer writes, from the first on.
    pub(super) fn colors(&self, layer: Layer) -> usize {
        match (layer, self) {
            (Layer::Depth, _) => 0,
            (_, Self::Color) => 1,
            (_, Self::Own(output)) => output.colors(),
            _ => self.wanted().len(),
        }
    }

    /// What each of the first colours must be.
    pub(super) fn wanted(&self) -> &'static [Wanted] {
        match self {
            Self::Color => &[(is_float, "must be a colour of floats")],
            Self::Surface => &[
                (
                    |format| matches!(format, Format::Rgba16Float | Format::Rgba32Float),
                    "must be Rgba16Float or Rgba32Float",
                ),
                (|format| is_float(format) && format.components() == 4, "must be a colour of four floats"),
                (
                    |format| matches!(format, Format::Rg16Uint | Format::Rg32Uint),
                    "must be Rg16Uint or Rg32Uint",
                ),
            ],
            Self::Velocity => &[(
                |format| {
                    use Format::{Rg16Float, Rg32Float, Rgba16Float, Rgba32Float};
                    matches!(format, Rg16Float | Rg32Float | Rgba16Float | Rgba32Float)
                },
                "must be Rg16Float, Rg32Float, Rgba16Float or Rgba32Float",
            )],
            Self::Measure => &[
                (|format| format == Format::Rgba32Float, "must be Rgba32Float"),
                (|format| format == Format::Rg32Uint, "must be Rg32Uint"),
            ],
            // A pipeline that is compiled tells whether they fit what the text writes.
            Self::Own(_) => &[],
        }
    }
}

fn is_float(format: Format) -> bool {
    matches!(format.sample_type(None, None), Some(wgpu::TextureSampleType::Float { .. }))
        && format.has_color_aspect()
}

/// Whether WebGPU can blend a format without features.
pub(super) fn can_blend(format: Format) -> bool {
    let features = format.guaranteed_format_features(wgpu::Features::empty());
    features.flags.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE)
}
