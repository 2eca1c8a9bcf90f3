//! Writes from the host to device buffers. Immediate writes take effect before the next submission. Staged writes take effect
//! where an encoder records them.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use encase::ShaderSize;
use encase::internal::WriteInto;

use super::buffer::uniform_bytes;
use super::{Buffer, Gpu, GpuError, Uniform};

/// A destination for buffer writes. With [`Gpu`], writes take effect before the next submission. With [`Staged`], they take
/// effect where an encoder records them.
pub trait Upload {
    /// Writes bytes into a buffer, from byte `offset` on. Offset and length must be multiples of 4.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports; also if the bytes reach beyond the buffer's end.
    fn bytes(&mut self, to: &wgpu::Buffer, offset: u64, bytes: &[u8]) -> Result<(), GpuError>;

    /// Writes the value of a uniform buffer.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    fn uniform<T: ShaderSize + WriteInto>(&mut self, to: &Uniform<T>, value: &T) -> Result<(), GpuError>
    where
        Self: Sized,
    {
        self.bytes(to.raw(), 0, &uniform_bytes(value)?)
    }

    /// Writes elements of a buffer, starting at the element `first`.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports; also if the elements reach beyond the buffer's end.
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

/// Writes that are staged but not yet recorded in an encoder.
#[derive(Debug, Default)]
pub struct Staged {
    bytes: Vec<u8>,
    copies: Vec<Copy>,
}

/// One staged write: a range of the staged bytes, and its destination.
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
        check_fits(to, offset, len)?;
        self.bytes.extend_from_slice(bytes);
        if len > 0 {
            self.copies.push(Copy { to: to.clone(), offset, from, len });
        }
        Ok(())
    }
}

impl Staged {
    /// Number of staged bytes.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Whether no write is staged.
    pub fn is_empty(&self) -> bool {
        self.copies.is_empty()
    }
}

/// Smallest size of a staging buffer, in bytes.
const LEAST: u64 = 1 << 12;

/// A ring of staging buffers. Each recording uses one of them until the device has executed the recording.
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

/// States of a staging buffer. DROPPED: an encoder or command buffer with a recording was dropped before submission.
const FREE: u8 = 0;
const BUSY: u8 = 1;
const DROPPED: u8 = 2;

/// Marks a staging buffer as in use. The encoder owns this value until the device has executed the recording.
struct Recording(Arc<AtomicU8>);

impl Recording {
    fn finish(self) {
        self.0.store(FREE, Ordering::Release);
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        let _ = self.0.compare_exchange(BUSY, DROPPED, Ordering::AcqRel, Ordering::Acquire);
    }
}

impl StagingRing {
    /// Creates a ring of `slots` buffers. Each is allocated on first use.
    pub fn new(slots: usize) -> Self {
        let slot = || Slot { buffer: None, state: Arc::default() };
        Self { slots: (0..slots).map(|_| slot()).collect(), next: 0 }
    }

    /// Records the staged writes in `encoder`, and clears them. Returns whether a staging buffer was free; if none was, nothing
    /// is recorded.
    ///
    /// The staging buffer is free again once the device has executed the work of `encoder`. A buffer that is too small is
    /// replaced by a larger buffer, with a power of two as its size.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        staged: &mut Staged,
    ) -> Result<bool, GpuError> {
        let Some(slot) = self.free() else { return Ok(false) };
        let needed = staged.bytes.len() as u64;
        slot.make_room(gpu, needed)?;
        if let Some(buffer) = slot.buffer.as_ref().filter(|_| needed > 0) {
            gpu.scoped(|| gpu.queue().write_buffer(buffer, 0, &staged.bytes))?;
            for Copy { to, offset, from, len } in &staged.copies {
                encoder.copy_buffer_to_buffer(buffer, *from, to, *offset, *len);
            }
        }
        slot.occupy(encoder);
        staged.bytes.clear();
        staged.copies.clear();
        Ok(true)
    }

    /// Starts a sequence of writes that are recorded one by one. `room` is their expected size in bytes. `None` if no buffer is
    /// free.
    pub(crate) fn stream<'a>(&'a mut self, gpu: &'a Gpu, room: usize) -> Option<StagingStream<'a>> {
        let slot = self.free()?;
        Some(StagingStream { gpu, slot, room, bytes: Vec::new(), is_used: false })
    }

    /// Number of staging buffers that are not free.
    pub fn busy(&self) -> usize {
        self.slots.iter().filter(|slot| !slot.is(FREE)).count()
    }

    /// Whether a recording was dropped before it was submitted. Its writes are lost.
    pub fn has_dropped(&self) -> bool {
        self.slots.iter().any(|slot| slot.is(DROPPED))
    }

    /// Discards all recordings that have not been executed, for example because their encoders were dropped. Buffers that such
    /// recordings may still use are not reused.
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

    /// Replaces a buffer that is smaller than `needed` bytes by a larger buffer, with a power of two as its size.
    fn make_room(&mut self, gpu: &Gpu, needed: u64) -> Result<(), GpuError> {
        if self.buffer.as_ref().is_none_or(|buffer| buffer.size() < needed) {
            let size = needed.next_power_of_two().max(LEAST);
            let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
            self.buffer = Some(gpu.scoped(|| gpu.raw_buffer("staging", size, usage))?);
        }
        Ok(())
    }

    /// Marks the buffer as busy until the device has executed the work of `encoder`.
    fn occupy(&self, encoder: &mut wgpu::CommandEncoder) {
        self.state.store(BUSY, Ordering::Release);
        let recording = Recording(self.state.clone());
        encoder.on_submitted_work_done(move || recording.finish());
    }
}

