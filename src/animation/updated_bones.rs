//! The bones that were updated since skinning last followed them, for any number of readers.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::gpu::{Buffer, Gpu, GpuError};

/// One bit per slot of each instance, in [`Order::words`](super::order::Order::words) words per instance: the bones
/// whose model matrices were updated. Bits accumulate: kernels set them, and they stay until everything that follows
/// the matrices has been brought up to date, so a frame may skip skinning. Every bone below an updated one is set
/// too.
///
/// What follows the matrices is a reader ([`UpdatedBones::reader`]), as every
/// [`SkinFrame`](crate::skinning::frame::SkinFrame) and [`PagedSkin`](crate::skinning::paged::PagedSkin) is by
/// itself. The bits are cleared by whichever reader is the last to be recorded after an update. Until then, a reader
/// that is recorded again finds all bits once more and does too much, and never too little. So it is for readers that
/// take turns, each skipping the frames of the others, and for one that is never recorded: drop it.
///
/// The order of recording counts. Submit encoders in the order in which they were recorded. If an encoder with some
/// of the readers is not submitted, while others clear the bits, prepare the skinning of the former anew. Clones are
/// of the same bits and readers.
#[derive(Debug, Clone)]
pub struct UpdatedBones {
    bits: Buffer<u32>,
    readers: Arc<Mutex<Readers>>,
}

/// A reader of updated bones, until it is dropped.
#[derive(Debug)]
pub struct UpdatedBonesReader {
    number: u64,
    updated: UpdatedBones,
}

/// The numbers of readers.
#[derive(Debug, Default)]
struct Readers {
    next: u64,
    all: BTreeSet<u64>,
    /// Those that were not recorded since the last update.
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

    /// Returns whether no reader is behind any more.
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
    /// Allocates so many words; no bone is updated.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, words: usize) -> Result<Self, GpuError> {
        Ok(Self::over(Buffer::new(gpu, "updated bones", words)?))
    }

    /// The bits in a buffer that nothing else reads or clears.
    pub fn over(bits: Buffer<u32>) -> Self {
        Self { bits, readers: Arc::default() }
    }

    /// The bits, to bind. Whoever records work that sets bits calls [`UpdatedBones::update`] then;
    /// [`CompactJob`](super::compact::CompactJob) does it by itself.
    pub fn bits(&self) -> &Buffer<u32> {
        &self.bits
    }

    /// Tells readers that bits are set by what is recorded or written now: all of them are behind.
    pub fn update(&self) {
        self.lock().update();
    }

    /// Replaces the first words, and tells readers.
    ///
    /// # Errors
    /// [`GpuError`], also for more words than there are.
    pub fn write(&self, gpu: &Gpu, words: &[u32]) -> Result<(), GpuError> {
        self.update();
        self.bits.write(gpu, words)
    }

    /// A further reader, which is behind.
    pub fn reader(&self) -> UpdatedBonesReader {
        UpdatedBonesReader { number: self.lock().add(), updated: self.clone() }
    }

    /// A thread that panicked leaves the numbers as they should be.
    fn lock(&self) -> MutexGuard<'_, Readers> {
        self.readers.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl UpdatedBonesReader {
    /// Tells that the work recorded now reads the bits. Returns whether that work must clear them afterwards, because
    /// no reader is behind any more.
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
        // Without an update nothing is lost by clearing again.
        assert!(readers.read(a));
        readers.update();
        assert!(!readers.read(a));
        // What a has read before this update is not enough.
        readers.update();
        assert!(!readers.read(b) && !readers.read(b) && readers.read(a));
        // Readers that take turns never clear.
        for turn in 0..4 {
            readers.update();
            assert!(!readers.read(if turn % 2 == 0 { a } else { b }));
        }
        // A further reader is behind, and one that is gone holds nobody up.
        let c = readers.add();
        readers.update();
        assert!(!readers.read(a) && !readers.read(c));
        readers.remove(b);
        assert!(readers.read(c));
        readers.update();
        assert!(!readers.read(c) && readers.read(a));
    }
}
