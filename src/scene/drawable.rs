//! What a renderer needs of the objects of a scene, and of a view.

use crate::gpu::bindings::render::{scene_mesh, scene_terrain};
use crate::gpu::{Buffer, Gpu, GpuError, Group, Uniform};
use crate::lod::{LodObject, SceneDraw};
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{PartMaterials, ReliefMaterial};
use crate::scene::options::TerrainStyle;
use crate::scene::specialization::{OwnDepth, PartState, Specialization};
use crate::shared::render::scene_instances::SceneObject;
use crate::shared::render::scene_terrain::{TerrainParams, TerrainPatch};
use crate::shared::render::scene_vertex::MeshParams;
use crate::skinning::pages::PageBuffers;
use crate::skinning::vertex::Vertex;
use crate::terrain::materials::Materials;

/// How an object is drawn.
#[derive(Debug, Clone)]
pub(crate) enum Drawable {
    /// Triangles of a mesh, static or skinned.
    Mesh(MeshDrawable),
    /// Patches of terrain.
    Terrain(TerrainDrawable),
    /// Of a kind of the caller's.
    Own(OwnDrawable),
}

/// A part of what is drawn, with pipelines and draws of its own.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part<'a> {
    pub specialization: &'a Specialization,
    /// Bind group 2.
    pub group: &'a Group,
}

impl Drawable {
    /// Number of parts.
    pub fn part_count(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.parts.len(),
            Self::Terrain(_) => 1,
            Self::Own(own) => own.parts.len(),
        }
    }

    /// A part by its number.
    pub fn part(&self, at: usize) -> Option<Part<'_>> {
        match self {
            Self::Mesh(mesh) => mesh.parts.get(at).map(MeshPart::drawn),
            Self::Terrain(TerrainDrawable { specialization, group, .. }) => {
                (at == 0).then_some(Part { specialization, group })
            }
            Self::Own(own) => own.parts.get(at).map(|(specialization, group)| Part { specialization, group }),
        }
    }

    /// Its parts, in the order of their draws.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        (0..self.part_count()).filter_map(|at| self.part(at))
    }

    /// Bind group 1; that of terrain belongs to the view.
    pub fn group(&self) -> Option<&Group> {
        match self {
            Self::Mesh(mesh) => Some(&mesh.group),
            Self::Terrain(_) => None,
            Self::Own(own) => Some(&own.group),
        }
    }

    /// The triangles of all parts.
    pub fn indices(&self) -> &wgpu::Buffer {
        match self {
            Self::Mesh(mesh) => mesh.geometry.indices.raw(),
            Self::Terrain(terrain) => terrain.geometry.indices.raw(),
            Self::Own(own) => &own.indices,
        }
    }

    /// Where its instances lie, if shaders read that from a uniform of its own.
    pub fn object(&self) -> Option<&Uniform<SceneObject>> {
        match self {
            Self::Mesh(mesh) => Some(&mesh.geometry.object),
            Self::Terrain(_) => None,
            Self::Own(own) => Some(&own.object),
        }
    }
}

/// Where the instances of an object lie that no layout has yet.
pub(crate) const NO_OBJECT: SceneObject = SceneObject { first_instance: 0, number: 0, first_slot: 0 };

/// An object of a kind of the caller's.
#[derive(Debug, Clone)]
pub(crate) struct OwnDrawable {
    pub object: Uniform<SceneObject>,
    /// Bind group 1.
    pub group: Group,
    pub indices: wgpu::Buffer,
    /// Its parts, each with bind group 2.
    pub parts: Vec<(Specialization, Group)>,
}

impl OwnDrawable {
    /// Binds what the scene knows of an object.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        indices: &wgpu::Buffer,
        parts: Vec<(Specialization, Group)>,
    ) -> Result<Self, GpuError> {
        let object = Uniform::new(gpu, "object", &NO_OBJECT)?;
        let group = layouts.own_object(gpu, &object)?;
        Ok(Self { object, group, indices: indices.clone(), parts })
    }
}

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
    pub fn params(&self) -> MeshParams {
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

/// The buffers of a terrain.
#[derive(Debug, Clone)]
pub(crate) struct TerrainGeometry {
    /// What patches have in common.
    pub params: Uniform<TerrainParams>,
    /// Windows of heights in 1/65536 units.
    pub heights: Buffer<i32>,
    /// One per instance.
    pub patches: Buffer<TerrainPatch>,
    /// The triangles of a patch: [`patch_indices`].
    pub indices: Buffer<u32>,
    /// Zones and their textures.
    pub zones: Materials,
}

/// Patches of terrain on the device.
#[derive(Debug, Clone)]
pub(crate) struct TerrainDrawable {
    /// Its buffers.
    pub geometry: TerrainGeometry,
    /// Bind group 2; bind group 1 belongs to the view ([`SceneLayouts::ground`]).
    pub group: Group,
    /// What its pipelines are compiled from.
    pub specialization: Specialization,
}

impl TerrainDrawable {
    /// Binds buffers. When one of them is replaced, bind all anew.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        geometry: TerrainGeometry,
        style: TerrainStyle,
    ) -> Result<Self, GpuError> {
        let group = scene_terrain::Group2 {
            terrain: &geometry.params,
            heights: geometry.heights.slice(),
            patches: geometry.patches.slice(),
            zones: geometry.zones.zones.slice(),
            textures: &geometry.zones.view(),
            texture_sampler: &geometry.zones.sampler,
        };
        let specialization = Specialization::terrain(style);
        Ok(Self { group: group.bind(gpu, &layouts.terrain)?, geometry, specialization })
    }
}

