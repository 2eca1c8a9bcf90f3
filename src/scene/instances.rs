//! The instances of one object on the host, and the changes to them that are not uploaded yet.

use crate::asset::transform::Transform;
use crate::scene::placement::Placement;
use crate::shared::lod::instance::{
    INSTANCE_ALIVE, INSTANCE_CARRIES, INSTANCE_CASTS, INSTANCE_FOLLOWS, SceneInstance, instance_flags_word,
};
use crate::shared::lod::object::BLOCK;
use crate::skinning::bounding_sphere::BoundingSphere;

/// The content of an array element that no instance uses.
pub(super) const NOBODY: SceneInstance = SceneInstance {
    cell: [0; 3],
    flags: 0,
    offset: [0.0; 3],
    user_data: 0,
    rotation: Transform::IDENTITY.rotation,
    scale: [1.0; 3],
    tint: u32::MAX,
    bounding_sphere: [0.0; 4],
};

/// Largest gap, in unchanged elements, between two changed elements that are still uploaded in one range.
const GAP: usize = 4;

/// The instances of an object.
#[derive(Debug)]
pub(super) struct Instances {
    all: Vec<SceneInstance>,
    generations: Vec<u32>,
    /// Unused indices; the last one is used first.
    free: Vec<u32>,
    /// Number of existing instances that are mirrored.
    mirrored: usize,
    changed: Changed,
    last: Option<Last>,
}

/// The state of the instances in the last frame, for motion history.
#[derive(Debug)]
struct Last {
    all: Vec<SceneInstance>,
    /// Elements of `all` that must be uploaded.
    changed: Changed,
}

impl Instances {
    /// An array without instances, with a capacity of at least `capacity`.
    pub fn new(capacity: usize) -> Self {
        let changed = Changed::default();
        let mut instances =
            Self { all: vec![], generations: vec![], free: vec![], mirrored: 0, changed, last: None };
        instances.grow(capacity);
        instances
    }

    /// Number of instances that the array can hold without growing, a multiple of [`BLOCK`].
    pub fn capacity(&self) -> usize {
        self.all.len()
    }

    /// Number of existing instances.
    pub fn alive(&self) -> usize {
        self.all.len() - self.free.len()
    }

    /// Two flags: whether there are instances that are not mirrored, and whether there are mirrored ones. Without any
    /// instance: `[true, false]`.
    pub fn sides(&self) -> [bool; 2] {
        let plain = self.alive() - self.mirrored;
        [plain > 0 || self.mirrored == 0, self.mirrored > 0]
    }

    /// Raises the capacity to at least `capacity` instances. Marks all instances as changed.
    pub fn grow(&mut self, capacity: usize) {
        let before = self.all.len();
        let after = capacity.max(1).next_multiple_of(BLOCK as usize).max(before);
        self.all.resize(after, NOBODY);
        self.generations.resize(after, 0);
        self.free.splice(0..0, (before as u32..after as u32).rev());
        if let Some(last) = &mut self.last {
            last.all.resize(after, NOBODY);
        }
        self.change_all();
    }

    /// Marks all instances as changed.
    pub fn change_all(&mut self) {
        self.changed.all(self.all.len());
        if let Some(last) = &mut self.last {
            last.changed.all(self.all.len());
        }
    }

    /// Sets whether the instances of the last frame are kept from now on.
    pub fn keep_last(&mut self, keeps: bool) {
        self.last = keeps.then(|| Last { all: self.all.clone(), changed: Changed::default() });
        self.change_all();
    }

    /// Adds an instance. Returns its index and generation; `None` if the capacity is used up.
    pub fn spawn(&mut self, placement: &Placement, sphere: &BoundingSphere) -> Option<[u32; 2]> {
        let index = self.free.pop()?;
        let flags = instance_flags_word(INSTANCE_ALIVE | INSTANCE_CASTS, u16::MAX.into());
        self.all[index as usize] = SceneInstance { flags, ..NOBODY };
        self.change(index, |instance| {
            place(instance, placement);
            bound(instance, sphere);
        });
        if let Some(last) = &mut self.last {
            // A new instance has not moved. Its index may have belonged to a removed instance at another position.
            last.all[index as usize] = self.all[index as usize];
            last.changed.add(index, self.all.len());
        }
        Some([index, self.generations[index as usize]])
    }

    /// Removes an instance, which must exist.
    pub fn despawn(&mut self, index: u32) {
        self.change(index, |instance| instance.flags = 0);
        let generation = &mut self.generations[index as usize];
        *generation = generation.wrapping_add(1);
        self.free.push(index);
    }

