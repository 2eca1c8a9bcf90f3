//! Which clusters are skinned: twin of `kernels/skinning/select.wgsl`.

use crate::skinning::clusters::Clusters;
use crate::skinning::weights::Reduction;

/// `cluster · instances + instance` of those with a bone that moved, and of those whose reduction is another than when
/// they were `skinned` last; ascending. `moved` are [`Clusters::mask_words`] words an instance.
pub fn select(
    clusters: &Clusters,
    moved: &[u32],
    reductions: &[Reduction],
    skinned: &[Reduction],
) -> Vec<u32> {
    let words = clusters.mask_words;
    let instances = reductions.len();
    let is_selected = |pair: &u32| {
        let (cluster, instance) = (*pair as usize / instances, *pair as usize % instances);
        let mask = &clusters.masks[cluster * words..][..words];
        let moved = &moved[instance * words..][..words];
        let bits = |reduction: &Reduction| (reduction.fade.to_bits(), reduction.most);
        bits(&reductions[instance]) != bits(&skinned[instance])
            || mask.iter().zip(moved).any(|(a, b)| a & b != 0)
    };
    (0..(clusters.len() * instances) as u32).filter(is_selected).collect()
}
