//! Accounting of the bytes that a device's storage buffers hold.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::GpuError;

/// The bytes of every [`super::Buffer`] of a device and its clones: the current number, and the peak.
#[derive(Debug)]
pub struct Memory {
    now: AtomicU64,
    most: AtomicU64,
    limit: AtomicU64,
}

impl Default for Memory {
    fn default() -> Self {
        Self { now: AtomicU64::new(0), most: AtomicU64::new(0), limit: AtomicU64::new(u64::MAX) }
    }
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

    /// Sets the largest number of bytes; `None` is no limit, as at first. What is held already stays. A buffer that would
    /// exceed it is refused with [`GpuError::OutOfMemory`], as if the device had no more memory.
    pub fn set_limit(&self, bytes: Option<u64>) {
        self.limit.store(bytes.unwrap_or(u64::MAX), Ordering::SeqCst);
    }

    pub(super) fn hold(self: &Arc<Self>, label: &str, bytes: u64) -> Result<Held, GpuError> {
        let before = self.now.fetch_add(bytes, Ordering::SeqCst);
        let held = Held { memory: self.clone(), bytes };
        let limit = self.limit.load(Ordering::SeqCst);
        if before.saturating_add(bytes) > limit {
            let reason = format!("{label}: {bytes} bytes beside {before} exceed the limit of {limit}");
            return Err(GpuError::OutOfMemory { reason });
        }
        self.most.fetch_max(before + bytes, Ordering::SeqCst);
        Ok(held)
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