    /// Whether an instance with this generation exists.
    pub fn contains(&self, [index, generation]: [u32; 2]) -> bool {
        let index = index as usize;
        self.generations.get(index) == Some(&generation) && self.all[index].flags & INSTANCE_ALIVE != 0
    }

    /// Index and generation of every existing instance, in ascending order.
    pub fn each(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let all = self.all.iter().zip(&self.generations).zip(0_u32..);
        let alive = all.filter(|((instance, _), _)| instance.flags & INSTANCE_ALIVE != 0);
        alive.map(|((_, generation), index)| [index, *generation])
    }

    /// The whole array, including elements that no instance uses.
    pub fn all(&self) -> &[SceneInstance] {
        &self.all
    }

    /// Applies `change` to an instance, and marks the instance as changed.
    pub fn change(&mut self, index: u32, change: impl FnOnce(&mut SceneInstance)) {
        let is_counted =
            |instance: &SceneInstance| instance.flags & INSTANCE_ALIVE != 0 && instance.is_mirrored();
        let instance = &mut self.all[index as usize];
        let before = usize::from(is_counted(instance));
        change(instance);
        self.mirrored = self.mirrored + usize::from(is_counted(instance)) - before;
        self.changed.add(index, self.all.len());
    }

    /// Takes the last frame's states that must be uploaded, as ranges of consecutive instances, each with its first index.
    /// Call this function once per frame, before [`Instances::take_changed`]. An instance that changes in this frame is
    /// taken twice: now with its old state, and in the next frame with its new state.
    pub fn take_last(&mut self) -> Vec<(usize, Vec<SceneInstance>)> {
        let (Some(last), count) = (&mut self.last, self.all.len()) else { return Vec::new() };
        self.changed.indices.iter().for_each(|index| last.changed.add(*index, count));
        let runs = last.changed.take(count).into_iter();
        let runs = runs.map(|[from, to]| (from, last.all[from..to].to_vec())).collect();
        for index in &self.changed.indices {
            last.all[*index as usize] = self.all[*index as usize];
            last.changed.add(*index, count);
        }
        runs
    }

    /// Takes the changed instances, as ranges of consecutive instances, each with its first index.
    pub fn take_changed(&mut self) -> Vec<(usize, &[SceneInstance])> {
        let all = &self.all;
        self.changed.take(all.len()).into_iter().map(|[from, to]| (from, &all[from..to])).collect()
    }
}

/// Sets the visibility mask of an instance.
pub(super) fn set_mask(instance: &mut SceneInstance, mask: u16) {
    let all = INSTANCE_ALIVE | INSTANCE_CASTS | INSTANCE_CARRIES | INSTANCE_FOLLOWS;
    instance.flags = instance_flags_word(instance.flags & all, mask.into());
}

/// Sets whether an instance casts shadows.
pub(super) fn set_casts(instance: &mut SceneInstance, casts: bool) {
    instance.flags = instance.flags & !INSTANCE_CASTS | if casts { INSTANCE_CASTS } else { 0 };
}

/// Sets position, rotation and scale of an instance. The placement must have been checked.
pub(super) fn place(instance: &mut SceneInstance, placement: &Placement) {
    instance.cell = placement.cell;
    instance.offset = placement.offset.into();
    instance.rotation = placement.turn.into();
    instance.scale = placement.scale.into();
}

/// Sets the bounding sphere of an instance.
pub(super) fn bound(instance: &mut SceneInstance, sphere: &BoundingSphere) {
    instance.bounding_sphere = sphere.center.extend(sphere.radius).into();
}

/// Set of array elements that changed and must be uploaded.
#[derive(Debug, Default)]
pub(super) struct Changed {
    is_changed: Vec<bool>,
    indices: Vec<u32>,
}

impl Changed {
    /// Marks the element `index` of `count` elements as changed.
    pub fn add(&mut self, index: u32, count: usize) {
        self.is_changed.resize(count, false);
        if !std::mem::replace(&mut self.is_changed[index as usize], true) {
            self.indices.push(index);
        }
    }

    /// Marks all of `count` elements as changed.
    pub fn all(&mut self, count: usize) {
        (0..count as u32).for_each(|index| self.add(index, count));
    }

