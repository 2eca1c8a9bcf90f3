//! Concatenation of local transforms into the model's space, parents first.
//!
//! The skeleton is cut into chains, each a run of bones from parent to child, as heavy-path decompositions cut trees.
//! A thread walks one chain of one instance with the parent's matrix in registers: every matrix is read once a chain
//! instead of once a bone, and a dispatch serves every chain whose parent is done. There are far fewer such dispatches
//! than levels of bones. Where processors are few, a thread walks all chains of its instance (`Walk`).

use super::skeleton::Skeleton;

#[cfg(feature = "gpu")]
mod pass;

#[cfg(feature = "gpu")]
pub use pass::{ConcatJob, ConcatPass, Walk};

/// How far a component may lie from the twin's, on any device: times the bones of the longest chain, times the largest
/// component (at least 1). A local matrix carries 10ε of its scale (ε = 2⁻²⁴, each operation to either neighbour 2ε), a
/// row of the product 8ε of the sum of its terms, at most √3 of the largest component: 32ε a bone, rounded up.
pub const CONCAT_BOUND: f32 = 2e-6;

/// The parent of a chain that begins at a root.
pub const NO_PARENT: u32 = u32::MAX;

/// Bones from parent to child.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Chain {
    /// Where its bones begin, in [`Chains::bones`].
    pub first: u32,
    /// How many.
    pub count: u32,
    /// The bone above the first, or [`NO_PARENT`].
    pub parent: u32,
    /// Unused.
    pub padding: u32,
}

/// A skeleton's chains, cut so that as few as possible wait for each other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chains {
    /// All bones, chain by chain.
    pub bones: Vec<u32>,
    /// Those that wait for none, then those that wait for these, and so on.
    pub chains: Vec<Chain>,
    /// Where each such level begins; one more than there are levels.
    pub levels: Vec<u32>,
}

impl Chains {
    /// The chains of a skeleton.
    pub fn new(skeleton: &Skeleton) -> Self {
        let heir = heirs(skeleton);
        // A bone that is nobody's heir begins a chain; its level is one below that of the chain it hangs from.
        let mut level_of_bone = vec![0; skeleton.len()];
        let mut begins: Vec<Vec<u32>> = Vec::new();
        for (bone, node) in (0..).zip(skeleton.bones()) {
            let parent = node.parent.map(|parent| parent as usize);
            let continues = parent.is_some_and(|parent| heir[parent] == Some(bone));
            let above = parent.map(|parent| level_of_bone[parent]);
            let level = above.map_or(0, |above| above + usize::from(!continues));
            level_of_bone[bone as usize] = level;
            if !continues {
                begins.resize(begins.len().max(level + 1), Vec::new());
                begins[level].push(bone);
            }
        }
        let mut all = Self { bones: Vec::with_capacity(skeleton.len()), chains: Vec::new(), levels: vec![0] };
        let length = |first: u32| std::iter::successors(Some(first), |bone| heir[*bone as usize]).count();
        for mut level in begins {
            // Threads beside each other walk chains of one instance, as long as each other where possible.
            level.sort_by_key(|first| std::cmp::Reverse(length(*first)));
            for first in level {
                let start = all.bones.len();
                all.bones.extend(std::iter::successors(Some(first), |bone| heir[*bone as usize]));
                all.chains.push(Chain {
                    first: start as u32,
                    count: (all.bones.len() - start) as u32,
                    parent: skeleton.bones()[first as usize].parent.unwrap_or(NO_PARENT),
                    padding: 0,
                });
            }
            all.levels.push(all.chains.len() as u32);
        }
        all
    }
}

/// For each bone, the child that continues its chain: the one below which most levels of chains lie, or else most
/// bones.
fn heirs(skeleton: &Skeleton) -> Vec<Option<u32>> {
    let mut heir: Vec<Option<u32>> = vec![None; skeleton.len()];
    // Levels that a bone's chain and all below need, if it continues into its heir; and into no child.
    let mut levels = vec![1_u32; skeleton.len()];
    let mut best: Vec<(u32, u32)> = vec![(0, 0); skeleton.len()];
    for (bone, node) in skeleton.bones().iter().enumerate().rev() {
        let Some(parent) = node.parent.map(|parent| parent as usize) else { continue };
        let rank = (levels[bone], skeleton.descendants()[bone] + 1);
        // The heir's levels count as they are, those of others one more.
        if rank >= best[parent] {
            levels[parent] = levels[parent].max(rank.0).max(best[parent].0 + u32::from(best[parent].0 > 0));
            best[parent] = rank;
            heir[parent] = Some(bone as u32);
        } else {
            levels[parent] = levels[parent].max(rank.0 + 1);
        }
    }
    heir
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::skeleton::Bone;
    use crate::animation::transform::Transform;

    fn skeleton(parents: &[Option<u32>]) -> Skeleton {
        let bone =
            |parent: &Option<u32>| Bone { name: String::new(), parent: *parent, rest: Transform::IDENTITY };
        Skeleton::of_joints(parents.iter().map(bone).collect()).expect("valid")
    }

    /// Every bone once, parents first, in dispatches that wait for each other.
    fn check(skeleton: &Skeleton) -> Chains {
        let chains = Chains::new(skeleton);
        let mut done = vec![false; skeleton.len()];
        for level in chains.levels.windows(2) {
            let here = &chains.chains[level[0] as usize..level[1] as usize];
            assert!(!here.is_empty());
            for chain in here {
                assert!(
                    chain.parent == NO_PARENT || done[chain.parent as usize],
                    "a parent of the same level"
                );
            }
            for chain in here {
                let mut above = (chain.parent != NO_PARENT).then_some(chain.parent);
                for bone in &chains.bones[chain.first as usize..][..chain.count as usize] {
                    assert_eq!(skeleton.bones()[*bone as usize].parent, above);
                    assert!(!std::mem::replace(&mut done[*bone as usize], true), "{bone} twice");
                    above = Some(*bone);
                }
            }
        }
        assert!(done.iter().all(|done| *done), "a bone is missing");
        chains
    }

    #[test]
    fn chains_cover_the_skeleton_parents_first() {
        assert_eq!(check(&skeleton(&[None])).levels, [0, 1]);
        let line: Vec<_> = (0..1000_u32).map(|bone| bone.checked_sub(1)).collect();
        assert_eq!(check(&skeleton(&line)).chains.len(), 1);
        let star: Vec<_> = (0..1000_u32).map(|bone| (bone > 0).then_some(0)).collect();
        assert_eq!(check(&skeleton(&star)).levels.len(), 3);
        check(&skeleton(&[None, None, Some(0), Some(1), None]));
        let random: Vec<_> = (0..1000_u32).map(|bone| (bone > 0).then(|| bone * 7919 % bone)).collect();
        check(&skeleton(&random));
    }

    #[test]
    fn few_chains_wait_for_each_other() {
        // A full binary tree needs as many levels as it has; one of 10 levels.
        let tree: Vec<_> = (0..1023_u32).map(|bone| bone.checked_sub(1).map(|bone| bone / 2)).collect();
        assert_eq!(check(&skeleton(&tree)).levels.len() - 1, 10);
        let model = crate::animation::creature().expect("valid");
        let deepest = model.skeleton.depths().iter().max().copied();
        assert_eq!((deepest, check(&model.skeleton).levels.len() - 1), (Some(19), 3));
    }
}
