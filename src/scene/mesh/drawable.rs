//! A mesh on the device, as a renderer draws it.

use crate::Error;
use crate::gpu::bindings::render::scene_mesh;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Staged, Uniform, Upload as _};
use crate::scene::drawable::{Drawable, NO_OBJECT, Part};
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{PartMaterials, ReliefMaterial};
use crate::scene::specialization::{OwnDepth, PartState, Specialization};
use crate::shared::render::scene_instances::SceneObject;
use crate::shared::render::scene_vertex::MeshParams;
use crate::skinning::pages::PageBuffers;
use crate::skinning::vertex::Vertex;

/// The buffers of a mesh.
#[derive(Debug, Clone)]
pub(crate) struct MeshGeometry {
    /// Where its instances lie.
    pub object: Uniform<SceneObject>,
    /// Where its vertices lie.
    pub params: Uniform<MeshParams>,
    /// Vertices in the model's space: of the mesh, or in pages of each instance.
    pub vertices: Buffer<Vertex>,
    /// Where last positions begin in `vertices`, in pairs of floats; 0 if there are none.
    pub last: u32,
    /// The page of each cluster of each instance; any buffer if vertices do not lie in pages.
    pub page_table: Buffer<u32>,
    /// Texture coordinates, one pair per vertex of the mesh.
    pub uv: Buffer<[f32; 2]>,
    /// For each vertex of the mesh, the index of its material in its part's table; then from `partners` on its partner.
    pub material_of: Buffer<u32>,
    /// Where partners begin in `material_of`; 0 if there are none, so that levels cannot move into each other.
    pub partners: u32,
    /// Triangles, level by level, and in each level part by part.
    pub indices: Buffer<u32>,
}

/// A mesh on the device, in parts that share a pipeline.
#[derive(Debug, Clone)]
pub(crate) struct MeshDrawable {
    /// Its buffers.
    pub geometry: MeshGeometry,
    /// Number of clusters if vertices lie in pages, else 0.
    pub clusters: u32,
    /// Its parts, in the order of their draws.
    pub parts: Vec<MeshPart>,
    /// Bind group 1.
    pub group: Group,
}

impl MeshDrawable {
    /// Binds buffers. When one of them is replaced, bind all anew.
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

    /// Where its vertices lie.
    fn params(&self) -> MeshParams {
        MeshParams { clusters: self.clusters, last: self.geometry.last, partners: self.geometry.partners }
    }

    /// The same mesh, whose vertices lie in other pages.
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

    /// The same mesh for other instances, whose vertices lie in pages of their own.
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

/// The triangles of a mesh that share a pipeline, textures and a sampler.
#[derive(Debug, Clone)]
pub(crate) struct MeshPart {
    faces: Faces,
    morphed: bool,
    materials: MeshMaterials,
    specialization: Specialization,
}

/// How the triangles of a part are seen.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Faces {
    /// Whether they are blended with what is behind them, in a layer of its own.
    pub blended: bool,
    /// Whether both of their sides are seen.
    pub double_sided: bool,
}

impl MeshPart {
    /// A part whose levels of detail do not move into each other.
    pub fn new(faces: Faces, materials: MeshMaterials) -> Self {
        let specialization = materials.specialization(faces, false);
        Self { faces, morphed: false, materials, specialization }
    }

    /// Sets whether levels of detail move into each other.
    pub fn set_morphed(&mut self, morphed: bool) {
        self.morphed = morphed;
        self.specialization = self.materials.specialization(self.faces, morphed);
    }

    /// Replaces the materials.
    pub fn set_materials(&mut self, materials: MeshMaterials) {
        self.specialization = materials.specialization(self.faces, self.morphed);
        self.materials = materials;
    }

    /// What it looks like.
    pub fn materials(&self) -> &MeshMaterials {
        &self.materials
    }

    /// The part as a renderer draws it.
    fn drawn(&self) -> Part<'_> {
        Part { specialization: &self.specialization, group: self.materials.group() }
    }
}

/// What a part of a mesh looks like.
#[derive(Debug, Clone)]
pub(crate) enum MeshMaterials {
    /// Colours, textures and normal maps.
    Plain(PartMaterials),
    /// A relief, on a static mesh.
    Relief(ReliefMaterial),
}

impl MeshMaterials {
    /// Bind group 2.
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
