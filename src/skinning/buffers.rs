//! GPU buffers for skinning: a clustered mesh with its skin, and the palette, morph weights and vertices of each
//! instance.

use glam::UVec4;

use super::character_levels::{level_errors, own_levels};
pub use super::clusters::Rig;
use super::clusters::{ClusterLevel, Clusters};
use crate::asset::Model;
use crate::asset::mesh::{MAX_LEVELS, Mesh};
use crate::asset::morph::MorphTarget;
use crate::asset::transform::rows;
use crate::gpu::bind::SeenAs;
use crate::gpu::{Buffer, Gpu, GpuError, rows_of_workgroups};
use crate::shared::skinning::morph::LOD_WORDS;
use crate::shared::skinning::palette::skin_bone_word;
use crate::shared::skinning::select::Dispatched;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::vertex::{Blend, Vertex};
use crate::{Error, InputError};

impl SeenAs<[f32; 2]> for Vertex {}
impl SeenAs<Dispatched> for u32 {}
impl SeenAs<u32> for InstanceLod {}
const _: () = assert!(size_of::<InstanceLod>() == size_of::<u32>() * LOD_WORDS as usize);

/// A mesh and its skin in GPU buffers. Vertices are grouped in clusters, in the order of [`Clusters::order`].
#[derive(Debug, Clone)]
pub struct MeshBuffers {
    /// Vertices in bind space, before morphing.
    pub vertices: Buffer<Vertex>,
    /// Texture coordinates, one pair per vertex.
    pub uv: Buffer<[f32; 2]>,
    /// Three indices per triangle, for all levels of detail; see [`Clusters::indices`].
    pub indices: Buffer<u32>,
    /// For each level of detail of the whole character ([`level_errors`]), the part of the mesh that the level draws.
    /// Entry 0 is the full mesh.
    pub levels: Vec<ClusterLevel>,
    /// The bones and weights of each cluster's vertices, packed; see [`Clusters::influences`].
    pub influences: Buffer<u32>,
    /// The set of bones that each cluster follows, as bits; see [`Clusters::masks`].
    pub masks: Buffer<u32>,
    /// Index in `deltas` of each vertex's first delta. One more entry at the end has the total number of deltas.
    pub delta_offsets: Buffer<u32>,
    /// Morph deltas, three vectors each: position delta with the target's index as bits in w; normal delta; tangent
    /// delta.
    pub deltas: Buffer<[[f32; 4]; 3]>,
    /// For each bone of the skin, its index in the skeleton, with the skeleton's tier in the highest 8 bits.
    pub bones: Buffer<u32>,
    /// For each bone of the skin, its inverse bind matrix as three rows.
    pub inverse_binds: Buffer<[[f32; 4]; 3]>,
    /// Number of 32-bit words that hold one bit per bone of the skeleton.
    pub mask_words: usize,
    /// Number of morph targets.
    pub targets: usize,
    /// Number of bones in the skeleton.
    pub all_bones: usize,
    /// Whether both sides of the triangles are visible; see [`Mesh::double_sided`].
    pub double_sided: bool,
}

impl MeshBuffers {
    /// Uploads one mesh of a model. At each level of detail of the whole model ([`level_errors`]), the clusters use the
    /// mesh's own level from [`own_levels`].
    ///
    /// # Errors
    /// [`InputError`] for a mesh that does not match its skin; [`GpuError`] if a buffer cannot be allocated.
    pub fn new(gpu: &Gpu, model: &Model, mesh: &Mesh) -> Result<(Self, Clusters), Error> {
        let rig = Rig { skeleton: &model.skeleton, skins: &model.skins, reduced: &[] };
        Self::of_rig(gpu, &rig, mesh, &own_levels(mesh, &level_errors(&model.meshes)))
    }

