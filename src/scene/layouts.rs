//! The bind groups with which a scene is drawn, and their layouts. Group 0 is the view, group 1 the object, group 2 the
//! surface, and group 3 is left to the caller's shading.

use crate::gpu::bindings::render::{scene_mesh, scene_relief, scene_terrain};
use crate::gpu::{Buffer, Gpu, GpuError, Group, Layouts, Uniform};
use crate::shared::lod::instance::SceneInstance;
use crate::shared::render::scene_terrain::TerrainView;
use crate::shared::render::scene_view::SceneView;

/// The layouts of all shaders of a scene. Those of the view are the same in all, and those of the object in all shaders
/// of meshes, so that pipelines can change while the groups stay. Two values on one device may be mixed.
#[derive(Debug, Clone)]
pub(crate) struct SceneLayouts {
    /// Of meshes with materials.
    pub mesh: Layouts,
    /// Of meshes with relief.
    pub relief: Layouts,
    /// Of terrain.
    pub terrain: Layouts,
}

impl SceneLayouts {
    /// Creates the layouts.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            mesh: scene_mesh::layouts(gpu)?,
            relief: scene_relief::layouts(gpu)?,
            terrain: scene_terrain::layouts(gpu)?,
        })
    }

    /// Group 0: a view, its `rows` (three for each instance of the scene), and all instances of the scene, as they are and as
    /// they were in the last frame.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn view(
        &self,
        gpu: &Gpu,
        view: &Uniform<SceneView>,
        rows: &Buffer<[f32; 4]>,
        [instances, last]: [&Buffer<SceneInstance>; 2],
    ) -> Result<Group, GpuError> {
        let (instances, last_instances) = (instances.slice(), last.slice());
        let group = scene_mesh::Group { view, rows: rows.slice(), instances, last_instances };
        group.bind(gpu, &self.mesh)
    }

    /// Group 1 of a terrain in a view.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn ground(&self, gpu: &Gpu, ground: &Uniform<TerrainView>) -> Result<Group, GpuError> {
        scene_terrain::Group1 { ground }.bind(gpu, &self.terrain)
    }

    /// The layouts of a pipeline of meshes with materials.
    pub fn of_mesh(&self) -> [&wgpu::BindGroupLayout; 3] {
        [&self.mesh.groups[0], &self.mesh.groups[1], &self.mesh.groups[2]]
    }

    /// The layouts of a pipeline of meshes with relief.
    pub fn of_relief(&self) -> [&wgpu::BindGroupLayout; 3] {
        [&self.mesh.groups[0], &self.mesh.groups[1], &self.relief.groups[2]]
    }

    /// The layouts of a pipeline of terrain.
    pub fn of_terrain(&self) -> [&wgpu::BindGroupLayout; 3] {
        [&self.mesh.groups[0], &self.terrain.groups[1], &self.terrain.groups[2]]
    }
}
