//! Contents of a target's colour attachments.

use wgpu::TextureFormat as Format;

use super::layer::Layer;
use super::output::OutputProgram;

/// Contents of a target's first colour attachments. They decide which layers can be drawn into the target. All kinds except
/// [`Attachments::Color`] need a depth attachment, and their colours must have no blending.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Attachments {
    /// One colour in linear light, in a float or normalized format. For [`Layer::Color`] if the target has a colour attachment,
    /// for [`Layer::Transparent`] if WebGPU can blend the format without device features, and for [`Layer::Depth`] if the target
    /// has a depth attachment.
    #[default]
    Color,
    /// Three attachments: normals (`Rgba16Float` or `Rgba32Float`), colours (four floats), and object and instance
    /// numbers (`Rg16Uint` or `Rg32Uint`). For [`Layer::Surface`] and [`Layer::Depth`].
    Surface,
    /// Velocities in two or four signed floats (`Rg16Float`, `Rg32Float`, `Rgba16Float` or `Rgba32Float`). For
    /// [`Layer::Velocity`] and [`Layer::Depth`].
    Velocity,
    /// Positions (`Rgba32Float`) and object and instance numbers (`Rg32Uint`), with one sample per pixel. For
    /// [`Layer::Measure`] and [`Layer::Depth`].
    Measure,
    /// One colour in linear light, in a float or normalized format. For [`Layer::Levels`] and [`Layer::Depth`].
    Levels,
    /// The colours that the caller's output writes. For [`Layer::Own`] and [`Layer::Depth`].
    Own(OutputProgram),
}

/// A test for a colour attachment's format, and the error message for formats that fail it.
type Wanted = (fn(Format) -> bool, &'static str);

impl Attachments {
    /// The layers that can be drawn into these attachments, besides [`Layer::Depth`].
    pub(super) fn layers(&self) -> &'static [Layer] {
        match self {
            Self::Color => &[Layer::Color, Layer::Transparent],
            Self::Surface => &[Layer::Surface],
            Self::Velocity => &[Layer::Velocity],
            Self::Measure => &[Layer::Measure],
            Self::Levels => &[Layer::Levels],
            Self::Own(_) => &[Layer::Own],
        }
    }

    /// Number of colour attachments that a layer writes, counted from the first.
    pub(super) fn colors(&self, layer: Layer) -> usize {
        match (layer, self) {
            (Layer::Depth, _) => 0,
            (_, Self::Color) => 1,
            (_, Self::Own(output)) => output.colors(),
            _ => self.wanted().len(),
        }
    }

    /// The required format of each of the first colour attachments.
    pub(super) fn wanted(&self) -> &'static [Wanted] {
        match self {
            Self::Color | Self::Levels => &[(is_float, "must be a colour of floats")],
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
            // Pipeline compilation checks these formats against the caller's WGSL.
            Self::Own(_) => &[],
        }
    }
}

fn is_float(format: Format) -> bool {
    matches!(format.sample_type(None, None), Some(wgpu::TextureSampleType::Float { .. }))
        && format.has_color_aspect()
}

/// Whether WebGPU can blend a format without device features.
pub(super) fn can_blend(format: Format) -> bool {
    let features = format.guaranteed_format_features(wgpu::Features::empty());
    features.flags.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE)
}
