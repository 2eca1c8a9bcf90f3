//! Selection of the clusters that are skinned: the CPU reference of `kernels/skinning/select.wgsl`.

use crate::skinning::clusters::Clusters;
use crate::skinning::reduction::Reduction;

/// What decides in a frame.
#[derive(Debug, Clone, Copy)]
pub struct Now<'a> {
    /// The bones of each instance that moved, [`Clusters::mask_words`] words an instance.
    pub moved: &'a [u32],
    /// One an instance.
    pub reductions: &'a [Reduction],
    /// Of morph targets, instance by instance.
    pub weights: &'a [f32],
}

/// What is known of an instance from the frame before.
#[derive(Debug, Clone, PartialEq)]
pub struct Skinned {
    /// Its reduction then.
    pub reduction: Reduction,
    /// For how many frames it has been seen, 2 for more: see
    /// [`SelectBuffers::skinned`](crate::skinning::select::SelectBuffers::skinned).
    pub seen: u32,
    /// Its weights then.
    pub weights: Vec<f32>,
}

impl Skinned {
    /// Before the first frame.
    pub fn nothing(targets: usize) -> Self {
        Self { reduction: Reduction::UNSEEN, seen: 0, weights: vec![0.0; targets] }
    }
}

/// How influences count.
fn bits(reduction: &Reduction) -> [u32; 2] {
    [reduction.fade.to_bits(), reduction.most]
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
        let (reduction, last) = (&now.reductions[instance], &last[instance]);
        let is_beyond = |level| cluster >= clusters.level(level).clusters as usize;
        if reduction.most == 0 || is_beyond(reduction.level) {
            return false;
        }
        let mask = &clusters.masks[cluster * words..][..words];
        let moved = &now.moved[instance * words..][..words];
        let targets = last.weights.len();
        let weights = now.weights[instance * targets..][..targets].iter().zip(&last.weights);
        bits(reduction) != bits(&last.reduction)
            || is_beyond(last.reduction.level)
            || mask.iter().zip(moved).any(|(a, b)| a & b != 0)
            || clusters.morphs[cluster] && weights.clone().any(|(a, b)| a.to_bits() != b.to_bits())
    };
    (0..(clusters.len() * last.len()) as u32).filter(is_selected).collect()
}

/// Takes note of a frame, after [`select`].
pub fn remember(now: &Now<'_>, last: &mut [Skinned]) {
    for (instance, last) in last.iter_mut().enumerate() {
        last.reduction = now.reductions[instance];
        last.seen = if last.reduction.most == 0 { 0 } else { (last.seen + 1).min(2) };
        let targets = last.weights.len();
        last.weights.copy_from_slice(&now.weights[instance * targets..][..targets]);
    }
}
