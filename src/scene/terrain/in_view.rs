//! The reference point in a view from which shaders count a terrain's samples.

use glam::{DVec3, IVec2, Vec3};

use crate::Error;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Staged, Uniform, Upload as _};
use crate::lod::SelectView;
use crate::scene::camera::Camera;
use crate::scene::layouts::SceneLayouts;
use crate::scene::object_kind::{KindInView, ViewOfFrame};
use crate::scene::placement::Placement;
use crate::shared::render::scene_terrain::{TerrainFrame, TerrainView};

/// The resources of a terrain for one view.
#[derive(Debug)]
pub(super) struct TerrainInView {
    uniform: Uniform<TerrainView>,
    /// Bind group 1.
    group: Group,
    /// World units between samples.
    spacing: f64,
    /// Number of the terrain's object.
    object: u32,
}

impl TerrainInView {
    /// Creates a terrain's resources for a view. `spacing` is the distance between samples in world units, and `object`
    /// is the number of the terrain's object.
    pub fn new(gpu: &Gpu, layouts: &SceneLayouts, spacing: f64, object: u32) -> Result<Self, GpuError> {
        let uniform = Uniform::new(gpu, "terrain in a view", &nowhere(object))?;
        let nodes = Buffer::new(gpu, "nodes in a view", 1)?;
        Ok(Self { group: layouts.ground(gpu, &uniform, &nodes)?, uniform, spacing, object })
    }
}

impl KindInView for TerrainInView {
    fn group(&self) -> &Group {
        &self.group
    }

    fn stage(&self, staged: &mut Staged, view: ViewOfFrame<'_>) -> Result<Vec<u32>, Error> {
        staged.uniform(&self.uniform, &seen_from(view.camera, self.spacing, self.object))?;
        Ok(Vec::new())
    }
}

/// A terrain in a view that is not set yet. `object` is the number of the terrain's object.
pub(crate) fn nowhere(object: u32) -> TerrainView {
    let frame = TerrainFrame { cameras: SelectView::nothing().cameras, camera_count: 0, fraction: 0.0 };
    TerrainView { base: IVec2::ZERO, rest: Vec3::ZERO, object, frames: [frame; 2] }
}

/// A terrain as a camera sees it, without levels of detail. Shaders count samples from the one nearest to the eye, so that `f32`
/// stays precise near the eye. Samples are `spacing` world units apart.
pub(super) fn seen_from(camera: &Camera, spacing: f64, object: u32) -> TerrainView {
    let (corner, eye) = (Placement::corner(camera.cell), camera.world());
    // The cast to `i32` saturates. Samples that far from the origin are drawn imprecisely anyway.
    let base = IVec2::new((eye.x / spacing).round() as i32, (eye.z / spacing).round() as i32);
    let place = DVec3::new(f64::from(base.x) * spacing, 0.0, f64::from(base.y) * spacing);
    TerrainView { base, rest: (place - corner).as_vec3(), ..nowhere(object) }
}
