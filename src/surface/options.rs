//! How a relief is drawn, and its maps on the device.

#[cfg(feature = "gpu")]
use crate::surface::color::ColorTexture;
use crate::surface::material::{Green, Shadow};
use crate::surface::relief::Method;
#[cfg(feature = "gpu")]
use crate::surface::relief::textures::SurfaceTextures;

/// Options that are fixed when a pipeline is compiled. [`Material`](crate::surface::Material) has the
/// parameters that may change without a new pipeline.
///
/// The default uses [`Method::Quadtree`], without shadow, with normals from the heights, without silhouette,
/// with the polygon's depth, and with mip level 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReliefOptions {
    /// The method that finds the surface; the [`SurfaceTextures`] must be made for it.
    pub method: Method,
    /// Self-shadow.
    pub shadow: Shadow,
    /// If set, normals come from a normal map whose green channel points in this direction; otherwise they
    /// follow from the heights.
    pub normal_map: Option<Green>,
    /// Whether to discard points outside the mesh's range of uv, so that silhouettes follow the relief.
    pub silhouette: bool,
    /// Whether to write the depth of the relief and not that of the polygon. This disables early depth tests.
    pub depth: bool,
    /// Whether to choose the mip level of the heights from the size of a pixel. Acceleration maps belong to
    /// level 0, so that `cone` and `quadtree` always march there.
    pub mip: bool,
}

impl Default for ReliefOptions {
    fn default() -> Self {
        Self {
            method: Method::Quadtree,
            shadow: Shadow::None,
            normal_map: None,
            silhouette: false,
            depth: false,
            mip: false,
        }
    }
}

#[cfg(feature = "gpu")]
impl ReliefOptions {
    /// Whether the mip level of the heights follows the size of a pixel: acceleration maps belong to level 0.
    pub(crate) fn chooses_mip(&self) -> bool {
        self.mip && !matches!(self.method, Method::Cone | Method::Quadtree)
    }
}

/// The maps of a material.
#[cfg(feature = "gpu")]
#[derive(Debug, Clone, Copy)]
pub struct ReliefMaps<'a> {
    /// Heights and their acceleration map.
    pub textures: &'a SurfaceTextures,
    /// Colour, sRGB.
    pub albedo: &'a ColorTexture,
    /// Tangent-space normals: required if [`ReliefOptions::normal_map`] is set, else ignored.
    pub normals: Option<&'a ColorTexture>,
}
