//! A ring of readback buffers: data of the device arrives on the host some frames later, without blocking.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use super::{Gpu, GpuError};

/// States of a buffer in the ring.
const FREE: u32 = 0;
const COMING: u32 = 1;
const ARRIVED: u32 = 2;
const FAILED: u32 = 3;

/// A ring of mappable buffers of one size, for readback without blocking.
///
/// A frame copies data into a free buffer, and stores a description of the copy with it. The data arrives once the device has
/// executed the frame and was polled; every submission polls. Nothing is allocated after creation.
#[derive(Debug)]
pub struct ReadbackRing<T> {
    label: &'static str,
    bytes: u64,
    slots: Vec<Slot<T>>,
    recorded: u64,
}

#[derive(Debug)]
struct Slot<T> {
    buffer: wgpu::Buffer,
    state: Arc<AtomicU32>,
    /// Sequence number of the copy, and its description.
    about: Option<(u64, T)>,
}

impl<T> ReadbackRing<T> {
    /// Creates a ring of `slots` buffers of at least `bytes` bytes each.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    pub fn new(gpu: &Gpu, label: &'static str, slots: usize, bytes: u64) -> Result<Self, GpuError> {
        let bytes = bytes.next_multiple_of(8).max(8);
        let slots = (0..slots).map(|_| Slot::new(gpu, label, bytes)).collect::<Result<_, _>>()?;
        Ok(Self { label, bytes, slots, recorded: 0 })
    }

    /// Records a copy into a free buffer, and stores the description `about` with it. Returns whether a buffer was free. If
    /// none was, nothing is recorded and `copy` is not called.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        about: T,
        copy: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::Buffer),
    ) -> bool {
        let Some(slot) = self.slots.iter_mut().find(|slot| slot.is(FREE)) else { return false };
        copy(encoder, &slot.buffer);
        slot.state.store(COMING, Ordering::Release);
        slot.about = Some((self.recorded, about));
        self.recorded += 1;
        let state = slot.state.clone();
        encoder.map_buffer_on_submit(&slot.buffer, wgpu::MapMode::Read, .., move |result| {
            state.store(if result.is_ok() { ARRIVED } else { FAILED }, Ordering::Release);
        });
        true
    }

    /// Returns the latest copy that arrived since the last call, if any. Earlier copies are discarded.
    pub fn take(&mut self) -> Option<(T, Vec<u8>)> {
        let mut last: Option<(u64, T, Vec<u8>)> = None;
        for slot in &mut self.slots {
            match slot.state.load(Ordering::Acquire) {
                ARRIVED => {
                    let about = slot.about.take();
                    let newer =
                        about.filter(|(number, _)| last.as_ref().is_none_or(|(known, ..)| number > known));
                    if let Some((number, about)) = newer
                        && let Ok(bytes) = slot.buffer.get_mapped_range(..)
                    {
                        last = Some((number, about, bytes.to_vec()));
                    }
                    slot.buffer.unmap();
                }
                FAILED => slot.about = None,
                _ => continue,
            }
            slot.state.store(FREE, Ordering::Release);
        }
        last.map(|(_, about, bytes)| (about, bytes))
    }

    /// Discards all copies that have not arrived, for example because their encoders were dropped. The buffers of these copies
    /// are replaced.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    pub fn invalidate(&mut self, gpu: &Gpu) -> Result<(), GpuError> {
        for slot in self.slots.iter_mut().filter(|slot| slot.is(COMING)) {
            *slot = Slot::new(gpu, self.label, self.bytes)?;
        }
        Ok(())
    }
}

impl<T> Slot<T> {
    fn new(gpu: &Gpu, label: &'static str, size: u64) -> Result<Self, GpuError> {
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let buffer = gpu.scoped(|| gpu.raw_buffer(label, size, usage))?;
        Ok(Self { buffer, state: Arc::default(), about: None })
    }

    fn is(&self, state: u32) -> bool {
        self.state.load(Ordering::Acquire) == state
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{Buffer, Options};

    #[test]
    fn copies_arrive_once_and_the_last_counts() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let source = Buffer::<u32>::from_slice(&gpu, "source", &[7, 9]).expect("uploaded");
        let mut ring = ReadbackRing::new(&gpu, "ring", 2, 8).expect("allocated");
        let record = |ring: &mut ReadbackRing<u32>, about, submit| {
            let mut encoder = gpu.encoder("frame");
            let recorded = ring.record(&mut encoder, about, |encoder, to| {
                encoder.copy_buffer_to_buffer(source.raw(), 0, to, 0, 8);
            });
            if submit {
                gpu.queue().submit([encoder.finish()]);
            }
            recorded
        };
        assert!(ring.take().is_none());
        assert!(record(&mut ring, 1, true) && record(&mut ring, 2, true));
        gpu.wait().expect("done");
        let (about, bytes) = ring.take().expect("arrived");
        assert_eq!((about, bytemuck::pod_collect_to_vec::<u8, u32>(&bytes)), (2, vec![7, 9]));
        assert!(ring.take().is_none());
        // A dropped encoder leaves its buffer occupied until `invalidate`.
        assert!(record(&mut ring, 3, false) && record(&mut ring, 4, false) && !record(&mut ring, 5, true));
        gpu.wait().expect("done");
        assert!(ring.take().is_none());
        ring.invalidate(&gpu).expect("allocated");
        assert!(record(&mut ring, 6, true));
        gpu.wait().expect("done");
        assert_eq!(ring.take().expect("arrived").0, 6);
    }
}
