//! Lists of instances: the CPU reference of `kernels/lod/list.wgsl`.

use crate::lod::{LodObject, OBJECT_LISTS};
use crate::shared::lod::object::{decision_list, decision_morph, list_entry_word};

/// The list entries of an object from its instances' decisions, ascending by instance.
///
/// # Panics
/// If the object's instances are not all in `decisions`.
pub fn lists(object: &LodObject, decisions: &[u32]) -> [Vec<u32>; OBJECT_LISTS as usize] {
    let mut lists: [Vec<u32>; OBJECT_LISTS as usize] = std::array::from_fn(|_| Vec::new());
    let own = &decisions[object.first as usize..][..object.instances as usize];
    for (instance, decision) in (0..).zip(own).filter(|(_, decision)| **decision > 0) {
        let entry = list_entry_word(instance, decision_morph(*decision));
        lists[decision_list(*decision) as usize - 1].push(entry);
    }
    lists
}

/// Exclusive prefix sums over the blocks of one object, per list, from the counts per block.
pub fn before_blocks(counts: &[u32]) -> Vec<u32> {
    let mut sums = [0; OBJECT_LISTS as usize];
    let mut before = Vec::with_capacity(counts.len());
    for block in counts.chunks(OBJECT_LISTS as usize) {
        before.extend(sums);
        sums.iter_mut().zip(block).for_each(|(sum, count)| *sum += count);
    }
    before
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::LodObject;

    #[test]
    fn lists_keep_the_order_of_instances() {
        let object = LodObject { first: 64, instances: 64, ..LodObject::NONE };
        let mut decisions = vec![9; 64];
        decisions.extend((0..64).map(|instance| if instance < 60 { 1 + instance % 3 } else { 0 }));
        let lists = lists(&object, &decisions);
        assert_eq!(lists[1], (0..20).map(|at| 3 * at + 1).collect::<Vec<u32>>());
        assert_eq!(lists.iter().map(Vec::len).sum::<usize>(), 60);
        assert!(lists[8].is_empty(), "another object's instances");
        // A level that has morphed by 5 of 511 steps.
        decisions[67] |= (2 | 5 << 3) << 8;
        assert_eq!(super::lists(&object, &decisions)[0][1], 3 | (2 | 5 << 3) << 20);
    }

    #[test]
    fn sums_leave_out_their_own_block() {
        let counts: Vec<u32> = (0..48).map(|at| at / 16 + at % 16).collect();
        let before = before_blocks(&counts);
        assert_eq!(before[..16], [0; 16]);
        assert_eq!([before[16 + 3], before[32 + 3]], [3, 3 + 4]);
    }
}
