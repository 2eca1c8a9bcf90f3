//! Accounting of the bytes that a device's storage buffers hold.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// The bytes of every [`super::Buffer`] of a device and its clones: the current number, and the peak.
#[derive(Debug, Default)]
pub struct Memory {
    now: AtomicU64,
    most: AtomicU64,
}

impl Memory {
    /// Bytes held at present.
    pub fn now(&self) -> u64 {
        self.now.load(Ordering::SeqCst)
    }

    /// The peak since the last call.
    pub fn take_most(&self) -> u64 {
        self.most.swap(self.now(), Ordering::SeqCst)
    }

    pub(super) fn hold(self: &Arc<Self>, bytes: u64) -> Held {
        let now = self.now.fetch_add(bytes, Ordering::SeqCst) + bytes;
        self.most.fetch_max(now, Ordering::SeqCst);
        Held { memory: self.clone(), bytes }
    }
}

/// Bytes that are counted until this value is dropped.
#[derive(Debug)]
pub(super) struct Held {
    memory: Arc<Memory>,
    bytes: u64,
}

impl Drop for Held {
    fn drop(&mut self) {
        self.memory.now.fetch_sub(self.bytes, Ordering::SeqCst);
    }
}
