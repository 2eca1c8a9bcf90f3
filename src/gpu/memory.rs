//! Accounting of the bytes that a device's storage buffers hold.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

use super::GpuError;

/// Number of bytes in all [`super::Buffer`]s of a device: current, peak and limit. Clones of a buffer count once.
#[derive(Debug)]
pub struct Memory {
    now: AtomicU64,
    most: AtomicU64,
    limit: AtomicU64,
    labels: Mutex<BTreeMap<&'static str, u64>>,
}

impl Default for Memory {
    fn default() -> Self {
        let (now, most, labels) = Default::default();
        Self { now, most, limit: AtomicU64::new(u64::MAX), labels }
    }
}

impl Memory {
    /// Number of bytes currently allocated.
    pub fn now(&self) -> u64 {
        self.now.load(Ordering::SeqCst)
    }

    /// Returns the peak number of allocated bytes since the last call of this function.
    pub fn take_most(&self) -> u64 {
        self.most.swap(self.now(), Ordering::SeqCst)
    }

    /// Number of bytes currently allocated for each buffer label, in alphabetical order of the labels.
    pub fn by_label(&self) -> Vec<(&'static str, u64)> {
        self.labels().iter().map(|(label, bytes)| (*label, *bytes)).collect()
    }

    /// Largest number of bytes that may be allocated in total.
    pub fn limit(&self) -> u64 {
        self.limit.load(Ordering::SeqCst)
    }

    /// Sets the largest number of bytes that may be allocated in total; initially there is no limit. A buffer that would exceed
    /// the limit is refused with [`GpuError::OutOfMemory`], as if the device had no memory left. Existing buffers stay.
    pub fn set_limit(&self, bytes: u64) {
        self.limit.store(bytes, Ordering::SeqCst);
    }

    /// Checks that `bytes` more bytes stay within the limit. `label` names the buffer in the error.
    pub(super) fn check(&self, label: &str, bytes: u64) -> Result<(), GpuError> {
        let (now, limit) = (self.now(), self.limit());
        if now.saturating_add(bytes) <= limit {
            return Ok(());
        }
        let reason = format!("{label} needs {bytes} bytes, {now} are held, and the limit is {limit}");
        Err(GpuError::OutOfMemory { reason })
    }

    pub(super) fn hold(self: &Arc<Self>, label: &'static str, bytes: u64) -> Held {
        let now = self.now.fetch_add(bytes, Ordering::SeqCst) + bytes;
        self.most.fetch_max(now, Ordering::SeqCst);
        *self.labels().entry(label).or_default() += bytes;
        Held { memory: self.clone(), label, bytes }
    }

    fn labels(&self) -> MutexGuard<'_, BTreeMap<&'static str, u64>> {
        self.labels.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }
}

/// An allocation. Its bytes are counted until this value is dropped.
#[derive(Debug)]
pub(super) struct Held {
    memory: Arc<Memory>,
    label: &'static str,
    bytes: u64,
}

impl Drop for Held {
    fn drop(&mut self) {
        self.memory.now.fetch_sub(self.bytes, Ordering::SeqCst);
        let mut labels = self.memory.labels();
        if let Some(bytes) = labels.get_mut(self.label) {
            *bytes -= self.bytes;
            if *bytes == 0 {
                labels.remove(self.label);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_counted_by_label_up_to_the_limit() {
        let memory = Arc::new(Memory::default());
        let (a, b) = (memory.hold("pages", 100), memory.hold("lists", 20));
        let c = memory.hold("pages", 4);
        assert_eq!(memory.by_label(), [("lists", 20), ("pages", 104)]);
        memory.set_limit(130);
        assert!(memory.check("more", 6).is_ok());
        let refused = memory.check("more", 7).expect_err("refused").to_string();
        assert!(refused.contains("more needs 7 bytes, 124 are held, and the limit is 130"), "{refused}");
        drop((a, b));
        assert_eq!((memory.by_label(), memory.now(), memory.take_most()), (vec![("pages", 4)], 4, 124));
        drop(c);
        assert!(memory.by_label().is_empty());
    }
}
