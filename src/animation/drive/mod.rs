//! Driven bones: bones whose local transforms the caller overwrites after sampling and before concatenation into model space.
//! Examples are inverse kinematics and ragdolls.
//!
//! A gate cannot know how the caller moves a bone. Driven bones of visible instances are therefore sampled in every frame, at the
//! frame's time, whatever the gate decides. Driven bones and their descendants count as updated. Driven bones are added to a
//! gate's bits before [`compact`](super::compact) turns the bits into lists.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::DrivePass;

use super::order::Order;
pub use crate::shared::animation::drive::DrivenWord;

/// The driven bones of one instance: an input of [`driven_words`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DrivenBones<'a> {
    /// Index of the instance in its crowd.
    pub instance: u32,
    /// Skeleton indices of the instance's driven bones, in any order.
    pub bones: &'a [u32],
}

/// Returns the bit words that contain driven bones, in ascending order and without duplicates. If an instance occurs several
/// times in `driven`, its bones are combined.
///
/// # Panics
/// If a bone index is not in the skeleton of `order`.
pub fn driven_words<'a>(order: &Order, driven: impl IntoIterator<Item = DrivenBones<'a>>) -> Vec<DrivenWord> {
    let slot_of = order.slots_of_bones();
    let words = order.words() as u32;
    let mut all = std::collections::BTreeMap::new();
    for DrivenBones { instance, bones } in driven {
        for bone in bones {
            let slot = slot_of[*bone as usize] as u32;
            *all.entry(instance * words + slot / 32).or_insert(0) |= 1_u32 << (slot % 32);
        }
    }
    all.into_iter().map(|(at, bones)| DrivenWord { at, bones }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::{Bone, Skeleton, Transform};

    #[test]
    fn words_hold_the_slots_of_their_bones() {
        let bone = |index: u32| {
            let (parent, rest) = (index.checked_sub(1), Transform::IDENTITY);
            Bone { name: format!("{index}"), parent, rest }
        };
        let skeleton = Skeleton::of_joints((0..40).map(bone).collect()).expect("valid");
        let order = Order::new(&skeleton);
        let driven = [(2, &[33, 1, 0][..]), (0, &[39]), (2, &[1])];
        let words = driven_words(&order, driven.map(|(instance, bones)| DrivenBones { instance, bones }));
        let found: Vec<_> = words.iter().map(|word| (word.at, word.bones)).collect();
        assert_eq!(found, [(1, 1 << 7), (4, 0b11), (5, 0b10)]);
    }
}
