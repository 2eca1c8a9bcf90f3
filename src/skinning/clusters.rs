//! Clusters: the vertices of a mesh in groups of [`CLUSTER`] that follow few bones, in the layout of the kernels.

use std::cmp::Reverse;

use crate::InputError;
use crate::animation::order::Order;
use crate::asset::influences::Influences;
use crate::asset::mesh::Mesh;
use crate::asset::skeleton::{Skeleton, Skin};
use crate::shared::skinning::cluster;
use crate::skinning::vertex::Vertex;
use crate::skinning::vertex::vertices_of;

/// Number of vertices in a cluster.
pub const CLUSTER: usize = cluster::CLUSTER as usize;

/// The largest number of bones that a skin may have.
pub const MAX_SKIN_BONES: usize = 1 << 16;

/// The part of a clustered mesh that one level of detail draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClusterLevel {
    /// Number of vertices of this level and of all coarser levels. They have the first slots ([`Clusters::order`]).
    pub vertices: u32,
    /// Number of clusters that hold the level's vertices, starting with cluster 0. The last of them may also hold
    /// vertices of a finer level.
    pub clusters: u32,
    /// Index of the level's first triangle corner in [`Clusters::indices`].
    pub first_index: u32,
    /// Number of the level's entries in [`Clusters::indices`], three per triangle.
    pub indices: u32,
}

/// A mesh's vertices in clusters of 64. Vertices of coarse levels come first. The last cluster may be partly filled.
#[derive(Debug, Clone, PartialEq)]
pub struct Clusters {
    /// The vertices in the order of clusters, as indices in the mesh. A vertex's place in this list is its slot.
    pub order: Vec<u32>,
    /// Vertices before morphing, in the order of slots.
    pub vertices: Vec<Vertex>,
    /// Texture coordinates, in the order of slots.
    pub uv: Vec<[f32; 2]>,
    /// The triangles of all levels, one level after the other, three slots per triangle. Triangles keep the mesh's order.
    pub indices: Vec<u32>,
    /// The levels of detail; level 0 is the full mesh with all vertices. The others are the mesh's own levels
    /// ([`Mesh::levels`]), or, after [`Clusters::with_levels`], the levels of a character.
    pub levels: Vec<ClusterLevel>,
    /// The influences of all vertices, packed: first two header words for each tier of the skeleton and each cluster, then the
    /// columns of each cluster, [`CLUSTER`] words per column.
    ///
    /// A cluster's header has the index of the first word of its columns, and the largest number of influences per
    /// vertex. The first columns of a cluster hold bones, two per word; the strongest bone is in the lower half of the
    /// first word. The next columns hold the weights of all bones but the strongest, as bits. The strongest weight is 1
    /// minus the sum of the others.
    pub influences: Vec<u32>,
    /// The set of bones that each cluster follows, in [`Clusters::mask_words`] words per tier and cluster. There is one bit per
    /// bone, in the skeleton's [`Order`], as in gates and [`Active::updated_bones`](crate::animation::compact).
    pub masks: Vec<u32>,
    /// Number of 32-bit words in a set of bones: [`Order::words`].
    pub mask_words: usize,
    /// For each cluster, whether morph targets move any of its vertices.
    pub morphs: Vec<bool>,
}

/// The bones that a mesh's vertices follow: a skeleton of one or several tiers ([`Skeleton::with_tier`]).
#[derive(Debug, Clone, Copy)]
pub struct Rig<'a> {
    /// The bones of all tiers.
    pub skeleton: &'a Skeleton,
    /// The skins of the model, with the bones of all tiers.
    pub skins: &'a [Skin],
    /// Influences of the mesh's vertices on the bones of tiers 1, 2 …; those on tier 0 are [`Mesh::influences`].
    pub reduced: &'a [Influences],
}

impl Clusters {
    /// Groups the vertices of a mesh into clusters. The mesh's skin must match the skeleton.
    ///
    /// # Errors
    /// [`InputError`] if [`Mesh::validate`] refuses the mesh, if its skin does not match the skeleton, or if the skin
    /// has more than [`MAX_SKIN_BONES`] bones.
    pub fn new(mesh: &Mesh, skins: &[Skin], skeleton: &Skeleton) -> Result<Self, InputError> {
        Self::of_rig(mesh, &Rig { skeleton, skins, reduced: &[] })
    }

