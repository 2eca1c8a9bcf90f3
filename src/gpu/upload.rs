//! Writes from the host: at once, or staged so that an encoder orders them with the work that it records.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use encase::ShaderSize;
use encase::internal::WriteInto;

use super::buffer::uniform_bytes;
use super::{Buffer, Gpu, GpuError, Uniform};

/// What takes writes to buffers. [`Gpu`] writes before the next submission; [`Staged`] writes where it is recorded.
pub trait Upload {
    /// Writes bytes into a buffer, from `offset` on; both are multiples of 4.
    ///
    /// # Errors
    /// [`GpuError`], also where the bytes reach beyond the buffer's end.
    fn bytes(&mut self, to: &wgpu::Buffer, offset: u64, bytes: &[u8]) -> Result<(), GpuError>;

    /// Writes the value of a uniform.
    ///
    /// # Errors
    /// [`GpuError`].
    fn uniform<T: ShaderSize + WriteInto>(&mut self, to: &Uniform<T>, value: &T) -> Result<(), GpuError>
    where
        Self: Sized,
    {
        self.bytes(to.raw(), 0, &uniform_bytes(value)?)
    }

    /// Writes elements of a buffer, from `first` on.
    ///
    /// # Errors
    /// [`GpuError`], also where they reach beyond the buffer's end.
    fn elements<T: bytemuck::Pod>(&mut self, to: &Buffer<T>, first: usize, data: &[T]) -> Result<(), GpuError>
    where
        Self: Sized,
    {
        to.has(first, data.len())?;
        self.bytes(to.raw(), (first * size_of::<T>()) as u64, bytemuck::cast_slice(data))
    }
}

impl Upload for &Gpu {
    fn bytes(&mut self, to: &wgpu::Buffer, offset: u64, bytes: &[u8]) -> Result<(), GpuError> {
        self.scoped(|| self.queue().write_buffer(to, offset, bytes))
    }
}

/// Writes that wait to be recorded.
#[derive(Debug, Default)]
pub struct Staged {
    bytes: Vec<u8>,
    copies: Vec<Copy>,
}

/// A range of the staged bytes, and where it goes.
#[derive(Debug)]
struct Copy {
    to: wgpu::Buffer,
    offset: u64,
    from: u64,
    len: u64,
}

impl Upload for Staged {
    fn bytes(&mut self, to: &wgpu::Buffer, offset: u64, bytes: &[u8]) -> Result<(), GpuError> {
        let (from, len) = (self.bytes.len() as u64, bytes.len() as u64);
        if offset + len > to.size() || !(offset | len).is_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT) {
            let reason = format!("{len} bytes at {offset} do not fit a buffer of {} bytes", to.size());
            return Err(GpuError::Validation { reason });
        }
        self.bytes.extend_from_slice(bytes);
        if len > 0 {
            self.copies.push(Copy { to: to.clone(), offset, from, len });
        }
        Ok(())
    }
}

impl Staged {
    /// Number of bytes that wait.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Whether nothing waits.
    pub fn is_empty(&self) -> bool {
        self.copies.is_empty()
    }
}

/// The smallest staging buffer, in bytes.
const LEAST: u64 = 1 << 12;

/// A ring of staging buffers, one for each recording that has not been executed yet.
#[derive(Debug)]
pub struct StagingRing {
    slots: Vec<Slot>,
    next: usize,
}

#[derive(Debug)]
struct Slot {
    buffer: Option<wgpu::Buffer>,
    state: Arc<AtomicU8>,
}

/// States of a slot: the last, of a recording whose encoder or command buffer was dropped before it was submitted.
const FREE: u8 = 0;
const BUSY: u8 = 1;
const DROPPED: u8 = 2;

/// A recording, which its encoder owns until the device has executed it.
struct Recording(Arc<AtomicU8>);

impl Recording {
    fn is_done(self) {
        self.0.store(FREE, Ordering::Release);
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        let _ = self.0.compare_exchange(BUSY, DROPPED, Ordering::AcqRel, Ordering::Acquire);
    }
}

impl StagingRing {
    /// A ring of `slots` buffers, which are allocated when they are first needed.
    pub fn new(slots: usize) -> Self {
        let slot = || Slot { buffer: None, state: Arc::default() };
        Self { slots: (0..slots).map(|_| slot()).collect(), next: 0 }
    }

