//! Order in which kernels process the bones of a skeleton: parents first, split into chains.

use crate::asset::skeleton::Skeleton;
pub use crate::shared::animation::order::Chain;
#[cfg(feature = "gpu")]
use crate::shared::animation::order::{self as packed, CONTINUES, NO_PARENT};

/// Position in an [`Order`], with the bone at this position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    /// Index of the bone in the skeleton.
    pub bone: u32,
    /// Where to find the bone's parent.
    pub parent: SlotParent,
    /// Number of slots of the bone's subtree, including this slot. The subtree's slots are contiguous.
    pub subtree: u32,
}

/// Where to find the parent of a slot's bone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlotParent {
    /// The bone is a root.
    Root,
    /// The parent is the bone of the previous slot. The slot continues the chain of its parent.
    PreviousSlot,
    /// The parent is the bone with this index. The slot begins a new chain.
    Bone(u32),
}

#[cfg(feature = "gpu")]
impl Slot {
    /// The slot in the packed form that kernels read.
    pub(crate) fn packed(&self) -> packed::Slot {
        let parent = match self.parent {
            SlotParent::Root => NO_PARENT,
            SlotParent::PreviousSlot => CONTINUES,
            SlotParent::Bone(bone) => bone,
        };
        packed::Slot { bone: self.bone, parent, subtree: self.subtree }
    }
}

/// Order in which a skeleton's bones are processed, parents first. It is split into chains such that dependencies between chains
/// form few levels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Order {
    /// One slot per bone; parents come before their children.
    pub slots: Vec<Slot>,
    /// Chains, sorted by level. Chains of the first level depend on no other chain. Chains of each further level depend on chains
    /// of earlier levels.
    pub chains: Vec<Chain>,
    /// Index in `chains` of the first chain of each level, followed by the number of chains.
    pub levels: Vec<u32>,
    /// Tier of the skeleton that each slot's bone belongs to ([`Skeleton::with_tier`]).
    pub tiers: Vec<u32>,
}

impl Order {
    /// Computes the order of a skeleton's bones.
    pub fn new(skeleton: &Skeleton) -> Self {
        let target = remap(skeleton);
        let others = other_children(skeleton, &target);
        let bones = skeleton.bones();
        let mut slots: Vec<Slot> = Vec::with_capacity(bones.len());
        // Chains found so far, by level.
        let mut chains: Vec<Vec<Chain>> = Vec::new();
        let roots = (0..bones.len() as u32).filter(|bone| bones[*bone as usize].parent.is_none());
        // Stack of chains that are still to be processed: the first bone and the level of each chain. The last entry is processed
        // next.
        let mut waiting: Vec<(u32, usize)> = roots.rev().map(|root| (root, 0)).collect();
        while let Some((first_bone, level)) = waiting.pop() {
            let first = slots.len() as u32;
            for bone in std::iter::successors(Some(first_bone), |bone| target[*bone as usize]) {
                let parent = match bones[bone as usize].parent {
                    _ if bone != first_bone => SlotParent::PreviousSlot,
                    Some(above) => SlotParent::Bone(above),
                    None => SlotParent::Root,
                };
                let subtree = skeleton.descendants()[bone as usize] + 1;
                slots.push(Slot { bone, parent, subtree });
                waiting.extend(others[bone as usize].iter().map(|child| (*child, level + 1)));
            }
            chains.resize(chains.len().max(level + 1), Vec::new());
            chains[level].push(Chain { first, count: slots.len() as u32 - first });
        }
        let tiers = slots.iter().map(|slot| skeleton.tier_of(slot.bone) as u32).collect();
        let mut order = Self { slots, chains: Vec::new(), levels: vec![0], tiers };
        for mut level in chains {
            // Sort by length, so that neighbouring threads of one instance process chains of similar length.
            level.sort_by_key(|chain| std::cmp::Reverse(chain.count));
            order.chains.extend(level);
            order.levels.push(order.chains.len() as u32);
        }
        order
    }

    /// Slot index of each bone, by bone index.
    pub(crate) fn slots_of_bones(&self) -> Vec<usize> {
        let mut slot_of = vec![0; self.slots.len()];
        self.slots.iter().enumerate().for_each(|(at, slot)| slot_of[slot.bone as usize] = at);
        slot_of
    }

    /// All slots in the packed form that kernels read.
    #[cfg(feature = "gpu")]
    pub(crate) fn packed_slots(&self) -> Vec<packed::Slot> {
        self.slots.iter().map(Slot::packed).collect()
    }

    /// Number of 32-bit words per instance that hold one bit per bone.
    pub fn words(&self) -> usize {
        self.slots.len().div_ceil(32)
    }
}

