//! Selection of the clusters to skin: the CPU reference of `kernels/skinning/select.wgsl`.

use crate::skinning::clusters::Clusters;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::select::ClusterState;

/// The inputs of a cluster selection: the state of all instances in the current frame.
#[derive(Debug, Clone, Copy)]
pub struct Now<'a> {
    /// The set of updated bones of each instance, as bits in [`Clusters::mask_words`] words.
    pub updated_bones: &'a [u32],
    /// Level of detail of each instance.
    pub instance_lods: &'a [InstanceLod],
    /// Weights of the morph targets, all weights of instance 0 first.
    pub weights: &'a [f32],
}

/// The state of an instance in the previous frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Skinned {
    /// The instance's level of detail in the previous frame.
    pub instance_lod: InstanceLod,
    /// Visibility: 0 if invisible, 1 if newly visible, and 2 if also visible in the frame before; see
    /// [`ClusterSelectBuffers::skinned`](crate::skinning::select::ClusterSelectBuffers::skinned).
    pub seen: u32,
    /// The instance's morph weights in the previous frame.
    pub weights: Vec<f32>,
}

impl Skinned {
    /// The state before the first frame: invisible, with all weights 0.
    pub fn nothing(targets: usize) -> Self {
        Self { instance_lod: InstanceLod::UNSEEN, seen: 0, weights: vec![0.0; targets] }
    }
}

/// The parts of a level of detail that determine a vertex's influences, as bits.
fn bits(instance_lod: &InstanceLod) -> [u32; 3] {
    [instance_lod.influence_fade.to_bits(), instance_lod.max_influences, instance_lod.tier]
}

/// The clusters to skin, as ascending numbers `cluster · instances + instance`. Visible instances at their level of
/// detail contribute:
/// - clusters with an updated bone;
/// - clusters that morph targets move, if a weight has changed since the previous frame;
/// - clusters that the level of detail of the previous frame did not include;
/// - all clusters of instances whose influences changed.
///
/// # Panics
/// If the lengths of the lists do not match the number of instances in `last`.
pub fn select(clusters: &Clusters, now: &Now<'_>, last: &[Skinned]) -> Vec<u32> {
    let words = clusters.mask_words;
    let is_selected = |pair: &u32| {
        let (cluster, instance) = (*pair as usize / last.len(), *pair as usize % last.len());
        let (instance_lod, last) = (&now.instance_lods[instance], &last[instance]);
        let is_beyond = |level| cluster >= clusters.level(level).clusters as usize;
        if instance_lod.max_influences == 0 || is_beyond(instance_lod.mesh_lod) {
            return false;
        }
        let of_tier = instance_lod.tier as usize * clusters.len() + cluster;
        let mask = &clusters.masks[of_tier * words..][..words];
        let updated_bones = &now.updated_bones[instance * words..][..words];
        let targets = last.weights.len();
        let weights = now.weights[instance * targets..][..targets].iter().zip(&last.weights);
        bits(instance_lod) != bits(&last.instance_lod)
            || is_beyond(last.instance_lod.mesh_lod)
            || mask.iter().zip(updated_bones).any(|(a, b)| a & b != 0)
            || clusters.morphs[cluster] && weights.clone().any(|(a, b)| a.to_bits() != b.to_bits())
    };
    (0..(clusters.len() * last.len()) as u32).filter(is_selected).collect()
}

/// As [`select`], but also tracks the positions of the previous frame. `states` has one state per cluster and instance:
/// from the last selection on input, from this selection on output. A cluster that moved in the last frame is selected
/// once more.
///
/// # Panics
/// In the cases of [`select`], and if there are fewer states than pairs of a cluster and an instance.
pub fn select_keeping(
    clusters: &Clusters,
    now: &Now<'_>,
    last: &[Skinned],
    states: &mut [ClusterState],
) -> Vec<u32> {
    let mut selected = select(clusters, now, last);
    for pair in 0..(clusters.len() * last.len()) as u32 {
        let (cluster, instance) = (pair as usize / last.len(), pair as usize % last.len());
        let (lod, before) = (&now.instance_lods[instance], &last[instance].instance_lod);
        let is_beyond = |level| cluster >= clusters.level(level).clusters as usize;
        if lod.max_influences == 0 || is_beyond(lod.mesh_lod) {
            continue;
        }
        let state = &mut states[pair as usize];
        let was = *state;
        *state = match selected.binary_search(&pair) {
            Ok(_) if before.max_influences == 0 || is_beyond(before.mesh_lod) => ClusterState::Fresh,
            Ok(_) => ClusterState::Moved,
            Err(at) => {
                if was == ClusterState::Moved {
                    selected.insert(at, pair);
                }
                ClusterState::Still
            }
        };
    }
    selected
}

/// Stores the state of the current frame in `last`, for the next selection. Call it after [`select`].
pub fn remember(now: &Now<'_>, last: &mut [Skinned]) {
    for (instance, last) in last.iter_mut().enumerate() {
        last.instance_lod = now.instance_lods[instance];
        last.seen = if last.instance_lod.max_influences == 0 { 0 } else { (last.seen + 1).min(2) };
        let targets = last.weights.len();
        last.weights.copy_from_slice(&now.weights[instance * targets..][..targets]);
    }
}
