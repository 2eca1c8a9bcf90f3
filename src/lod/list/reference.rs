//! Lists of instances: the CPU reference of `kernels/lod/list.wgsl`.

use crate::lod::{LodObject, OBJECT_LISTS};

/// The lists of an object from the decisions of its instances: indices relative to the object's first instance, ascending.
///
/// # Panics
/// If the object's instances are not all in `decisions`.
pub fn lists(object: &LodObject, decisions: &[u32]) -> [Vec<u32>; OBJECT_LISTS as usize] {
    let mut lists = std::array::from_fn(|_| Vec::new());
    let own = &decisions[object.first as usize..][..object.instances as usize];
    for (instance, decision) in (0..).zip(own).filter(|(_, decision)| **decision > 0) {
        lists[*decision as usize - 1].push(instance);
    }
    lists
}