    /// Like [`Clusters::new`], for a skeleton of several tiers.
    ///
    /// # Errors
    /// The errors of [`Clusters::new`]; [`InputError`] for influences that do not match the mesh or the skin.
    pub fn of_rig(mesh: &Mesh, rig: &Rig<'_>) -> Result<Self, InputError> {
        let Rig { skeleton, skins, reduced } = *rig;
        mesh.validate(skins)?;
        let skin = &skins[mesh.skin];
        InputError::check_most("skin.bones.len", skin.bones.len(), MAX_SKIN_BONES)?;
        skin.validate(skeleton)?;
        let bones = Order::new(skeleton);
        let slot_of = bones.slots_of_bones();
        let bands = bands(mesh);
        let order = order(mesh, &bands);
        let slot = slots(&order);
        let vertices = vertices_of(mesh);
        let mask_words = bones.words();
        for (at, influences) in reduced.iter().enumerate() {
            let path = format!("reduced[{at}]");
            InputError::check_len(&path, influences.vertices(), mesh.vertices(), "a vertex")?;
            let bones: Vec<u32> = influences.all().iter().map(|one| one.bone).collect();
            let bound = format!("must be below {}", skin.bones.len());
            InputError::check_each(&path, &bones, |bone| (*bone as usize) < skin.bones.len(), bound)?;
        }
        let tiers: Vec<&Influences> = std::iter::once(&mesh.influences).chain(reduced).collect();
        let mask = |(influences, cluster): (&Influences, &[u32])| {
            mask(influences, skin, &slot_of, cluster, mask_words)
        };
        let clusters =
            tiers.iter().flat_map(|tier| order.chunks(CLUSTER).map(move |cluster| (*tier, cluster)));
        Ok(Self {
            vertices: order.iter().map(|vertex| vertices[*vertex as usize]).collect(),
            uv: order.iter().map(|vertex| mesh.uv[*vertex as usize]).collect(),
            indices: mesh.all_triangles().flatten().map(|index| slot[*index as usize]).collect(),
            levels: levels(mesh, &bands),
            influences: influences(&tiers, &order),
            morphs: morphs(mesh, &slot),
            masks: clusters.flat_map(mask).collect(),
            mask_words,
            order,
        })
    }

    /// Replaces the mesh's levels by a character's levels. `own` gives the mesh's own level at each level of the
    /// character, from [`own_levels`](super::own_levels).
    #[must_use]
    pub fn with_levels(mut self, own: &[u32]) -> Self {
        self.levels = own.iter().map(|level| self.level(*level)).collect();
        self
    }

    /// For each vertex of the mesh, its position in the order of clusters.
    pub fn slots(&self) -> Vec<u32> {
        slots(&self.order)
    }

    /// Number of clusters.
    pub fn len(&self) -> usize {
        self.order.len().div_ceil(CLUSTER)
    }

    /// Whether the mesh has no vertices.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The part of the mesh that a level of detail draws. Numbers beyond the last level give the last level.
    pub fn level(&self, level: u32) -> ClusterLevel {
        self.levels[(level as usize).min(self.levels.len() - 1)]
    }

    /// Reorders `placed`, one value per slot, into the order of the mesh's vertices.
    pub fn in_mesh_order<T: Copy>(&self, placed: &[T]) -> Vec<T> {
        let mut all: Vec<_> = self.order.iter().zip(placed).collect();
        all.sort_by_key(|(vertex, _)| **vertex);
        all.into_iter().map(|(_, value)| *value).collect()
    }
}

fn slots(order: &[u32]) -> Vec<u32> {
    let mut slots = vec![0; order.len()];
    (0..).zip(order).for_each(|(slot, vertex)| slots[*vertex as usize] = slot);
    slots
}

