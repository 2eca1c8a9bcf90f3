//! A mesh on the device, as a renderer draws it.

use crate::Error;
use crate::gpu::bindings::render::scene_mesh;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Staged, Uniform, Upload as _};
use crate::scene::drawable::{Drawable, NO_OBJECT, Part};
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{PartMaterials, ReliefBindings};
use crate::scene::specialization::{OwnDepth, PartState, Specialization};
use crate::shared::render::scene_instances::SceneObject;
use crate::shared::render::scene_vertex::MeshParams;
use crate::skinning::pages::PageBuffers;
use crate::skinning::vertex::Vertex;

/// Device buffers of a mesh.
#[derive(Debug, Clone)]
pub(crate) struct MeshGeometry {
    /// Uniform with the range of the instances that show the mesh.
    pub object: Uniform<SceneObject>,
    /// Uniform with the layout of the mesh's vertices.
    pub params: Uniform<MeshParams>,
    /// Vertices in model space: one copy for all instances, or pages of 64 vertices for each instance.
    pub vertices: Buffer<Vertex>,
    /// Offset of the last frame's positions in `vertices`, in pairs of floats; 0 if there are none.
    pub last: u32,
    /// Page of each cluster of each instance. If vertices are not in pages, this is any buffer, and shaders do not read
    /// it.
    pub page_table: Buffer<u32>,
    /// Texture coordinates, one pair per vertex of the mesh.
    pub uv: Buffer<[f32; 2]>,
    /// Two tables, one after the other. The first has, for each vertex, the index of its material in the part's
    /// material table. The second starts at `partners` and has, for each vertex, the partner towards which it geomorphs.
    pub material_of: Buffer<u32>,
    /// Offset of the second table in `material_of`; 0 if there is none, so that levels cannot geomorph.
    pub partners: u32,
    /// Triangle indices, ordered by level of detail, then by part.
    pub indices: Buffer<u32>,
}

/// A mesh on the device. Each of its parts is drawn with one pipeline.
#[derive(Debug, Clone)]
pub(crate) struct MeshDrawable {
    /// Device buffers of the mesh.
    pub geometry: MeshGeometry,
    /// Number of clusters of 64 vertices if vertices are in pages; else 0.
    pub clusters: u32,
    /// Parts of the mesh, in the order of their draws.
    pub parts: Vec<MeshPart>,
    /// Bind group 1, with the mesh's buffers.
    pub group: Group,
}

impl MeshDrawable {
    /// Binds the buffers of a mesh. If a buffer is replaced later, all must be bound again.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        geometry: MeshGeometry,
        clusters: u32,
        parts: Vec<MeshPart>,
    ) -> Result<Self, GpuError> {
        let group = scene_mesh::Group1 {
            scene_object: &geometry.object,
            mesh: &geometry.params,
            vertices: geometry.vertices.slice().cast(),
            texture_coordinates: geometry.uv.slice(),
            material_of: geometry.material_of.slice(),
            page_table: geometry.page_table.slice(),
        };
        Ok(Self { group: group.bind(gpu, &layouts.mesh)?, geometry, clusters, parts })
    }

    /// The layout of the mesh's vertices in shader format.
    fn params(&self) -> MeshParams {
        MeshParams { clusters: self.clusters, last: self.geometry.last, partners: self.geometry.partners }
    }

    /// The same mesh with vertices in `pages`.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn with_pages(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        pages: &PageBuffers,
    ) -> Result<Self, GpuError> {
        let (vertices, page_table) = (pages.skinned.clone(), pages.table.clone());
        let geometry = MeshGeometry { vertices, page_table, last: pages.last, ..self.geometry.clone() };
        Self::new(gpu, layouts, geometry, self.clusters, self.parts.clone())
    }

    /// A copy of the mesh for another chunk of instances, with vertices in `pages` and uniforms of its own. All other
    /// buffers are shared.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn beside(&self, gpu: &Gpu, layouts: &SceneLayouts, pages: &PageBuffers) -> Result<Self, GpuError> {
        let object = Uniform::new(gpu, "object", &NO_OBJECT)?;
        let params = Uniform::new(gpu, "mesh", &self.params())?;
        let geometry = MeshGeometry { object, params, ..self.geometry.clone() };
        Self { geometry, ..self.clone() }.with_pages(gpu, layouts, pages)
    }
}

