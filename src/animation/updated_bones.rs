//! Record of the bones that were updated since they were last skinned, for any number of readers.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::gpu::{Buffer, Gpu, GpuError};

/// Bit mask of the bones whose model matrices were updated. It has one bit per slot of each instance, in
/// [`Order::words`](super::order::Order::words) words per instance. If a bone's bit is set, the bits of all its descendants are
/// also set.
///
/// Kernels set bits. The bits accumulate until all readers have processed them, so a frame may skip skinning.
///
/// Each consumer of the matrices is a reader ([`UpdatedBones::reader`]). Every [`SkinFrame`](crate::skinning::frame::SkinFrame)
/// and [`PagedSkin`](crate::skinning::paged::PagedSkin) registers a reader of its own. After an update, the last reader to be
/// recorded clears the bits. Until then, a reader that is recorded again sees all bits again. It may repeat work but never misses
/// any. If readers take turns, so that each frame is read by only one of them, the bits are never cleared. A reader that is never
/// recorded also blocks clearing, so drop it.
///
/// The order of recording matters: submit encoders in the order in which they were recorded. If an encoder is not submitted and
/// other readers clear the bits, the readers recorded in that encoder have missed updates. Prepare their skinning again. Clones
/// share bits and readers.
#[derive(Debug, Clone)]
pub struct UpdatedBones {
    bits: Buffer<u32>,
    readers: Arc<Mutex<Readers>>,
}

/// A registered reader of updated bones. Dropping it unregisters it.
#[derive(Debug)]
pub struct UpdatedBonesReader {
    number: u64,
    updated: UpdatedBones,
}

/// The registered readers of a bit mask, by number.
#[derive(Debug, Default)]
struct Readers {
    next: u64,
    all: BTreeSet<u64>,
    /// Numbers of the readers that were not recorded since the last update.
    behind: BTreeSet<u64>,
}

impl Readers {
    fn add(&mut self) -> u64 {
        self.next += 1;
        self.all.insert(self.next);
        self.behind.insert(self.next);
        self.next
    }

    fn update(&mut self) {
        self.behind.clone_from(&self.all);
    }

    /// Marks a reader as recorded. Returns true if all readers have now been recorded since the last update.
    fn read(&mut self, number: u64) -> bool {
        self.behind.remove(&number);
        self.behind.is_empty()
    }

    fn remove(&mut self, number: u64) {
        self.all.remove(&number);
        self.behind.remove(&number);
    }
}

impl UpdatedBones {
    /// Allocates a mask of `words` 32-bit words. At first, no bone is marked as updated.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, words: usize) -> Result<Self, GpuError> {
        Ok(Self::over(Buffer::new(gpu, "updated bones", words)?))
    }

    /// Uses the bits in an existing buffer. Nothing else may read or clear them.
    pub fn over(bits: Buffer<u32>) -> Self {
        Self { bits, readers: Arc::default() }
    }

    /// Buffer with the bits, to bind. Code that records a kernel that sets bits must also call [`UpdatedBones::update`].
    /// [`CompactJob`](super::compact::CompactJob) makes this call itself.
    pub fn bits(&self) -> &Buffer<u32> {
        &self.bits
    }

    /// Notifies readers that the work recorded now sets bits. All readers must then read the bits again.
    pub fn update(&self) {
        self.lock().update();
    }

    /// Replaces the first `words.len()` words of the mask, and notifies readers.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device, and for more words than the mask has.
    pub fn write(&self, gpu: &Gpu, words: &[u32]) -> Result<(), GpuError> {
        self.update();
        self.bits.write(gpu, words)
    }

    /// Registers a reader. It has not read the present bits yet.
    pub fn reader(&self) -> UpdatedBonesReader {
        UpdatedBonesReader { number: self.lock().add(), updated: self.clone() }
    }

    /// Locks the readers. Poisoning is ignored, because a thread that panics leaves the set of readers consistent.
    fn lock(&self) -> MutexGuard<'_, Readers> {
        self.readers.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl UpdatedBonesReader {
    /// Reports that the work recorded now reads the bits. Returns true if this work must clear the bits afterwards, because all
    /// readers have now read them.
    #[must_use = "the last reader clears the bits"]
    pub fn read(&self) -> bool {
        self.updated.lock().read(self.number)
    }
}

impl Drop for UpdatedBonesReader {
    fn drop(&mut self) {
        self.updated.lock().remove(self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_reader_after_an_update_clears() {
        let mut readers = Readers::default();
        let (a, b) = (readers.add(), readers.add());
        assert!(!readers.read(a) && readers.read(b));
        // Without an update in between, clearing again loses nothing.
        assert!(readers.read(a));
        readers.update();
        assert!(!readers.read(a));
        // Reader a has read the bits only before this update, so it must read them again.
        readers.update();
        assert!(!readers.read(b) && !readers.read(b) && readers.read(a));
        // Readers that take turns never clear the bits.
        for turn in 0..4 {
            readers.update();
            assert!(!readers.read(if turn % 2 == 0 { a } else { b }));
        }
        // A new reader must still read the bits. A dropped reader blocks no other reader.
        let c = readers.add();
        readers.update();
        assert!(!readers.read(a) && !readers.read(c));
        readers.remove(b);
        assert!(readers.read(c));
        readers.update();
        assert!(!readers.read(c) && readers.read(a));
    }
}
