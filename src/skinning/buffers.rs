//! Skinning data on the device: a mesh in clusters with its skin, and per instance its palette, weights and vertices.

use glam::UVec4;

use super::character_levels::{level_errors, own_levels};
use super::clusters::{ClusterLevel, Clusters};
use crate::asset::Model;
use crate::asset::mesh::{MAX_LEVELS, Mesh};
use crate::asset::morph::MorphTarget;
use crate::asset::transform::rows;
use crate::gpu::bind::SeenAs;
use crate::gpu::{Buffer, Gpu, GpuError, rows_of_workgroups};
use crate::shared::skinning::select::Dispatched;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::vertex::{Blend, Vertex};
use crate::{Error, InputError};

impl SeenAs<[f32; 2]> for Vertex {}
impl SeenAs<Dispatched> for u32 {}
impl SeenAs<u32> for InstanceLod {}

/// A mesh and its skin on the device. Vertices lie in clusters; see [`Clusters::order`].
#[derive(Debug, Clone)]
pub struct MeshBuffers {
    /// Vertices before morphing.
    pub vertices: Buffer<Vertex>,
    /// Texture coordinates, one pair per vertex.
    pub uv: Buffer<[f32; 2]>,
    /// Three indices per triangle, of all levels of detail; see [`Clusters::indices`].
    pub indices: Buffer<u32>,
    /// The mesh's range at each level of its character ([`level_errors`]); the first level is the mesh itself.
    pub levels: Vec<ClusterLevel>,
    /// See [`Clusters::influences`].
    pub influences: Buffer<u32>,
    /// See [`Clusters::masks`].
    pub masks: Buffer<u32>,
    /// First delta of each vertex; one more entry than there are vertices.
    pub delta_offsets: Buffer<u32>,
    /// Three vectors per delta: position and, as bits, the target; normal; tangent.
    pub deltas: Buffer<[[f32; 4]; 3]>,
    /// Indices of the skin's bones.
    pub bones: Buffer<u32>,
    /// Three rows per bone of the skin.
    pub inverse_binds: Buffer<[[f32; 4]; 3]>,
    /// Words per set of the skeleton's bones.
    pub mask_words: usize,
    /// Number of morph targets.
    pub targets: usize,
    /// Number of bones of the skeleton.
    pub all_bones: usize,
    /// Whether both sides of triangles are visible; see [`Mesh::double_sided`].
    pub double_sided: bool,
}

impl MeshBuffers {
    /// Uploads one of a model's meshes. At each level of the model's character ([`level_errors`]), the clusters use the
    /// mesh's own level from [`own_levels`].
    ///
    /// # Errors
    /// [`InputError`] for a mesh that does not match its skin; [`GpuError`].
    pub fn new(gpu: &Gpu, model: &Model, mesh: &Mesh) -> Result<(Self, Clusters), Error> {
        let all_bones = model.skeleton.len();
        let own = own_levels(mesh, &level_errors(&model.meshes));
        let clusters = Clusters::new(mesh, &model.skins, &model.skeleton)?.with_levels(&own);
        let skin = &model.skins[mesh.skin];
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
            bones: Buffer::constant(gpu, "skin bones", &skin.bones)?,
            inverse_binds: Buffer::constant(gpu, "inverse binds", &binds)?,
            mask_words: clusters.mask_words,
            targets: mesh.targets.len(),
            all_bones,
            double_sided: mesh.double_sided,
        };
        Ok((buffers, clusters))
    }

    /// Number of clusters, of [`CLUSTER`](super::clusters::CLUSTER) vertices each.
    pub fn clusters(&self) -> usize {
        self.vertices.len().div_ceil(super::clusters::CLUSTER)
    }

    /// A level of detail of the character; the last one for a number beyond it.
    pub fn level(&self, level: u32) -> ClusterLevel {
        self.levels[(level as usize).min(self.levels.len() - 1)]
    }

    /// Number of clusters at each level of the character, as kernels look it up. Missing levels repeat the last one's.
    pub(crate) fn clusters_of_levels(&self) -> [UVec4; MAX_LEVELS / 4] {
        let of = |level: usize| self.level(level as u32).clusters;
        std::array::from_fn(|at| UVec4::from_array(std::array::from_fn(|lane| of(4 * at + lane))))
    }
}

