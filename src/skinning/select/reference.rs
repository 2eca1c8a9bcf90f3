//! Which clusters are skinned: reference of `kernels/skinning/select.wgsl`.

use crate::skinning::clusters::Clusters;
use crate::skinning::instance_lod::InstanceLod;

/// What decides in a frame.
#[derive(Debug, Clone, Copy)]
pub struct Now<'a> {
    /// The bones of each instance that moved, [`Clusters::mask_words`] words an instance.
    pub updated_bones: &'a [u32],
    /// One an instance.
    pub instance_lods: &'a [InstanceLod],
    /// Of morph targets, instance by instance.
    pub weights: &'a [f32],
}

/// What is known of an instance from the frame before.
#[derive(Debug, Clone, PartialEq)]
pub struct Skinned {
    /// Its reduction then.
    pub instance_lod: InstanceLod,
    /// For how many frames it has been seen, 2 for more: see
    /// [`SelectBuffers::skinned`](crate::skinning::select::SelectBuffers::skinned).
    pub seen: u32,
    /// Its weights then.
    pub weights: Vec<f32>,
}

impl Skinned {
    /// Before the first frame.
    pub fn nothing(targets: usize) -> Self {
        Self { instance_lod: InstanceLod::UNSEEN, seen: 0, weights: vec![0.0; targets] }
    }
}

/// How influences count.
fn bits(instance_lod: &InstanceLod) -> [u32; 2] {
    [instance_lod.fade.to_bits(), instance_lod.most]
}

/// `cluster · instances + instance` of what is skinned, of the instances that are seen, at their level of detail:
/// clusters with a bone that moved, clusters that targets move, where a weight is another than in the frame before,
/// those beyond the level of the frame before, and all of instances whose influences count otherwise; ascending.
///
/// # Panics
/// For lists of other lengths than the instances that `last` has.
pub fn select(clusters: &Clusters, now: &Now<'_>, last: &[Skinned]) -> Vec<u32> {
    let words = clusters.mask_words;
    let is_selected = |pair: &u32| {
        let (cluster, instance) = (*pair as usize / last.len(), *pair as usize % last.len());
        let (instance_lod, last) = (&now.instance_lods[instance], &last[instance]);
        let is_beyond = |level| cluster >= clusters.level(level).clusters as usize;
        if instance_lod.most == 0 || is_beyond(instance_lod.level) {
            return false;
        }
        let mask = &clusters.masks[cluster * words..][..words];
        let updated_bones = &now.updated_bones[instance * words..][..words];
        let targets = last.weights.len();
        let weights = now.weights[instance * targets..][..targets].iter().zip(&last.weights);
        bits(instance_lod) != bits(&last.instance_lod)
            || is_beyond(last.instance_lod.level)
            || mask.iter().zip(updated_bones).any(|(a, b)| a & b != 0)
            || clusters.morphs[cluster] && weights.clone().any(|(a, b)| a.to_bits() != b.to_bits())
    };
    (0..(clusters.len() * last.len()) as u32).filter(is_selected).collect()
}

/// Takes note of a frame, after [`select`].
pub fn remember(now: &Now<'_>, last: &mut [Skinned]) {
    for (instance, last) in last.iter_mut().enumerate() {
        last.instance_lod = now.instance_lods[instance];
        last.seen = if last.instance_lod.most == 0 { 0 } else { (last.seen + 1).min(2) };
        let targets = last.weights.len();
        last.weights.copy_from_slice(&now.weights[instance * targets..][..targets]);
    }
}