/// Writes that are recorded one by one, among other work of an encoder. All their bytes are uploaded together at the end.
#[derive(Debug)]
pub(crate) struct StagingStream<'a> {
    gpu: &'a Gpu,
    slot: &'a mut Slot,
    /// Expected size of all writes, in bytes.
    room: usize,
    /// Bytes to upload into the staging buffer before submission.
    bytes: Vec<u8>,
    is_used: bool,
}

impl StagingStream<'_> {
    /// Records a write of bytes into a buffer, from byte `offset` on. Offset and length must be multiples of 4.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports; also if the bytes reach beyond the buffer's end.
    pub fn write(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        to: &wgpu::Buffer,
        offset: u64,
        bytes: &[u8],
    ) -> Result<(), GpuError> {
        check_fits(to, offset, bytes.len() as u64)?;
        let needed = self.bytes.len() + bytes.len();
        let has_room = |buffer: &wgpu::Buffer| needed as u64 <= buffer.size();
        if !self.slot.buffer.as_ref().is_some_and(has_room) {
            // Copies that are already recorded keep reading the old buffer.
            self.send()?;
            self.slot.make_room(self.gpu, needed.max(self.room) as u64)?;
            self.bytes.clear();
        }
        let Some(from) = &self.slot.buffer else { return Ok(()) };
        encoder.copy_buffer_to_buffer(from, self.bytes.len() as u64, to, offset, bytes.len() as u64);
        self.bytes.extend_from_slice(bytes);
        self.is_used = true;
        Ok(())
    }

    /// Ends the sequence of writes. The staging buffer is free again once the device has executed the work of `encoder`.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    pub fn finish(self, encoder: &mut wgpu::CommandEncoder) -> Result<(), GpuError> {
        self.send()?;
        if self.is_used {
            self.slot.occupy(encoder);
        }
        Ok(())
    }

    fn send(&self) -> Result<(), GpuError> {
        match &self.slot.buffer {
            Some(buffer) if !self.bytes.is_empty() => {
                self.gpu.scoped(|| self.gpu.queue().write_buffer(buffer, 0, &self.bytes))
            }
            _ => Ok(()),
        }
    }
}

fn check_fits(to: &wgpu::Buffer, offset: u64, len: u64) -> Result<(), GpuError> {
    if offset + len > to.size() || !(offset | len).is_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT) {
        let reason = format!("{len} bytes at {offset} do not fit a buffer of {} bytes", to.size());
        return Err(GpuError::Validation { reason });
    }
    Ok(())
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

    /// Two recordings in one submission each see their own value. Writes by the queue would both come before the submission.
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

    /// Writes that are recorded one by one are visible to later work of the encoder, even if they exceed their expected size.
    #[test]
    fn streams_write_where_they_are_recorded() {
        let gpu = gpu();
        let mut ring = StagingRing::new(1);
        let source = Buffer::<u32>::new(&gpu, "source", 1).expect("allocated");
        let count = 3 * LEAST as u32 / 4;
        let seen = Buffer::<u32>::new(&gpu, "seen", count as usize).expect("allocated");
        for round in 0..2 {
            let mut encoder = gpu.encoder("writes");
            let mut stream = ring.stream(&gpu, 8).expect("free");
            for at in 0..count {
                let word = at + round;
                stream.write(&mut encoder, source.raw(), 0, bytemuck::bytes_of(&word)).expect("fits");
                encoder.copy_buffer_to_buffer(source.raw(), 0, seen.raw(), 4 * u64::from(at), 4);
            }
            assert!(stream.write(&mut encoder, source.raw(), 2, &[0; 4]).is_err());
            stream.finish(&mut encoder).expect("sent");
            assert!(ring.stream(&gpu, 8).is_none(), "its buffer is free before it is executed");
            gpu.queue().submit([encoder.finish()]);
            let right: Vec<u32> = (round..count + round).collect();
            assert!(seen.read_blocking(&gpu).expect("read") == right, "round {round}");
            assert_eq!(ring.busy(), 0);
        }
        let mut encoder = gpu.encoder("nothing");
        ring.stream(&gpu, 8).expect("free").finish(&mut encoder).expect("nothing to send");
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
        // A dropped encoder or command buffer leaves its staging buffer occupied.
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