/// The deltas of each vertex, sorted by target.
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

/// Instances of one mesh on the device. The caller may read, write and bind all buffers.
#[derive(Debug, Clone)]
pub struct SkinnedCrowd {
    /// The palette that [`super::palette::PalettePass`] writes, at `instance · bones of the skin + bone`: three
    /// vectors per bone, or four for dual quaternions.
    pub palette: Buffer<[f32; 4]>,
    /// Level of detail of each instance, full quality at first; [`InstanceLod::UNSEEN`] for instances that are not skinned.
    pub instance_lods: Buffer<InstanceLod>,
    /// Weights of morph targets, instance by instance; 0 at first.
    pub weights: Buffer<f32>,
    /// The vertices that [`super::morph::MorphPass`] writes if the mesh has targets, at `instance · vertices +
    /// slot`. Clusters beyond an instance's level keep their previous contents. Empty if vertices lie in pages
    /// ([`PageBuffers::morphed`](super::pages::PageBuffers::morphed)).
    pub morphed: Buffer<Vertex>,
    /// Number of instances.
    pub instances: usize,
    /// The kind of blending that the palette is for.
    pub blend: Blend,
}

impl SkinnedCrowd {
    /// Allocates the buffers for `instances` instances of a mesh.
    ///
    /// # Errors
    /// [`InputError`] for no instances; [`GpuError`].
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, instances: usize, blend: Blend) -> Result<Self, Error> {
        let crowd = Self::paged(gpu, mesh, instances, blend)?;
        let morphed = if mesh.targets == 0 { 0 } else { instances * mesh.vertices.len() };
        Ok(Self { morphed: Buffer::new(gpu, "morphed vertices", morphed)?, ..crowd })
    }

    /// As [`SkinnedCrowd::new`], for vertices in pages.
    ///
    /// # Errors
    /// As [`SkinnedCrowd::new`].
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

/// The list of clusters to skin, in a buffer that kernels may fill.
#[derive(Debug, Clone)]
pub struct ActiveClusters {
    /// `cluster · instances + instance` for each listed cluster; all other clusters are skipped. If last positions are
    /// kept, one word per pair follows: the last selection's effect on it
    /// ([`ClusterState`](super::select::ClusterState)).
    pub pairs: Buffer<u32>,
    /// Whether last positions are kept.
    pub keeps_last: bool,
    /// Workgroup counts along x, y and z as indirect dispatch arguments; the number of pairs; and a counter that is 0
    /// between dispatches.
    pub dispatched: Buffer<u32>,
}

/// Number of words in [`ActiveClusters::dispatched`].
pub const DISPATCHED_WORDS: usize = size_of::<Dispatched>() / size_of::<u32>();

impl ActiveClusters {
    /// Allocates a list with room for all clusters of all instances. It is empty at first.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Self, GpuError> {
        Ok(Self {
            pairs: Buffer::new(gpu, "clusters", mesh.clusters() * crowd.instances)?,
            keeps_last: false,
            dispatched: Buffer::from_slice(gpu, "dispatched clusters", &[0, 1, 1, 0, 0])?,
        })
    }

    /// As [`ActiveClusters::new`], with last positions kept.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn keeping(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd) -> Result<Self, GpuError> {
        let pairs = Buffer::new(gpu, "clusters", 2 * mesh.clusters() * crowd.instances)?;
        Ok(Self { pairs, keeps_last: true, ..Self::new(gpu, mesh, crowd)? })
    }

    /// The number of words that `pairs` pairs take.
    pub(crate) fn words(&self, pairs: usize) -> usize {
        if self.keeps_last { 2 * pairs } else { pairs }
    }

    /// Sets the list from the host.
    ///
    /// # Errors
    /// [`GpuError`], also for more pairs than the list has room for.
    pub fn write(&self, gpu: &Gpu, pairs: &[u32]) -> Result<(), GpuError> {
        self.pairs.write(gpu, pairs)?;
        let count = pairs.len() as u32;
        let [x, y, z] = rows_of_workgroups(gpu, count);
        self.dispatched.write(gpu, &[x, y, z, count, 0])
    }
}