/// For each vertex, the coarsest level that uses it; 0 (the full mesh) if no triangle uses it.
fn bands(mesh: &Mesh) -> Vec<u32> {
    let mut bands = vec![0; mesh.vertices()];
    for (level, triangles) in (0..).zip(mesh.all_triangles()) {
        triangles.iter().for_each(|vertex| bands[*vertex as usize] = level);
    }
    bands
}

fn levels(mesh: &Mesh, bands: &[u32]) -> Vec<ClusterLevel> {
    let mut first_index = 0;
    let level = |(level, triangles): (u32, &[u32])| {
        let vertices = bands.iter().filter(|band| **band >= level).count();
        let clusters = vertices.div_ceil(CLUSTER) as u32;
        let indices = triangles.len() as u32;
        first_index += indices;
        ClusterLevel { vertices: vertices as u32, clusters, first_index: first_index - indices, indices }
    };
    (0..).zip(mesh.all_triangles()).map(level).collect()
}

/// The mesh's vertices in the order of slots. Vertices of coarse levels come first. Within a level, they are sorted by
/// strongest bone, then by number of influences, then by the other bones.
fn order(mesh: &Mesh, bands: &[u32]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..mesh.vertices() as u32).collect();
    order.sort_by_cached_key(|vertex| {
        let influences = mesh.influences.of(*vertex as usize);
        let bones: Vec<u32> = influences.iter().map(|influence| influence.bone).collect();
        (Reverse(bands[*vertex as usize]), bones.first().copied(), bones.len(), bones)
    });
    order
}

fn morphs(mesh: &Mesh, slot: &[u32]) -> Vec<bool> {
    let mut morphs = vec![false; mesh.vertices().div_ceil(CLUSTER)];
    let moved = mesh.targets.iter().flat_map(|target| &target.vertices);
    moved.for_each(|vertex| morphs[slot[*vertex as usize] as usize / CLUSTER] = true);
    morphs
}

fn influences(tiers: &[&Influences], order: &[u32]) -> Vec<u32> {
    let clusters = order.len().div_ceil(CLUSTER);
    let mut words = vec![0; 2 * clusters * tiers.len()];
    let all = tiers.iter().flat_map(|tier| order.chunks(CLUSTER).map(move |cluster| (*tier, cluster)));
    for (index, (tier, cluster)) in all.enumerate() {
        let of = |lane: usize| cluster.get(lane).map_or(&[][..], |vertex| tier.of(*vertex as usize));
        let slots = (0..CLUSTER).map(|lane| of(lane).len()).max().unwrap_or(0);
        words[2 * index] = words.len() as u32;
        words[2 * index + 1] = slots as u32;
        let bone = |lane: usize, slot: usize| of(lane).get(slot).map_or(0, |influence| influence.bone);
        for pair in 0..slots.div_ceil(2) {
            words.extend((0..CLUSTER).map(|lane| bone(lane, 2 * pair) | bone(lane, 2 * pair + 1) << 16));
        }
        for slot in 1..slots {
            let weight = |lane: usize| of(lane).get(slot).map_or(0.0, |influence| influence.weight);
            words.extend((0..CLUSTER).map(|lane| weight(lane).to_bits()));
        }
    }
    words
}

