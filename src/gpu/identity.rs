//! Tells whether two handles belong to the same device, and whether a device is lost.
//!
//! wgpu compares handles by identifiers that each [`wgpu::Instance`] counts separately, so devices of two instances may compare
//! equal. wgpu panics if a resource of one instance is used in another. wgpu has no query for a device's instance, and none for
//! a device's loss.
//!
//! Natively, a call that a working device refuses answers both questions. The error scope that catches the error belongs to the
//! called device. If no scope catches an error, the device is lost.

#[cfg(target_arch = "wasm32")]
pub(super) use browser::{Identity, caught};
#[cfg(not(target_arch = "wasm32"))]
pub(super) use native::{Identity, caught, is_lost};

/// Browser version. In a browser, identifiers are unique, and misuse gives errors instead of panics.
#[cfg(target_arch = "wasm32")]
mod browser {
    #[derive(Debug, Clone, PartialEq)]
    pub struct Identity(wgpu::Device);

    impl Identity {
        pub fn of(device: &wgpu::Device) -> Self {
            Self(device.clone())
        }

        pub fn is_taken<'a>(&'a self, _: impl FnOnce(&'a wgpu::Buffer)) -> bool {
            true
        }
    }

    pub fn caught<T>(work: impl FnOnce() -> T) -> Option<T> {
        Some(work())
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod native {
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::atomic::{AtomicU32, Ordering};
    use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};

    /// The device of every living [`Gpu`](crate::gpu::Gpu).
    static KNOWN: Mutex<Vec<Weak<Device>>> = Mutex::new(Vec::new());

    /// Identity of a device; equal for all handles to the same device.
    #[derive(Debug, Clone)]
    pub struct Identity(Arc<Device>);

    #[derive(Debug)]
    struct Device {
        device: wgpu::Device,
        probe: OnceLock<wgpu::Buffer>,
    }

    impl PartialEq for Identity {
        fn eq(&self, other: &Self) -> bool {
            Arc::ptr_eq(&self.0, &other.0)
        }
    }

    impl Identity {
        pub fn of(device: &wgpu::Device) -> Self {
            let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
            known.retain(|one| one.strong_count() > 0);
            let same = known.iter().filter_map(Weak::upgrade).find(|one| is_same(&one.device, device));
            Self(same.unwrap_or_else(|| {
                let fresh = Arc::new(Device { device: device.clone(), probe: OnceLock::new() });
                known.push(Arc::downgrade(&fresh));
                fresh
            }))
        }

        /// Whether an encoder or a pass can record resources of this device. The closure `record` records a use of the given
        /// buffer.
        ///
        /// wgpu panics for an identifier that is unknown to the encoder's instance. The panic is caught here, before anything
        /// else is recorded. The program's panic hook still runs.
        pub fn is_taken<'a>(&'a self, record: impl FnOnce(&'a wgpu::Buffer)) -> bool {
            let probe = self.0.probe.get_or_init(|| probe(&self.0.device));
            caught(|| record(probe)).is_some()
        }
    }

    /// Returns the result of `work`; `None` if wgpu panics because `work` used a resource of another instance.
    pub fn caught<T>(work: impl FnOnce() -> T) -> Option<T> {
        catch_unwind(AssertUnwindSafe(work)).ok()
    }

    /// Number of probe buffers that the process has created.
    static PROBES: AtomicU32 = AtomicU32::new(0);

    /// Distance between the identifiers of successive probe buffers.
    const STEP: u32 = 16;

    /// Number of probe buffers after which identifiers repeat.
    const PROBES_APART: u32 = 64;

    /// Creates a buffer whose identifier exists in no other instance. An identifier contains the number of times that its slot
    /// in wgpu was used. This function uses the slot of the probe more often than other slots are used, and a different number
    /// of times for each probe.
    fn probe(device: &wgpu::Device) -> wgpu::Buffer {
        let number = 1 + PROBES.fetch_add(1, Ordering::Relaxed) % PROBES_APART;
        let descriptor = wgpu::BufferDescriptor {
            label: Some("probe: what is recorded into is of another device than the scene"),
            size: 4,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::INDEX,
            mapped_at_creation: false,
        };
        (0..STEP * number).for_each(|_| drop(device.create_buffer(&descriptor)));
        device.create_buffer(&descriptor)
    }

    /// Makes a call that a working device refuses and a lost device ignores.
    fn refused(device: &wgpu::Device) {
        let _ = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("no usage: refused on purpose"),
            size: 4,
            usage: wgpu::BufferUsages::empty(),
            mapped_at_creation: false,
        });
    }

    /// Whether a device is lost.
    pub fn is_lost(device: &wgpu::Device) -> bool {
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        refused(device);
        pollster::block_on(scope.pop()).is_none()
    }

    /// Whether two handles belong to the same device, and the device works.
    fn is_same(one: &wgpu::Device, other: &wgpu::Device) -> bool {
        if one != other {
            return false;
        }
        // This scope hides the error from the handlers of `other`, if `other` is a different device.
        let outer = other.push_error_scope(wgpu::ErrorFilter::Validation);
        let inner = one.push_error_scope(wgpu::ErrorFilter::Validation);
        refused(other);
        let is_caught = pollster::block_on(inner.pop()).is_some();
        pollster::block_on(outer.pop());
        is_caught
    }

    #[cfg(test)]
    mod tests {
        use crate::gpu::{Gpu, Options};

        fn gpu() -> Gpu {
            Gpu::headless(&Options::default()).expect("the suite needs an adapter")
        }

        /// Handles to devices of two instances, opened in the same way, compare equal in wgpu.
        #[test]
        fn devices_of_two_instances_differ() {
            let [one, two] = [gpu(), gpu()];
            assert!(one.device() == two.device(), "wgpu tells them apart: is this module still needed?");
            assert!(!one.is_same_device(&two));
            let again = Gpu::from_wgpu(one.device().clone(), one.queue().clone());
            assert!(one.is_same_device(&again) && again.is_same_device(&one));
            assert!(one.check().is_ok() && two.check().is_ok(), "the calls that tell leave no error");
        }

        #[test]
        fn encoders_of_another_instance_are_told() {
            let [one, two] = [gpu(), gpu()];
            for (taker, maker) in [(&one, &one), (&one, &two), (&two, &one), (&two, &two)] {
                let mut encoder = maker.encoder("probed");
                assert_eq!(taker.check_encoder(&mut encoder).is_ok(), taker.is_same_device(maker));
                // The encoder is still usable after the caught panic.
                maker.scoped(|| maker.queue().submit([encoder.finish()])).expect("a valid encoder");
            }
        }

        #[test]
        fn a_loss_is_told_by_the_first_call() {
            for own in [true, false] {
                let opened = gpu();
                let embedded = Gpu::from_wgpu(opened.device().clone(), opened.queue().clone());
                let gpu = if own { &opened } else { &embedded };
                assert!(gpu.check().is_ok());
                gpu.device().destroy();
                let told = gpu.check().expect_err("lost");
                assert!(matches!(told, crate::gpu::GpuError::DeviceLost { .. }), "{told}");
                assert!(gpu.check().is_err(), "told by every call");
                let told = crate::gpu::Buffer::<u32>::new(gpu, "more", 1).expect_err("lost");
                assert!(matches!(told, crate::gpu::GpuError::DeviceLost { .. }), "{told}");
            }
        }
    }
}