    /// Uploads a mesh that follows a rig. `own` gives the mesh's own level at each level of detail of the character.
    ///
    /// # Errors
    /// The errors of [`MeshBuffers::new`] and [`Clusters::of_rig`].
    pub fn of_rig(gpu: &Gpu, rig: &Rig<'_>, mesh: &Mesh, own: &[u32]) -> Result<(Self, Clusters), Error> {
        let Rig { skeleton, skins, .. } = *rig;
        let clusters = Clusters::of_rig(mesh, rig)?.with_levels(own);
        let skin = &skins[mesh.skin];
        let bone = |bone: &u32| skin_bone_word(*bone, skeleton.tier_of(*bone) as u32);
        let bones: Vec<u32> = skin.bones.iter().map(bone).collect();
        let binds: Vec<_> = skin.inverse_binds.iter().map(rows).collect();
        let (delta_offsets, deltas) = deltas(&mesh.targets, &clusters);
        let buffers = Self {
            vertices: Buffer::constant(gpu, "mesh vertices", &clusters.vertices)?,
            uv: Buffer::constant(gpu, "mesh uv", &clusters.uv)?,
            indices: Buffer::constant(gpu, "mesh indices", &clusters.indices)?,
            levels: clusters.levels.clone(),
            influences: Buffer::constant(gpu, "influences", &clusters.influences)?,
            masks: Buffer::constant(gpu, "cluster masks", &clusters.masks)?,
            delta_offsets: Buffer::constant(gpu, "morph offsets", &delta_offsets)?,
            deltas: Buffer::constant(gpu, "morph deltas", &deltas)?,
            bones: Buffer::constant(gpu, "skin bones", &bones)?,
            inverse_binds: Buffer::constant(gpu, "inverse binds", &binds)?,
            mask_words: clusters.mask_words,
            targets: mesh.targets.len(),
            all_bones: skeleton.len(),
            double_sided: mesh.double_sided,
        };
        Ok((buffers, clusters))
    }

    /// Number of clusters in the mesh. A cluster has [`CLUSTER`](super::clusters::CLUSTER) vertices.
    pub fn clusters(&self) -> usize {
        self.vertices.len().div_ceil(super::clusters::CLUSTER)
    }

    /// The part of the mesh that a level of detail of the character draws. Numbers beyond the last level give the last
    /// level.
    pub fn level(&self, level: u32) -> ClusterLevel {
        self.levels[(level as usize).min(self.levels.len() - 1)]
    }

    /// Number of clusters at each level of detail, in the layout of kernels. Entries beyond the last level repeat the
    /// last level.
    pub(crate) fn clusters_of_levels(&self) -> [UVec4; MAX_LEVELS / 4] {
        let of = |level: usize| self.level(level as u32).clusters;
        std::array::from_fn(|at| UVec4::from_array(std::array::from_fn(|lane| of(4 * at + lane))))
    }
}

/// The offset of each vertex's first delta, and all deltas. The deltas of a vertex are sorted by target.
fn deltas(targets: &[MorphTarget], clusters: &Clusters) -> (Vec<u32>, Vec<[[f32; 4]; 3]>) {
    let mut by_vertex = vec![Vec::new(); clusters.order.len()];
    for (index, target) in (0..).zip(targets) {
        for (vertex, delta) in target.vertices.iter().zip(&target.deltas) {
            let ([x, y, z], [nx, ny, nz], [tx, ty, tz]) = (delta.position, delta.normal, delta.tangent);
            let packed = [[x, y, z, f32::from_bits(index)], [nx, ny, nz, 0.0], [tx, ty, tz, 0.0]];
            by_vertex[*vertex as usize].push(packed);
        }
    }
    let mut offsets = vec![0];
    let mut all = Vec::new();
    for vertex in &clusters.order {
        all.append(&mut by_vertex[*vertex as usize]);
        offsets.push(all.len() as u32);
    }
    (offsets, all)
}

/// GPU buffers of all instances of one mesh. The caller may read, write and bind all of them.
#[derive(Debug, Clone)]
pub struct SkinnedCrowd {
    /// The bone transforms that [`super::palette::PalettePass`] writes, at index `instance · bones of the skin + bone`.
    /// A bone takes three vectors, or four for dual quaternions.
    pub palette: Buffer<[f32; 4]>,
    /// Level of detail of each instance, initially full quality. [`InstanceLod::UNSEEN`] marks an instance that is not
    /// skinned.
    pub instance_lods: Buffer<InstanceLod>,
    /// Weights of the morph targets, all weights of instance 0 first. Initially, all weights are 0.
    pub weights: Buffer<f32>,
    /// Morphed vertices at index `instance · vertices + slot`, written by [`super::morph::MorphPass`] if the mesh has
    /// targets. Clusters beyond an instance's level of detail keep their previous contents. The buffer is empty if
    /// vertices lie in pages ([`PageBuffers::morphed`](super::pages::PageBuffers::morphed)).
    pub morphed: Buffer<Vertex>,
    /// Number of instances.
    pub instances: usize,
    /// The kind of blending: it determines the layout of the palette.
    pub blend: Blend,
}

