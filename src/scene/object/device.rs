//! Device resources of an object: growing them, resetting them, and moving them to another device.

use super::{MAX_CAPACITY, Object};
use crate::gpu::Gpu;
use crate::scene::instances;
use crate::scene::layouts::SceneLayouts;
use crate::scene::object_kind::{MakeOn, OnDevice};
use crate::shared::lod::instance::{INSTANCE_CARRIES, INSTANCE_WHOLE};
use crate::{Error, InputError};

impl Object {
    /// Doubles the capacity for instances. If this fails, nothing changes.
    pub(in crate::scene) fn grow(&mut self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<(), Error> {
        let capacity = self.instances.capacity();
        let bound = || format!("must be at most {MAX_CAPACITY}: add another object");
        InputError::check(capacity < MAX_CAPACITY, "object.capacity", 2 * capacity, bound)?;
        let capacity = (2 * capacity).min(MAX_CAPACITY);
        if let Some(next) = &mut self.successor {
            next.renew(gpu, layouts, capacity)?;
            next.instances.grow(capacity);
        }
        self.renew(gpu, layouts, capacity)?;
        self.instances.grow(capacity);
        Ok(())
    }

    /// Starts the object afresh: all instances are uploaded again, and the kind's state on the device is reset.
    pub(in crate::scene) fn refresh(&mut self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<(), Error> {
        self.renew(gpu, layouts, self.instances.capacity())?;
        self.instances.change_all();
        Ok(())
    }

    fn renew(&mut self, gpu: &Gpu, layouts: &SceneLayouts, capacity: usize) -> Result<(), Error> {
        let target = MakeOn { gpu, layouts, looks: self.looks.as_ref(), capacity };
        self.kind.renew(target, &mut self.chunks)
    }

    /// Creates the object's device resources on another device, without using them yet.
    pub(in crate::scene) async fn on(&self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<OnDevice, Error> {
        let (looks, capacity) = (self.looks.as_ref(), self.instances.capacity());
        self.kind.made_on(MakeOn { gpu, layouts, looks, capacity }).await
    }

    /// Replaces the object's device resources with `on_device`, which was made on another device. The state of all
    /// instances is reset.
    pub(in crate::scene) fn adopt(&mut self, on_device: OnDevice) {
        let OnDevice { chunks, other } = on_device;
        self.kind.adopt(other);
        self.chunks = chunks;
        self.pending = None;
        self.start_afresh();
    }

    /// Resets what depends on the kind and its chunks, after they were replaced.
    pub(in crate::scene) fn start_afresh(&mut self) {
        self.mark_transition();
        self.lod_bias = 1.0;
        (self.is_retuned, self.is_rebound, self.fitted) = (false, false, 0);
        self.instances.change_all();
    }

    /// Updates the bounding sphere of an instance after its clip or its layers changed, and whether it needs its whole skeleton.
    pub(in crate::scene) fn bound_again(&mut self, index: u32) {
        if let Some(sphere) = self.kind.sphere_of(index) {
            self.instances.change(index, |instance| instances::bound(instance, &sphere));
        }
        self.mark_whole(index);
    }

    /// Updates whether an instance needs its whole skeleton.
    pub(in crate::scene) fn mark_whole(&mut self, index: u32) {
        let whole = if self.kind.needs_skeleton(index) { INSTANCE_WHOLE } else { 0 };
        if self.instances.all()[index as usize].flags & INSTANCE_WHOLE != whole {
            self.instances
                .change(index, |instance| instance.flags = instance.flags & !INSTANCE_WHOLE | whole);
        }
    }

    /// Ends all cross-fades between clips that are complete at scene time `now`, in seconds.
    pub(in crate::scene) fn settle(&mut self, now: f64) {
        for index in self.kind.settle(now) {
            // A character that carries an attached mesh keeps its larger sphere until it plays another clip.
            match self.instances.all()[index as usize].flags & INSTANCE_CARRIES {
                0 => self.bound_again(index),
                _ => self.mark_whole(index),
            }
        }
    }
}
