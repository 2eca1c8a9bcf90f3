//! Handles of objects and instances, which never name anything but what they were made for.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::InputError;

/// Tells one scene of the program from all others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct SceneNumber(u64);

impl SceneNumber {
    /// A number that no other scene has.
    fn next() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// An object of a scene: terrain, a mesh or a character. Instances of it can be spawned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ObjectId {
    pub(super) scene: SceneNumber,
    pub(super) index: u32,
    pub(super) generation: u32,
}

impl ObjectId {
    /// The number of the object in pictures and shaders, from 1 on. A later object may have it after a removal.
    pub fn number(&self) -> u32 {
        self.index + 1
    }
}

/// An instance of an object of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct InstanceId {
    pub(super) object: ObjectId,
    pub(super) index: u32,
    pub(super) generation: u32,
}

impl InstanceId {
    /// The object.
    pub fn object(&self) -> ObjectId {
        self.object
    }

    /// The number of the instance in its object in pictures and shaders, from 0 on. A later instance may have it after a
    /// removal.
    pub fn number(&self) -> u32 {
        self.index
    }
}

/// Values of one scene in slots that are used again, each time with another generation.
#[derive(Debug)]
pub(super) struct Slots<T> {
    scene: SceneNumber,
    slots: Vec<(u32, Option<T>)>,
}

impl<T> Default for Slots<T> {
    fn default() -> Self {
        Self { scene: SceneNumber::next(), slots: Vec::new() }
    }
}

impl<T> Slots<T> {
    /// The scene whose values these are.
    pub fn scene(&self) -> SceneNumber {
        self.scene
    }

    /// Adds a value to the first free slot; returns the slot and its generation.
    pub fn insert(&mut self, value: T) -> [u32; 2] {
        let free = self.slots.iter().position(|(_, value)| value.is_none());
        let at = free.unwrap_or_else(|| {
            self.slots.push((0, None));
            self.slots.len() - 1
        });
        self.slots[at].1 = Some(value);
        [at as u32, self.slots[at].0]
    }

    /// The value in a slot, if it is of this generation.
    pub fn get(&self, [index, generation]: [u32; 2]) -> Option<&T> {
        let (now, value) = self.slots.get(index as usize)?;
        value.as_ref().filter(|_| *now == generation)
    }

    /// As [`Slots::get`], to be changed.
    pub fn get_mut(&mut self, [index, generation]: [u32; 2]) -> Option<&mut T> {
        let (now, value) = self.slots.get_mut(index as usize)?;
        value.as_mut().filter(|_| *now == generation)
    }

    /// Removes a value; its handles are stale from then on.
    pub fn remove(&mut self, [index, generation]: [u32; 2]) -> Option<T> {
        let (now, value) = self.slots.get_mut(index as usize)?;
        if *now != generation {
            return None;
        }
        let removed = value.take();
        *now = now.wrapping_add(u32::from(removed.is_some()));
        removed
    }

    /// All values with their slots and generations, slot by slot.
    pub fn numbered(&self) -> impl Iterator<Item = ([u32; 2], &T)> {
        let slots = (0..).zip(&self.slots);
        slots.filter_map(|(index, (generation, value))| Some(([index, *generation], value.as_ref()?)))
    }

    /// All values, slot by slot.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.slots.iter().filter_map(|(_, value)| value.as_ref())
    }

    /// All values, slot by slot, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.slots.iter_mut().filter_map(|(_, value)| value.as_mut())
    }
}

/// The error of a handle whose object or instance was removed.
pub(super) fn stale(path: &str, index: u32, generation: u32) -> InputError {
    let value = format!("{index} (generation {generation}), which was removed");
    InputError::new(path, value, "must still exist")
}

/// The error of an instance's handle in a scene that does not have the instance.
pub(super) fn missing(scene: SceneNumber, instance: InstanceId) -> InputError {
    match instance.object.scene == scene {
        true => stale("instance", instance.index, instance.generation),
        false => foreign("instance"),
    }
}

/// The error of an instance that is no character.
pub(super) fn no_character() -> InputError {
    InputError::new("instance", "no character", "must be an instance of a character")
}

/// The error of a handle that another scene gave.
pub(super) fn foreign(path: &str) -> InputError {
    InputError::new(path, "of another scene", "must be of this scene")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_are_used_again_under_another_generation() {
        let mut slots = Slots::default();
        let [a, b] = ["a", "b"].map(|value| slots.insert(value));
        assert_eq!((slots.get(a), slots.get(b)), (Some(&"a"), Some(&"b")));
        assert_eq!((slots.remove(a), slots.remove(a), slots.get(a)), (Some("a"), None, None));
        let c = slots.insert("c");
        assert_eq!((c[0], c == a, slots.get(a), slots.get(c)), (a[0], false, None, Some(&"c")));
        assert_eq!(slots.iter().copied().collect::<Vec<_>>(), ["c", "b"]);
        assert_eq!(slots.get([7, 0]), None);
    }
}