impl SkinnedCrowd {
    /// Allocates the buffers for `instances` instances of a mesh.
    ///
    /// # Errors
    /// [`InputError`] for 0 instances or too many; [`GpuError`] if a buffer cannot be allocated.
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, instances: usize, blend: Blend) -> Result<Self, Error> {
        let crowd = Self::paged(gpu, mesh, instances, blend)?;
        let morphed = if mesh.targets == 0 { 0 } else { instances * mesh.vertices.len() };
        Ok(Self { morphed: Buffer::new(gpu, "morphed vertices", morphed)?, ..crowd })
    }

    /// Allocates the buffers of [`SkinnedCrowd::new`] for vertices in pages: [`SkinnedCrowd::morphed`] stays empty.
    ///
    /// # Errors
    /// The same errors as [`SkinnedCrowd::new`].
    pub fn paged(gpu: &Gpu, mesh: &MeshBuffers, instances: usize, blend: Blend) -> Result<Self, Error> {
        if instances == 0 || u32::try_from(instances * mesh.clusters().max(1)).is_err() {
            let bound = format!("must be in 1..={}", u32::MAX as usize / mesh.clusters().max(1));
            return Err(InputError::new("instances", instances, bound).into());
        }
        let vectors = if blend == Blend::Linear { 3 } else { 4 };
        Ok(Self {
            palette: Buffer::new(gpu, "palette", vectors * instances * mesh.bones.len())?,
            instance_lods: Buffer::from_slice(gpu, "instance_lods", &vec![InstanceLod::FULL; instances])?,
            weights: Buffer::new(gpu, "morph weights", instances * mesh.targets)?,
            morphed: Buffer::new(gpu, "morphed vertices", 0)?,
            instances,
            blend,
        })
    }
}

/// The list of clusters to skin, in a buffer that kernels can fill.
#[derive(Debug, Clone)]
pub struct ActiveClusters {
    /// The listed clusters, each as `cluster · instances + instance`; all other clusters are skipped. If
    /// [`ActiveClusters::keeps_last`] is set, the list is followed by one word per cluster and instance: a
    /// [`ClusterState`](super::select::ClusterState), set by the last selection.
    pub pairs: Buffer<u32>,
    /// Whether vertex positions of the previous frame are kept, for motion vectors.
    pub keeps_last: bool,
    /// Five words: workgroup counts along x, y and z (indirect dispatch arguments), the number of listed clusters, and
    /// a counter that is 0 between dispatches.
    pub dispatched: Buffer<u32>,
}

/// Number of words in [`ActiveClusters::dispatched`].
pub const DISPATCHED_WORDS: usize = size_of::<Dispatched>() / size_of::<u32>();

impl ActiveClusters {
    /// Allocates an empty list with a capacity for all clusters of all instances.
    ///
    /// # Errors
    /// [`GpuError`] if a buffer cannot be allocated.
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Self, GpuError> {
        Ok(Self {
            pairs: Buffer::new(gpu, "clusters", mesh.clusters() * crowd.instances)?,
            keeps_last: false,
            dispatched: Buffer::from_slice(gpu, "dispatched clusters", &[0, 1, 1, 0, 0])?,
        })
    }

    /// As [`ActiveClusters::new`], but also allocates a state for each cluster of each instance, so that previous
    /// positions can be kept.
    ///
    /// # Errors
    /// [`GpuError`] if a buffer cannot be allocated.
    pub fn keeping(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Self, GpuError> {
        let pairs = Buffer::new(gpu, "clusters", 2 * mesh.clusters() * crowd.instances)?;
        Ok(Self { pairs, keeps_last: true, ..Self::new(gpu, mesh, crowd)? })
    }

    /// Number of words that [`ActiveClusters::pairs`] needs for `pairs` pairs. A pair is a cluster and an instance.
    pub(crate) fn words(&self, pairs: usize) -> usize {
        if self.keeps_last { 2 * pairs } else { pairs }
    }

    /// Writes the list from the CPU. Each entry is `cluster · instances + instance`.
    ///
    /// # Errors
    /// [`GpuError`], also for a list that exceeds the capacity.
    pub fn write(&self, gpu: &Gpu, pairs: &[u32]) -> Result<(), GpuError> {
        self.pairs.write(gpu, pairs)?;
        let count = pairs.len() as u32;
        let [x, y, z] = rows_of_workgroups(gpu, count);
        self.dispatched.write(gpu, &[x, y, z, count, 0])
    }
}