fn mask(influences: &Influences, skin: &Skin, slot_of: &[usize], cluster: &[u32], words: usize) -> Vec<u32> {
    let mut mask = vec![0; words];
    for influence in cluster.iter().flat_map(|vertex| influences.of(*vertex as usize)) {
        let slot = slot_of[skin.bones[influence.bone as usize] as usize];
        mask[slot / 32] |= 1 << (slot % 32);
    }
    mask
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::mesh::MeshLevel;

    #[test]
    fn clusters_hold_every_vertex_and_its_bones() {
        let model = crate::samples::creature().expect("valid");
        let (mesh, skin) = (&model.meshes[0], &model.skins[0]);
        let clusters = Clusters::new(mesh, &model.skins, &model.skeleton).expect("fits");
        assert_eq!(clusters.len(), mesh.vertices().div_ceil(64));
        let positions: Vec<_> = clusters.vertices.iter().map(|vertex| vertex.position).collect();
        assert_eq!(clusters.in_mesh_order(&positions), mesh.positions);
        assert_eq!(clusters.in_mesh_order(&clusters.uv), mesh.uv);
        for (placed, index) in clusters.indices.iter().zip(&mesh.indices) {
            assert_eq!(clusters.order[*placed as usize], *index);
        }
        let slots_of_bones = Order::new(&model.skeleton).slots;
        let mut bones = 0;
        for (index, vertex) in clusters.order.iter().enumerate() {
            let (cluster, lane) = (index / 64, index % 64);
            let mask = &clusters.masks[5 * cluster..][..5];
            let [first, slots] = [0, 1].map(|at| clusters.influences[2 * cluster + at] as usize);
            let word = |column: usize| clusters.influences[first + 64 * column + lane];
            for slot in 0..slots {
                let found = word(slot / 2) >> (16 * (slot % 2)) & 0xffff;
                let weight =
                    if slot == 0 { f32::NAN } else { f32::from_bits(word(slots.div_ceil(2) + slot - 1)) };
                match mesh.influences.of(*vertex as usize).get(slot) {
                    Some(influence) => {
                        assert_eq!(found, influence.bone);
                        assert!(slot == 0 || weight == influence.weight);
                        let bone = skin.bones[found as usize];
                        let slot =
                            slots_of_bones.iter().position(|slot| slot.bone == bone).expect("one each");
                        assert_ne!(mask[slot / 32] & 1 << (slot % 32), 0);
                    }
                    None => assert_eq!(weight, 0.0),
                }
            }
            bones += if lane == 0 { mask.iter().map(|word| word.count_ones()).sum::<u32>() } else { 0 };
        }
        // On average, each cluster follows fewer than 8 of the 153 bones.
        assert!(bones < 8 * clusters.len() as u32, "{bones} in {}", clusters.len());
    }

    #[test]
    fn levels_are_the_first_slots() {
        let mut model = crate::samples::creature().expect("valid");
        let mesh = &mut model.meshes[0];
        let plain = Clusters::new(mesh, &model.skins, &model.skeleton).expect("fits");
        let (vertices, indices) = (mesh.vertices() as u32, mesh.indices.len() as u32);
        let whole = ClusterLevel { vertices, clusters: vertices.div_ceil(64), first_index: 0, indices };
        assert_eq!((&plain.levels, plain.level(3)), (&vec![whole], whole));
        let half: Vec<u32> = mesh.indices.chunks(6).flat_map(|pair| &pair[..3]).copied().collect();
        let one = half[300..303].to_vec();
        mesh.levels = [half, one].map(|indices| MeshLevel { indices, error: 0.0 }).to_vec();
        let clusters = Clusters::new(mesh, &model.skins, &model.skeleton).expect("fits");
        assert_eq!((clusters.levels.len(), clusters.level(0)), (3, whole));
        assert_eq!(clusters.level(9), clusters.level(2));
        let last = clusters.level(2);
        assert_eq!((last.vertices, last.clusters, last.indices), (3, 1, 3));
        for level in 0..3 {
            let ClusterLevel { vertices, clusters: held, first_index, indices } = clusters.level(level);
            let placed = &clusters.indices[first_index as usize..][..indices as usize];
            let named: Vec<u32> = placed.iter().map(|slot| clusters.order[*slot as usize]).collect();
            assert_eq!(named, mesh.triangles(level));
            // A level uses the first slots. Level 0 also includes vertices that no triangle uses.
            let used: std::collections::BTreeSet<_> = placed.iter().copied().collect();
            assert!(used.iter().copied().eq(0..vertices) || level == 0 && used.last() < Some(&vertices));
            assert_eq!(held, vertices.div_ceil(64));
        }
        let ends = [1, 2].map(|level| clusters.level(level).first_index);
        assert_eq!(ends, [indices, clusters.indices.len() as u32 - 3]);
        let of_character = clusters.clone().with_levels(&[0, 0, 2, 1, 9]);
        let levels = [0, 0, 2, 1, 2].map(|level| clusters.level(level));
        assert_eq!((of_character.levels, of_character.order), (levels.to_vec(), clusters.order.clone()));
        let mut order = clusters.order.clone();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..whole.vertices));
    }
}
