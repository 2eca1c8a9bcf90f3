//! Pipeline options of a relief material, and its maps on the device.

#[cfg(feature = "gpu")]
use crate::surface::color::ColorTexture;
use crate::surface::material::{Green, ReliefShadow};
use crate::surface::relief::ReliefMethod;
#[cfg(feature = "gpu")]
use crate::surface::relief::textures::SurfaceTextures;

/// Options of a relief that are compiled into a pipeline. [`ReliefMaterial`](crate::surface::ReliefMaterial) has the parameters
/// that may change without a new pipeline.
///
/// The default is [`ReliefMethod::Quadtree`] without shadows or silhouette. Normals come from the heights, depth from the
/// polygon, and heights from mip level 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReliefOptions {
    /// Method that finds the surface. The [`SurfaceTextures`] must be made for this method.
    pub method: ReliefMethod,
    /// How the relief casts shadows onto itself.
    pub shadow: ReliefShadow,
    /// Direction of the green channel of the normal map that provides the normals. `None` derives normals from the heights.
    pub normal_map: Option<Green>,
    /// Whether to discard points outside the mesh's uv range, so that silhouettes follow the relief.
    pub silhouette: bool,
    /// Whether to write the depth of the relief instead of the polygon's depth. This disables early depth tests.
    pub depth: bool,
    /// Whether to choose the mip level of the heights by the size of a pixel. `cone` and `quadtree` ignore this and use level 0,
    /// because acceleration maps exist for level 0 only.
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
    /// Returns whether the mip level of the heights follows the size of a pixel. Methods with acceleration maps always use level
    /// 0.
    pub(crate) fn chooses_mip(&self) -> bool {
        self.mip && !matches!(self.method, ReliefMethod::Cone | ReliefMethod::Quadtree)
    }
}

/// Texture maps of a relief material.
#[cfg(feature = "gpu")]
#[derive(Debug, Clone, Copy)]
pub struct ReliefMaps<'a> {
    /// The heights and their acceleration map.
    pub textures: &'a SurfaceTextures,
    /// Base colour in sRGB.
    pub albedo: &'a ColorTexture,
    /// Normal map in tangent space. Required if [`ReliefOptions::normal_map`] is set, otherwise ignored.
    pub normals: Option<&'a ColorTexture>,
}
