//! Pipeline options of a relief, and its maps on the device.

#[cfg(feature = "gpu")]
use crate::surface::color::ColorTexture;
use crate::surface::material::{Green, ReliefShadow};
use crate::surface::relief::ReliefMethod;
#[cfg(feature = "gpu")]
use crate::surface::relief::textures::SurfaceTextures;

/// Options that are fixed when a pipeline is compiled. [`ReliefMaterial`](crate::surface::ReliefMaterial) has the parameters that may
/// change without a new pipeline.
///
/// The default is [`ReliefMethod::Quadtree`], with no shadow, normals from the heights, no silhouette, the polygon's depth, and mip
/// level 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReliefOptions {
    /// Method that finds the surface; the [`SurfaceTextures`] must be made for it.
    pub method: ReliefMethod,
    /// Self-shadow.
    pub shadow: ReliefShadow,
    /// Green direction of the normal map that provides the normals; `None` derives normals from the heights.
    pub normal_map: Option<Green>,
    /// Whether to discard points outside the mesh's range of uv, so that silhouettes follow the relief.
    pub silhouette: bool,
    /// Whether to write the depth of the relief instead of the polygon's. This disables early depth tests.
    pub depth: bool,
    /// Whether to choose the mip level of the heights from the size of a pixel. Acceleration maps exist for level 0 only, so
    /// that `cone` and `quadtree` always march there.
    pub mip: bool,
}

impl Default for ReliefOptions {
    fn default() -> Self {
        Self {
            method: ReliefMethod::Quadtree,
            shadow: ReliefShadow::None,
            normal_map: None,
            silhouette: false,
            depth: false,
            mip: false,
        }
    }
}

#[cfg(feature = "gpu")]
impl ReliefOptions {
    /// Whether the mip level of the heights follows the size of a pixel. Methods with acceleration maps always use level 0.
    pub(crate) fn chooses_mip(&self) -> bool {
        self.mip && !matches!(self.method, ReliefMethod::Cone | ReliefMethod::Quadtree)
    }
}

/// The maps of a material.
#[cfg(feature = "gpu")]
#[derive(Debug, Clone, Copy)]
pub struct ReliefMaps<'a> {
    /// Heights and their acceleration map.
    pub textures: &'a SurfaceTextures,
    /// Colour, in sRGB.
    pub albedo: &'a ColorTexture,
    /// Tangent-space normals: required if [`ReliefOptions::normal_map`] is set, otherwise ignored.
    pub normals: Option<&'a ColorTexture>,
}