/// For each bone, the children that do not continue its chain, but begin chains of their own.
fn other_children(skeleton: &Skeleton, target: &[Option<u32>]) -> Vec<Vec<u32>> {
    let mut others = vec![Vec::new(); skeleton.len()];
    for (bone, node) in (0..).zip(skeleton.bones()) {
        if let Some(parent) = node.parent
            && target[parent as usize] != Some(bone)
        {
            others[parent as usize].push(bone);
        }
    }
    others
}

/// For each bone, the child that continues its chain. It is the child whose subtree has the most levels of chains. Among equals,
/// it is the child whose subtree has the most bones.
fn remap(skeleton: &Skeleton) -> Vec<Option<u32>> {
    let mut target: Vec<Option<u32>> = vec![None; skeleton.len()];
    // Levels of chains that a bone's subtree needs, counting the chain through the bone as the first.
    let mut levels = vec![1_u32; skeleton.len()];
    let mut best: Vec<(u32, u32)> = vec![(0, 0); skeleton.len()];
    for (bone, node) in skeleton.bones().iter().enumerate().rev() {
        let Some(parent) = node.parent.map(|parent| parent as usize) else { continue };
        let rank = (levels[bone], skeleton.descendants()[bone] + 1);
        // The child that continues the chain needs no extra level. Every other child needs one more level.
        if rank >= best[parent] {
            levels[parent] = levels[parent].max(rank.0).max(best[parent].0 + u32::from(best[parent].0 > 0));
            best[parent] = rank;
            target[parent] = Some(bone as u32);
        } else {
            levels[parent] = levels[parent].max(rank.0 + 1);
        }
    }
    target
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::skeleton::Bone;
    use crate::asset::transform::Transform;

    fn skeleton(parents: &[Option<u32>]) -> Skeleton {
        let bone =
            |parent: &Option<u32>| Bone { name: String::new(), parent: *parent, rest: Transform::IDENTITY };
        Skeleton::of_joints(parents.iter().map(bone).collect()).expect("valid")
    }

    /// Checks that every bone occurs once and parents come first, that subtrees are contiguous, and that chains depend only on
    /// chains of lower levels.
    fn check(skeleton: &Skeleton) -> Order {
        let order = Order::new(skeleton);
        let mut slot_of = vec![usize::MAX; skeleton.len()];
        for (at, slot) in order.slots.iter().enumerate() {
            let above = skeleton.bones()[slot.bone as usize].parent;
            match slot.parent {
                SlotParent::Root => assert_eq!(above, None),
                SlotParent::PreviousSlot => assert_eq!(above, Some(order.slots[at - 1].bone)),
                SlotParent::Bone(parent) => assert_eq!(above, Some(parent)),
            }
            assert!(above.is_none_or(|above| slot_of[above as usize] < at), "a parent comes later");
            let old = std::mem::replace(&mut slot_of[slot.bone as usize], at);
            assert_eq!(old, usize::MAX, "{} twice", slot.bone);
        }
        for (bone, node) in skeleton.bones().iter().enumerate() {
            let below = |at: usize| at..at + order.slots[at].subtree as usize;
            if let Some(parent) = node.parent {
                let (here, above) = (below(slot_of[bone]), below(slot_of[parent as usize]));
                assert!(above.start < here.start && here.end <= above.end, "a subtree with a gap");
            }
        }
        let mut done = vec![false; skeleton.len()];
        for level in order.levels.windows(2) {
            let here = &order.chains[level[0] as usize..level[1] as usize];
            assert!(!here.is_empty());
            let slots = |chain: &Chain| chain.first as usize..(chain.first + chain.count) as usize;
            for chain in here {
                match order.slots[chain.first as usize].parent {
                    SlotParent::Root => {}
                    SlotParent::PreviousSlot => panic!("a chain begins with the parent of the slot before"),
                    SlotParent::Bone(parent) => {
                        assert!(done[slot_of[parent as usize]], "a parent of the same level");
                    }
                }
                let rest = &order.slots[slots(chain)][1..];
                assert!(rest.iter().all(|slot| slot.parent == SlotParent::PreviousSlot));
            }
            here.iter().flat_map(slots).for_each(|slot| assert!(!std::mem::replace(&mut done[slot], true)));
        }
        assert!(done.iter().all(|done| *done), "a slot is missing");
        order
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
        // A full binary tree of 10 levels needs 10 levels of chains.
        let tree: Vec<_> = (0..1023_u32).map(|bone| bone.checked_sub(1).map(|bone| bone / 2)).collect();
        assert_eq!(check(&skeleton(&tree)).levels.len() - 1, 10);
        let model = crate::samples::creature().expect("valid");
        let deepest = model.skeleton.depths().iter().max().copied();
        assert_eq!((deepest, check(&model.skeleton).levels.len() - 1), (Some(19), 3));
    }
}