    /// Takes the changed elements as half-open ranges of indices, and empties the set. Ranges with at most [`GAP`] elements
    /// between them are joined.
    pub fn take(&mut self, count: usize) -> Vec<[usize; 2]> {
        self.indices.sort_unstable();
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for index in self.indices.drain(..).map(|index| index as usize).filter(|index| *index < count) {
            self.is_changed[index] = false;
            match runs.last_mut() {
                Some([_, end]) if index <= *end + GAP => *end = index + 1,
                _ => runs.push([index, index + 1]),
            }
        }
        runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const SPHERE: BoundingSphere = BoundingSphere { center: Vec3::Y, radius: 2.0 };

    #[test]
    fn instances_come_and_go() {
        let mut instances = Instances::new(65);
        assert_eq!((instances.capacity(), instances.alive()), (128, 0));
        let spawn = |instances: &mut Instances| instances.spawn(&Placement::default(), &SPHERE);
        let all: Vec<_> = (0..128).map(|_| spawn(&mut instances).expect("room")).collect();
        assert!(all.iter().zip(0..).all(|(id, at)| *id == [at, 0]) && spawn(&mut instances).is_none());
        instances.despawn(7);
        assert!(!instances.contains([7, 0]) && instances.contains([8, 0]) && !instances.contains([8, 1]));
        assert_eq!(spawn(&mut instances), Some([7, 1]));
        instances.grow(129);
        assert_eq!((instances.capacity(), instances.alive()), (192, 128));
        assert_eq!(spawn(&mut instances), Some([128, 0]));
        assert!(!instances.contains([500, 0]));
    }

    #[test]
    fn mirrored_instances_are_counted() {
        let mut instances = Instances::new(64);
        assert_eq!(instances.sides(), [true, false], "an empty object");
        let mirrored = Placement { scale: Vec3::new(1.0, -2.0, 1.0), ..Placement::default() };
        let [plain, _] = instances.spawn(&Placement::default(), &SPHERE).expect("room");
        let [other, _] = instances.spawn(&mirrored, &SPHERE).expect("room");
        assert_eq!(instances.sides(), [true, true]);
        instances.change(plain, |instance| place(instance, &mirrored));
        assert_eq!(instances.sides(), [false, true]);
        let twice = Placement { scale: Vec3::new(-1.0, -2.0, 1.0), ..Placement::default() };
        instances.change(other, |instance| place(instance, &twice));
        assert_eq!(instances.sides(), [true, true]);
        instances.despawn(plain);
        assert_eq!(instances.sides(), [true, false]);
        // The index is used again, now for an instance that is not mirrored.
        assert_eq!(instances.spawn(&Placement::default(), &SPHERE), Some([plain, 1]));
        assert_eq!(instances.sides(), [true, false]);
    }

    #[test]
    fn the_last_frame_follows_by_a_frame() {
        let mut instances = Instances::new(64);
        assert!(instances.take_last().is_empty(), "nothing is kept");
        instances.keep_last(true);
        let mut known = [7; 64];
        let mut frame = |instances: &mut Instances| {
            let runs = instances.take_last();
            for (from, run) in &runs {
                run.iter().zip(*from..).for_each(|(instance, at)| known[at] = instance.user_data);
            }
            instances.take_changed();
            (known, runs.iter().map(|(_, run)| run.len()).sum::<usize>())
        };
        assert_eq!(frame(&mut instances), ([0; 64], 64));
        // All changed in the frame before, so all are taken again.
        assert_eq!(frame(&mut instances), ([0; 64], 64));
        let at_9 = |word| std::array::from_fn(|at| if at == 9 { word } else { 0 });
        instances.change(9, |instance| instance.user_data = 1);
        assert_eq!(frame(&mut instances), (at_9(0), 1));
        instances.change(9, |instance| instance.user_data = 2);
        assert_eq!(frame(&mut instances), (at_9(1), 1));
        assert_eq!(frame(&mut instances), (at_9(2), 1));
        assert_eq!(frame(&mut instances), (at_9(2), 0));
        // A new instance has not moved.
        let [index, _] = instances.spawn(&Placement::default(), &SPHERE).expect("room");
        let last = instances.take_last();
        assert!(last.iter().any(|(from, run)| {
            *from == index as usize && run[0].flags & INSTANCE_ALIVE != 0 && run[0].bounding_sphere[3] == 2.0
        }));
    }

    #[test]
    fn changes_are_taken_once_and_in_runs() {
        let mut instances = Instances::new(64);
        assert_eq!(instances.take_changed().len(), 1, "all of them at first");
        for index in [40, 3, 5, 3, 41] {
            instances.change(index, |instance| instance.user_data = index);
        }
        let runs: Vec<_> = instances.take_changed().iter().map(|(from, run)| (*from, run.len())).collect();
        assert_eq!(runs, [(3, 3), (40, 2)]);
        assert!(instances.take_changed().is_empty());
    }
}