/// The triangles of a patch of `size` × `size` vertices, row by row, counter-clockwise seen from above. The diagonal of
/// each cell runs from its south-west to its north-east.
pub(crate) fn patch_indices(size: u32) -> Vec<u32> {
    let cells = || 0..size.saturating_sub(1);
    let corners = |x: u32, y: u32| {
        let north = y * size + x;
        let south = north + size;
        [north, south, north + 1, north + 1, south, south + 1]
    };
    cells().flat_map(|y| cells().flat_map(move |x| corners(x, y))).collect()
}

/// An object as a view draws it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnObject<'a> {
    /// The object's number ([`ObjectId::number`](crate::scene::ObjectId::number)).
    pub number: u32,
    /// How it is drawn.
    pub drawable: &'a Drawable,
    /// Where its lists and draws lie, and its number of levels.
    pub lod: &'a LodObject,
    /// Whether the lists of instances that are not mirrored are drawn, and whether those of mirrored ones are.
    pub sides: [bool; 2],
    /// Bind group 1 of terrain: [`SceneLayouts::ground`]. Meshes have none.
    pub ground: Option<&'a Group>,
}

/// Instances that are drawn one by one.
#[derive(Debug, Clone)]
pub(crate) struct DrawnSingles<'a> {
    /// The draws of all of them.
    pub draws: &'a Buffer<SceneDraw>,
    /// The list of each draw, which has one entry.
    pub entries: &'a Buffer<u32>,
    /// The parts, in the order in which they are drawn.
    pub parts: Vec<DrawnSingle<'a>>,
}

/// A part of an instance that is drawn by itself.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnSingle<'a> {
    /// What is drawn.
    pub drawable: &'a Drawable,
    /// The part of it.
    pub part: Part<'a>,
    /// The index of its draw.
    pub draw: u32,
    /// Whether its placement mirrors.
    pub is_mirrored: bool,
}

/// A view as a renderer needs it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnView<'a> {
    /// Bind group 0: [`SceneLayouts::view`].
    pub group: &'a Group,
    /// The instances of each list, by their index in the object.
    pub lists: &'a Buffer<u32>,
    /// The draws.
    pub arguments: &'a Buffer<SceneDraw>,
    /// Whether the picture is a mirror image, as `SceneView::side` says.
    pub mirrors: bool,
    /// Whether depth falls with distance.
    pub reversed: bool,
    /// Whether the scene keeps its last frame.
    pub keeps_last: bool,
    /// Whether surfaces are looked up in the map of a sun's shadow.
    pub is_shadowed: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_patch_has_the_diagonals_of_its_strips() {
        assert_eq!(patch_indices(2), [0, 2, 1, 1, 2, 3]);
        let size = 5;
        // A strip for each row of cells.
        let strip = |row: u32| {
            let corner = move |index: u32| (row + (index & 1)) * size + (index >> 1);
            (0..2 * size - 2).map(move |at| [0, 1, 2].map(|next| corner(at + next)))
        };
        let sorted = |mut triangle: [u32; 3]| {
            triangle.sort_unstable();
            triangle
        };
        let expected: Vec<_> = (0..size - 1).flat_map(strip).map(sorted).collect();
        let indices = patch_indices(size);
        let found: Vec<_> =
            indices.chunks(3).map(|corners| sorted([corners[0], corners[1], corners[2]])).collect();
        assert_eq!(found, expected);
        // A vertex has one corner in all triangles, as `vertex_wired` of `wgsl/render/scene_terrain.wgsl` says.
        let corner = |vertex: u32| (vertex % size + 2 * (vertex / size)) % 3;
        assert!(indices.chunks(3).all(|corners| {
            let mut own = [0, 1, 2].map(|at| corner(corners[at]));
            own.sort_unstable();
            own == [0, 1, 2]
        }));
        // Seen from above, where y runs down the page, counter-clockwise triangles have a positive product here.
        let place = |vertex: u32| [vertex % size, vertex / size].map(|at| at as i32);
        for corners in indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|at| place(corners[at]));
            let [u, v] = [b, c].map(|to| [to[0] - a[0], to[1] - a[1]]);
            assert!(u[1] * v[0] - u[0] * v[1] > 0, "{corners:?}");
        }
    }
}
