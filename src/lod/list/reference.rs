//! Lists of instances: the CPU reference of `kernels/lod/list.wgsl`.

use crate::lod::transition::entries;
use crate::lod::{LodObject, OBJECT_LISTS};

/// List entries of an object, computed from the decisions of its instances. Each list ascends by instance.
///
/// # Panics
/// If the object's instances are not all in `decisions`.
pub fn lists(object: &LodObject, decisions: &[u32]) -> [Vec<u32>; OBJECT_LISTS as usize] {
    let mut lists: [Vec<u32>; OBJECT_LISTS as usize] = std::array::from_fn(|_| Vec::new());
    let own = &decisions[object.first as usize..][..object.instances as usize];
    for (instance, decision) in (0..).zip(own) {
        entries(object, *decision, instance)
            .into_iter()
            .for_each(|(list, entry)| lists[list as usize].push(entry));
    }
    lists
}

/// For each block of one object and each list, the number of instances in the blocks before it. Input: counts per block and list.
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
    use crate::shared::lod::object::{
        FADE_PROGRESS, decision_word, fade_word, list_entry_word, object_flags_word,
    };
    use crate::shared::lod::transition::{TRANSITION_DITHER, TRANSITION_GEOMORPH};

    #[test]
    fn lists_keep_the_order_of_instances() {
        let flags = |transition| object_flags_word(1, 0, 0, transition, 0);
        let object = LodObject {
            first: 64,
            instances: 64,
            levels: 3,
            flags: flags(TRANSITION_GEOMORPH),
            ..LodObject::NONE
        };
        let mut decisions = vec![decision_word(1, 0, 2, 2, 0); 64];
        let decision = |instance: u32| match instance < 60 {
            true => decision_word(1, instance % 2, instance / 2 % 2, instance / 2 % 2, 0),
            false => 0,
        };
        decisions.extend((0..64).map(decision));
        let found = lists(&object, &decisions);
        assert_eq!(found[1], (0..15).map(|at| list_entry_word(4 * at + 1, 0, 0)).collect::<Vec<u32>>());
        assert_eq!(found.iter().map(Vec::len).sum::<usize>(), 60);
        assert!(found[4].is_empty(), "another object's instances");
        decisions[66] = decision_word(1, 0, 1, 1, 5);
        assert_eq!(lists(&object, &decisions)[2][0], list_entry_word(2, 1, 5));
        // A dither halfway through: both levels are listed, each in its list of fading instances.
        decisions[66] = decision_word(1, 1, 1, 2, FADE_PROGRESS / 2);
        let found = lists(&LodObject { flags: flags(TRANSITION_DITHER), ..object }, &decisions);
        assert_eq!(found[6 + 2 + 1], [list_entry_word(2, 1, fade_word(64, 0))]);
        assert_eq!(found[6 + 4 + 1], [list_entry_word(2, 2, fade_word(64, 1))]);
    }

    #[test]
    fn sums_leave_out_their_own_block() {
        let counts: Vec<u32> = (0..96).map(|at| at / 32 + at % 32).collect();
        let before = before_blocks(&counts);
        assert_eq!(before[..32], [0; 32]);
        assert_eq!([before[32 + 3], before[64 + 3]], [3, 3 + 4]);
    }
}
