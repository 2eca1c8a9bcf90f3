//! How many bytes the storage buffers of a device hold.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Bytes in every [`super::Buffer`] of a device and its clones: now, and the most at once.
#[derive(Debug, Default)]
pub struct Memory {
    now: AtomicU64,
    most: AtomicU64,
}

impl Memory {
    /// Bytes held now.
    pub fn now(&self) -> u64 {
        self.now.load(Ordering::SeqCst)
    }

    /// The most bytes held at once since the last call.
    pub fn take_most(&self) -> u64 {
        self.most.swap(self.now(), Ordering::SeqCst)
    }

    pub(super) fn hold(self: &Arc<Self>, bytes: u64) -> Held {
        let now = self.now.fetch_add(bytes, Ordering::SeqCst) + bytes;
        self.most.fetch_max(now, Ordering::SeqCst);
        Held { memory: self.clone(), bytes }
    }
}

/// Bytes that count until this is dropped.
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
