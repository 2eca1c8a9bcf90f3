//! What a renderer needs of the objects of a scene and of a view.

use crate::asset::Model;
use crate::gpu::{Buffer, Uniform};
use crate::scene::material::PartMaterials;
use crate::shared::lod::instance::SceneInstance;
use crate::shared::lod::object::SceneDraw;
use crate::shared::render::scene_view::SceneView;
use crate::shared::render::scene_mesh::MeshParams;
use crate::shared::render::scene_terrain::{TerrainParams, TerrainPatch};
use crate::skinning::vertex::Vertex;

/// How an object is drawn.
pub(crate) enum Drawable {
    /// Triangles of a mesh, static or skinned.
    Mesh(MeshDrawable),
    /// Patches of terrain.
    Terrain(TerrainDrawable),
}

/// A mesh on the device, in parts that share a pipeline.
pub(crate) struct MeshDrawable {
    /// Index of its first instance in the scene, and where its vertices lie.
    pub params: Uniform<MeshParams>,
    /// Vertices in the model's space: of the mesh, or of each instance.
    pub vertices: Buffer<Vertex>,
    pub uv: Buffer<[f32; 2]>,
    /// For each vertex, the index of its material in its part's table.
    pub material_of: Buffer<u32>,
    /// Triangles, level by level, and in each level part by part.
    pub indices: Buffer<u32>,
    pub parts: Vec<MeshPart>,
}

/// The triangles of a mesh that share a pipeline, textures and samplers.
pub(crate) struct MeshPart {
    pub surface: SurfaceKind,
    pub materials: PartMaterials,
}

/// What tells pipelines apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct SurfaceKind {
    /// Whether alpha decides which pixels are drawn (masked or dithered).
    pub cut_out: bool,
    pub double_sided: bool,
}

/// Patches of terrain on the device.
pub(crate) struct TerrainDrawable {
    pub params: Uniform<TerrainParams>,
    pub heights: Buffer<i32>,
    /// One per instance.
    pub patches: Buffer<TerrainPatch>,
    /// The triangles of a patch.
    pub indices: Buffer<u32>,
    pub zones: crate::render::Materials,
}
