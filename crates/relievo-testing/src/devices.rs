//! Devices that the tests of a program use one after the other.

use std::cell::RefCell;
use std::sync::Mutex;

use relievo::gpu::Gpu;

/// Devices of one kind. A thread, so a test, has one of them to itself until it ends; then the next test takes it over, with the
/// kernels that it has compiled.
///
/// Tests that run at the same time do not share a device, because the thread that polls runs the callbacks of all: data that one
/// waits for may still be with another.
pub struct Devices {
    open: fn() -> Gpu,
    free: Mutex<Vec<Gpu>>,
}

/// The devices of a thread, with where they belong.
#[derive(Default)]
struct Lent(Vec<(&'static Devices, Gpu)>);

thread_local! {
    static LENT: RefCell<Lent> = RefCell::default();
}

impl Devices {
    /// Devices that `open` opens, as many as there are tests at the same time.
    pub const fn new(open: fn() -> Gpu) -> Self {
        Self { open, free: Mutex::new(Vec::new()) }
    }

    /// The thread's device.
    ///
    /// # Panics
    /// If `open` panics.
    pub fn of_thread(&'static self) -> Gpu {
        let known = LENT.with_borrow(|lent| {
            let own = lent.0.iter().find(|(devices, _)| std::ptr::eq(*devices, self));
            own.map(|(_, gpu)| gpu.clone())
        });
        known.unwrap_or_else(|| {
            let free = self.free.lock().expect("nothing panics while it is locked").pop();
            let gpu = free.unwrap_or_else(self.open);
            LENT.with_borrow_mut(|lent| lent.0.push((self, gpu.clone())));
            gpu
        })
    }
}

impl Drop for Lent {
    fn drop(&mut self) {
        for (devices, gpu) in self.0.drain(..) {
            if let Ok(mut free) = devices.free.lock() {
                free.push(gpu);
            }
        }
    }
}
