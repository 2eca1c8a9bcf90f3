//! Handles of objects and instances. A handle becomes stale when its object or instance is removed. A stale
//! handle never refers to a later object or instance.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::InputError;

/// Unique number of a scene within the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct SceneNumber(u64);

impl SceneNumber {
    /// The next unused number.
    fn next() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// Handle of an object in a scene: terrain, a mesh, a relief, a character, or an object of a caller-defined kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ObjectId {
    pub(super) scene: SceneNumber,
    pub(super) index: u32,
    pub(super) generation: u32,
}

impl ObjectId {
    /// The object's number in pictures and shaders, counted from 1. After the object is removed, a later object may get this
    /// number.
    pub fn number(&self) -> u32 {
        self.index + 1
    }
}

/// Handle of an instance in a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct InstanceId {
    pub(super) object: ObjectId,
    pub(super) index: u32,
    pub(super) generation: u32,
}

impl InstanceId {
    /// The handle of the instance's object.
    pub fn object(&self) -> ObjectId {
        self.object
    }

    /// The instance's number within its object in pictures and shaders, counted from 0. After the instance is removed, a
    /// later instance may get this number.
    pub fn number(&self) -> u32 {
        self.index
    }
}

/// Values of one scene in reusable slots. Each reuse of a slot increments its generation, which makes old handles stale.
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
    /// The scene that the values belong to.
    pub fn scene(&self) -> SceneNumber {
        self.scene
    }

    /// Stores a value in the first free slot. Returns the index of the slot and its generation.
    pub fn insert(&mut self, value: T) -> [u32; 2] {
        let free = self.slots.iter().position(|(_, value)| value.is_none());
        let at = free.unwrap_or_else(|| {
            self.slots.push((0, None));
            self.slots.len() - 1
        });
        self.slots[at].1 = Some(value);
        [at as u32, self.slots[at].0]
    }

    /// The value in a slot; `None` if the slot is free or has another generation.
    pub fn get(&self, [index, generation]: [u32; 2]) -> Option<&T> {
        let (now, value) = self.slots.get(index as usize)?;
        value.as_ref().filter(|_| *now == generation)
    }

    /// Mutable form of [`Slots::get`].
    pub fn get_mut(&mut self, [index, generation]: [u32; 2]) -> Option<&mut T> {
        let (now, value) = self.slots.get_mut(index as usize)?;
        value.as_mut().filter(|_| *now == generation)
    }

    /// Removes a value and returns it; `None` if it does not exist any more. Handles of the value become stale.
    pub fn remove(&mut self, [index, generation]: [u32; 2]) -> Option<T> {
        let (now, value) = self.slots.get_mut(index as usize)?;
        if *now != generation {
            return None;
        }
        let removed = value.take();
        *now = now.wrapping_add(u32::from(removed.is_some()));
        removed
    }

    /// All values with slot index and generation, in ascending order of slots.
    pub fn numbered(&self) -> impl Iterator<Item = ([u32; 2], &T)> {
        let slots = (0..).zip(&self.slots);
        slots.filter_map(|(index, (generation, value))| Some(([index, *generation], value.as_ref()?)))
    }

    /// All values, in ascending order of slots.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.slots.iter().filter_map(|(_, value)| value.as_ref())
    }

    /// All values for modification, in ascending order of slots.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.slots.iter_mut().filter_map(|(_, value)| value.as_mut())
    }
}

/// The error for a stale handle: its object or instance was removed.
pub(super) fn stale(path: &str, index: u32, generation: u32) -> InputError {
    let value = format!("{index} (generation {generation}), which was removed");
    InputError::new(path, value, "must still exist")
}

/// The error for an instance's handle that is stale or belongs to another scene.
pub(super) fn missing(scene: SceneNumber, instance: InstanceId) -> InputError {
    match instance.object.scene == scene {
        true => stale("instance", instance.index, instance.generation),
        false => foreign("instance"),
    }
}

/// The error for an instance that is not a character.
pub(super) fn no_character() -> InputError {
    InputError::new("instance", "no character", "must be an instance of a character")
}

/// The error for a handle of another scene.
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
