//! Access to a scene's objects by handle.

use crate::scene::handles::{InstanceId, ObjectId, Slots};
use crate::scene::object::Object;

impl Slots<Object> {
    /// The object of an instance; `None` if the instance does not exist.
    pub fn existing(&self, instance: InstanceId) -> Option<&Object> {
        let InstanceId { object: ObjectId { scene, index, generation }, .. } = instance;
        let object = self.get([index, generation]).filter(|_| scene == self.scene())?;
        object.instances.contains([instance.index, instance.generation]).then_some(object)
    }

    /// Mutable form of [`Slots::existing`].
    pub fn existing_mut(&mut self, instance: InstanceId) -> Option<&mut Object> {
        let InstanceId { object: ObjectId { scene, index, generation }, .. } = instance;
        let is_of = scene == self.scene();
        let object = self.get_mut([index, generation]).filter(|_| is_of)?;
        object.instances.contains([instance.index, instance.generation]).then_some(object)
    }

    /// All objects with their handles, in the order of their slots.
    pub fn each(&self) -> impl Iterator<Item = (ObjectId, &Object)> {
        let scene = self.scene();
        self.numbered()
            .map(move |([index, generation], object)| (ObjectId { scene, index, generation }, object))
    }
}
