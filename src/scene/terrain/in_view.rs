//! The reference point in a view from which shaders count a terrain's samples.

use glam::{DVec3, IVec2, Vec3};

use crate::Error;
use crate::gpu::{Gpu, GpuError, Group, Staged, Uniform, Upload as _};
use crate::scene::camera::Camera;
use crate::scene::layouts::SceneLayouts;
use crate::scene::object_kind::KindInView;
use crate::scene::placement::Placement;
use crate::shared::render::scene_terrain::TerrainView;

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
        let nowhere = TerrainView { base: IVec2::ZERO, rest: Vec3::ZERO, object };
        let uniform = Uniform::new(gpu, "terrain in a view", &nowhere)?;
        Ok(Self { group: layouts.ground(gpu, &uniform)?, uniform, spacing, object })
    }
}

impl KindInView for TerrainInView {
    fn group(&self) -> &Group {
        &self.group
    }

    /// Stages the sample nearest to the eye. Shaders count samples from there, so that `f32` stays precise near the
    /// eye.
    fn stage(&self, staged: &mut Staged, camera: &Camera) -> Result<(), Error> {
        let (spacing, corner, eye) = (self.spacing, Placement::corner(camera.cell), camera.world());
        // The cast to `i32` saturates. Samples that far from the origin are drawn imprecisely anyway.
        let base = IVec2::new((eye.x / spacing).round() as i32, (eye.z / spacing).round() as i32);
        let place = DVec3::new(f64::from(base.x) * spacing, 0.0, f64::from(base.y) * spacing);
        let view = TerrainView { base, rest: (place - corner).as_vec3(), object: self.object };
        Ok(staged.uniform(&self.uniform, &view)?)
    }
}