    /// Records the staged writes and empties them. Returns whether a buffer was free. Its buffer is free again once
    /// the device has executed what `encoder` records.
    ///
    /// A buffer that is too small is replaced by one of twice the size.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        staged: &mut Staged,
    ) -> Result<bool, GpuError> {
        let Some(slot) = self.free() else { return Ok(false) };
        let needed = staged.bytes.len() as u64;
        if slot.buffer.as_ref().is_none_or(|buffer| buffer.size() < needed) {
            let size = needed.next_power_of_two().max(LEAST);
            slot.buffer = Some(gpu.scoped(|| {
                gpu.device().create_buffer(&wgpu::BufferDescriptor {
                    label: Some("staging"),
                    size,
                    usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            })?);
        }
        if let Some(buffer) = slot.buffer.as_ref().filter(|_| needed > 0) {
            gpu.scoped(|| gpu.queue().write_buffer(buffer, 0, &staged.bytes))?;
            for Copy { to, offset, from, len } in &staged.copies {
                encoder.copy_buffer_to_buffer(buffer, *from, to, *offset, *len);
            }
        }
        slot.state.store(BUSY, Ordering::Release);
        let recording = Recording(slot.state.clone());
        encoder.on_submitted_work_done(move || recording.is_done());
        staged.bytes.clear();
        staged.copies.clear();
        Ok(true)
    }

    /// Number of buffers that are not free.
    pub fn busy(&self) -> usize {
        self.slots.iter().filter(|slot| !slot.is(FREE)).count()
    }

    /// Whether a recording was dropped before it was submitted, so that its writes never happen.
    pub fn has_dropped(&self) -> bool {
        self.slots.iter().any(|slot| slot.is(DROPPED))
    }

    /// Gives up all recordings that have not been executed: their encoders were dropped, or will be. Buffers that
    /// they may still use are not used again.
    pub fn invalidate(&mut self) {
        let slots = self.slots.len();
        *self = Self::new(slots);
    }

    fn free(&mut self) -> Option<&mut Slot> {
        let count = self.slots.len();
        let free = (0..count).map(|step| (self.next + step) % count).find(|at| self.slots[*at].is(FREE))?;
        self.next = (free + 1) % count;
        self.slots.get_mut(free)
    }
}

impl Slot {
    fn is(&self, state: u8) -> bool {
        self.state.load(Ordering::Acquire) == state
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Options;

    fn gpu() -> Gpu {
        Gpu::headless(&Options::default()).expect("the suite needs an adapter")
    }

    fn staged(to: &Buffer<u32>, value: u32) -> Staged {
        let mut staged = Staged::default();
        staged.elements(to, 1, &[value]).expect("fits");
        staged
    }

    /// Two recordings in one submission each see their own value; writes of the queue would both come first.
    #[test]
    fn staged_writes_happen_where_they_are_recorded() {
        let gpu = gpu();
        let mut ring = StagingRing::new(4);
        let source = Buffer::from_slice(&gpu, "source", &[7_u32, 0]).expect("uploaded");
        let seen = Buffer::<u32>::new(&gpu, "seen", 2).expect("allocated");
        let mut encoder = gpu.encoder("two recordings");
        for (at, value) in [(0, 11), (4, 22)] {
            assert!(ring.record(&gpu, &mut encoder, &mut staged(&source, value)).expect("recorded"));
            encoder.copy_buffer_to_buffer(source.raw(), 4, seen.raw(), at, 4);
        }
        gpu.queue().submit([encoder.finish()]);
        assert_eq!(seen.read_blocking(&gpu).expect("read"), [11, 22]);
        assert_eq!(source.read_blocking(&gpu).expect("read"), [7, 22]);
        assert_eq!(ring.busy(), 0);
    }

    #[test]
    fn a_ring_is_full_until_its_work_is_done() {
        let gpu = gpu();
        let mut ring = StagingRing::new(2);
        let to = Buffer::<u32>::new(&gpu, "to", 2).expect("allocated");
        let mut encoder = gpu.encoder("unsubmitted");
        let record = |ring: &mut StagingRing, encoder: &mut wgpu::CommandEncoder| {
            ring.record(&gpu, encoder, &mut staged(&to, 1)).expect("recorded")
        };
        assert_eq!([0; 3].map(|_| record(&mut ring, &mut encoder)), [true, true, false]);
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("done");
        assert_eq!(ring.busy(), 0);
        assert!(!ring.has_dropped());
        // An encoder that is dropped never frees its buffer, and a command buffer neither.
        for is_finished in [false, true] {
            let mut encoder = gpu.encoder("dropped");
            assert!(record(&mut ring, &mut encoder) && !ring.has_dropped());
            if is_finished {
                drop(encoder.finish())
            } else {
                drop(encoder)
            }
            assert!(ring.has_dropped());
            gpu.wait().expect("done");
            assert_eq!(ring.busy(), 1);
            ring.invalidate();
            assert!(ring.busy() == 0 && !ring.has_dropped());
        }
    }

    #[test]
    fn writes_that_do_not_fit_are_refused() {
        let to = Buffer::<u32>::new(&gpu(), "to", 2).expect("allocated");
        let mut staged = Staged::default();
        assert!(staged.elements(&to, 2, &[1]).is_err() && staged.bytes(to.raw(), 2, &[0; 4]).is_err());
        assert!(staged.is_empty() && staged.elements(&to, 0, &[1, 2]).is_ok() && staged.len() == 8);
    }
}
