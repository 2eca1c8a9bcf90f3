//! What the colour attachments of a target hold.

use wgpu::TextureFormat as Format;

#[cfg(doc)]
use super::layer::Layer;

/// What the first colour attachments of a target hold, and so, which layers can be drawn into it. All but the first
/// kind need a depth attachment, and no blending.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Contents {
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
}

/// What a colour must be, and in words.
type Wanted = (fn(Format) -> bool, &'static str);

impl Contents {
    /// What each of the first colours must be.
    pub(super) fn wanted(self) -> &'static [Wanted] {
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