impl Drawable for MeshDrawable {
    fn part_count(&self) -> usize {
        self.parts.len()
    }

    fn part(&self, at: usize) -> Option<Part<'_>> {
        self.parts.get(at).map(MeshPart::drawn)
    }

    fn group(&self) -> Option<&Group> {
        Some(&self.group)
    }

    fn indices(&self) -> &wgpu::Buffer {
        self.geometry.indices.raw()
    }

    fn stage(&self, staged: &mut Staged, object: &SceneObject) -> Result<(), Error> {
        staged.uniform(&self.geometry.object, object)?;
        Ok(staged.uniform(&self.geometry.params, &self.params())?)
    }

    fn can_morph(&self) -> bool {
        self.geometry.partners > 0
    }

    fn set_morphed(&mut self, morphed: bool) {
        let morphed = morphed && self.can_morph();
        self.parts.iter_mut().for_each(|part| part.set_morphed(morphed));
    }
}

/// Triangles of a mesh that share a pipeline, textures and a sampler.
#[derive(Debug, Clone)]
pub(crate) struct MeshPart {
    faces: Faces,
    morphed: bool,
    materials: MeshMaterials,
    specialization: Specialization,
}

/// Blending and visible sides of a part's triangles.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Faces {
    /// Whether the triangles are blended. Blended triangles are drawn in a layer of their own.
    pub blended: bool,
    /// Whether both sides of the triangles are visible.
    pub double_sided: bool,
}

impl MeshPart {
    /// A part whose levels of detail do not geomorph.
    pub fn new(faces: Faces, materials: MeshMaterials) -> Self {
        let specialization = materials.specialization(faces, false);
        Self { faces, morphed: false, materials, specialization }
    }

    /// Sets whether the part's levels of detail geomorph.
    pub fn set_morphed(&mut self, morphed: bool) {
        self.morphed = morphed;
        self.specialization = self.materials.specialization(self.faces, morphed);
    }

    /// Replaces the part's materials.
    pub fn set_materials(&mut self, materials: MeshMaterials) {
        self.specialization = materials.specialization(self.faces, self.morphed);
        self.materials = materials;
    }

    /// The part's materials.
    pub fn materials(&self) -> &MeshMaterials {
        &self.materials
    }

    /// The part in the form that renderers draw.
    fn drawn(&self) -> Part<'_> {
        Part { specialization: &self.specialization, group: self.materials.group() }
    }
}

/// Materials of a mesh's part.
#[derive(Debug, Clone)]
pub(crate) enum MeshMaterials {
    /// Colours, textures and normal maps.
    Plain(PartMaterials),
    /// A relief, which only static meshes may have.
    Relief(ReliefBindings),
}

impl MeshMaterials {
    /// Bind group 2, with the materials or the relief.
    fn group(&self) -> &Group {
        match self {
            Self::Plain(materials) => &materials.group,
            Self::Relief(relief) => &relief.group,
        }
    }

    fn specialization(&self, faces: Faces, morphed: bool) -> Specialization {
        let Faces { blended, double_sided } = faces;
        match self {
            Self::Plain(PartMaterials { cut_out, textured, normal_mapped, .. }) => {
                let own_depth = OwnDepth::Never;
                let state = PartState { cut_out: *cut_out, blended, double_sided, own_depth };
                Specialization::mesh(state, *textured, *normal_mapped, morphed)
            }
            Self::Relief(relief) => Specialization::relief(&relief.options, double_sided),
        }
    }
}
