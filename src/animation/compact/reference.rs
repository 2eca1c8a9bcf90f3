//! Conversion of bit masks to lists: the CPU reference of `kernels/animation/compact.wgsl`.

use crate::animation::active::PAIR_AHEAD;
use crate::animation::gate::reference::ChosenBones;
use crate::animation::gate_table::bits_of;
use crate::animation::order::Order;

/// Work lists of one frame: the pairs to sample, the slots to update and the instances with active bones.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Work {
    /// Pair index `instance · bones + bone` of each pair to sample, in the order of instances and slots. The flag [`PAIR_AHEAD`]
    /// is set if the pair is sampled ahead.
    pub pairs: Vec<u32>,
    /// One bit per slot of each instance, set for active bones and all their descendants.
    pub updated_bones: Vec<u32>,
    /// Indices of the instances with at least one active bone.
    pub instances: Vec<u32>,
}

/// Combines the updated bones of this frame with the bits of earlier frames that some reader has not processed yet.
pub fn accumulated(before: &[u32], updated_bones: &[u32]) -> Vec<u32> {
    before.iter().zip(updated_bones).map(|(before, now)| before | now).collect()
}

/// Builds the work lists from the chosen bits, which have [`Order::words`] words per instance.
pub fn compact(order: &Order, chosen: &ChosenBones) -> Work {
    let ChosenBones { bits, ahead } = chosen;
    let bones = order.slots.len() as u32;
    let mut work = Work { updated_bones: Vec::with_capacity(bits.len()), ..Work::default() };
    let each = bits.chunks_exact(order.words()).zip(ahead.chunks_exact(order.words()));
    for (instance, (words, ahead)) in (0..).zip(each) {
        let first_pair = work.pairs.len();
        let mut end = 0;
        for (word, active) in words.iter().enumerate() {
            let mut below = 0;
            for bit in 0..32 {
                let slot = 32 * word + bit;
                if active >> bit & 1 != 0 {
                    end = end.max(slot + order.slots[slot].subtree as usize);
                }
                below |= u32::from(slot < end) << bit;
            }
            work.updated_bones.push(below);
            work.pairs.extend(bits_of(*active).map(|bit| {
                let pair = instance * bones + order.slots[32 * word + bit].bone;
                if ahead[word] >> bit & 1 != 0 { pair | PAIR_AHEAD } else { pair }
            }));
        }
        if work.pairs.len() > first_pair {
            work.instances.push(instance);
        }
    }
    work
}
