//! Deferred uploads of data that never changes. The program sends them in portions of a chosen size.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard};

use super::{Gpu, GpuError};

/// A queue of deferred uploads, first in, first out. Clones share the queue.
#[derive(Debug, Clone, Default)]
pub(crate) struct PendingUploads(Arc<Mutex<VecDeque<Pending>>>);

/// A deferred upload, and the number of bytes already sent.
#[derive(Debug)]
struct Pending {
    to: Destination,
    bytes: Vec<u8>,
    sent: usize,
}

#[derive(Debug)]
enum Destination {
    Buffer(wgpu::Buffer),
    Texture(Level),
}

/// Destination of an upload: one mip level of one texture layer.
#[derive(Debug)]
struct Level {
    texture: wgpu::Texture,
    mip_level: u32,
    layer: u32,
    width: u32,
    bytes_per_row: u32,
}

impl PendingUploads {
    fn all(&self) -> MutexGuard<'_, VecDeque<Pending>> {
        self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Number of bytes not yet sent.
    pub fn len(&self) -> usize {
        self.all().iter().map(|pending| pending.bytes.len() - pending.sent).sum()
    }

    /// Sends about `most` bytes, at least 1, with the queue's next submission. The amount is rounded up to whole words and
    /// texture rows. Returns the number of bytes sent.
    ///
    /// # Errors
    /// [`GpuError`] that the device reports.
    pub fn send(&self, gpu: &Gpu, most: usize) -> Result<usize, GpuError> {
        let mut all = self.all();
        let mut sent = 0;
        while let Some(first) = all.front_mut() {
            if sent >= most.max(1) {
                break;
            }
            sent += gpu.scoped(|| first.send(gpu.queue(), most - sent))?;
            if first.sent == first.bytes.len() {
                all.pop_front();
            }
        }
        Ok(sent)
    }
}

impl Pending {
    fn send(&mut self, queue: &wgpu::Queue, most: usize) -> usize {
        let unit = match &self.to {
            Destination::Buffer(_) => wgpu::COPY_BUFFER_ALIGNMENT as usize,
            Destination::Texture(level) => level.bytes_per_row as usize,
        };
        let end = self.bytes.len().min(self.sent.saturating_add((most / unit).max(1) * unit));
        let bytes = &self.bytes[self.sent..end];
        match &self.to {
            Destination::Buffer(to) => queue.write_buffer(to, self.sent as u64, bytes),
            Destination::Texture(level) => level.write(queue, self.sent / unit, bytes),
        }
        end - std::mem::replace(&mut self.sent, end)
    }
}

impl Level {
    /// Writes `bytes` as whole texel rows, starting at row `row`.
    fn write(&self, queue: &wgpu::Queue, row: usize, bytes: &[u8]) {
        let Self { texture, mip_level, layer, width, bytes_per_row } = self;
        let origin = wgpu::Origin3d { x: 0, y: row as u32, z: *layer };
        let to = wgpu::TexelCopyTextureInfo { mip_level: *mip_level, origin, ..texture.as_image_copy() };
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(*bytes_per_row),
            rows_per_image: None,
        };
        let height = bytes.len() as u32 / bytes_per_row;
        let size = wgpu::Extent3d { width: *width, height, depth_or_array_layers: 1 };
        queue.write_texture(to, bytes, layout, size);
    }
}

impl Gpu {
    /// Returns the same device in deferring mode, and the queue of its uploads. Uploads of data that never changes
    /// ([`super::Buffer::constant`], [`Gpu::fill_level`]) then wait in the queue until they are sent.
    pub(crate) fn deferring(&self) -> (Self, PendingUploads) {
        let pending = PendingUploads::default();
        (Self { pending: Some(pending.clone()), ..self.clone() }, pending)
    }

    /// Fills a buffer that never changes afterwards. The buffer may be larger than `bytes`, because its size is rounded up.
    pub(super) fn fill_buffer(&self, to: &wgpu::Buffer, bytes: &[u8]) -> Result<(), GpuError> {
        let Some(pending) = self.pending.as_ref().filter(|_| !bytes.is_empty()) else {
            return self.scoped(|| self.queue().write_buffer(to, 0, bytes));
        };
        let to = Destination::Buffer(to.clone());
        pending.all().push_back(Pending { to, bytes: bytes.to_vec(), sent: 0 });
        Ok(())
    }

    /// Writes all texels of one mip level of one texture layer; they never change afterwards. The caller must hold an error
    /// scope.
    pub(crate) fn fill_level(&self, texture: &wgpu::Texture, [mip_level, layer]: [u32; 2], texels: &[u8]) {
        let width = (texture.width() >> mip_level).max(1);
        let bytes_per_row = width * texture.format().block_copy_size(None).unwrap_or(4);
        let level = Level { texture: texture.clone(), mip_level, layer, width, bytes_per_row };
        match &self.pending {
            None => level.write(self.queue(), 0, texels),
            Some(pending) => {
                let to = Destination::Texture(level);
                pending.all().push_back(Pending { to, bytes: texels.to_vec(), sent: 0 });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{Buffer, Options};

    /// For any number of bytes per send, all data arrives in order, and nothing arrives before it is sent.
    #[test]
    fn what_waits_arrives_piece_by_piece() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        for most in [1, 4, 10, 64, 1 << 20] {
            let (deferring, pending) = gpu.deferring();
            let numbers: Vec<u32> = (1..=37).collect();
            let constant = Buffer::constant(&deferring, "constant", &numbers).expect("allocated");
            let others = [9_u32; 3];
            let at_once = Buffer::from_slice(&deferring, "at once", &others).expect("uploaded");
            assert_eq!(pending.len(), 4 * 37);
            assert_eq!(at_once.read_blocking(&gpu).expect("read"), others);
            let (mut sent, mut turns) = (0, 0);
            while sent < numbers.len() {
                let read = constant.read_blocking(&gpu).expect("read");
                let arrived = read.iter().zip(&numbers).filter(|(a, b)| a == b).count();
                assert_eq!(arrived, sent, "{most} bytes a turn, after {turns}");
                assert!(read[sent..].iter().all(|number| *number == 0));
                let bytes = pending.send(&gpu, most).expect("sent");
                assert!(bytes > 0 && bytes < most + 4, "{bytes} of {most}");
                (sent, turns) = (sent + bytes / 4, turns + 1);
            }
            assert_eq!(turns, 37_usize.div_ceil(most.div_ceil(4)));
            assert_eq!(constant.read_blocking(&gpu).expect("read"), numbers);
            assert_eq!((pending.len(), pending.send(&gpu, most).expect("nothing")), (0, 0));
        }
    }

    /// Mip levels of a texture arrive in whole rows of texels.
    #[test]
    fn textures_arrive_row_by_row() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let (deferring, pending) = gpu.deferring();
        let usage = wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
        let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
            label: Some("layers"),
            size: wgpu::Extent3d { width: 64, height: 6, depth_or_array_layers: 2 },
            mip_level_count: 2,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage,
            view_formats: &[],
        });
        let texels: Vec<u8> = (0..64 * 6 * 4).map(|at| (at % 251) as u8).collect();
        let small: Vec<u8> = (0..32 * 3 * 4).map(|at| (at % 241) as u8).collect();
        deferring.fill_level(&texture, [0, 1], &texels);
        deferring.fill_level(&texture, [1, 0], &small);
        let mut turns = Vec::new();
        while pending.len() > 0 {
            turns.push(pending.send(&gpu, 600).expect("sent"));
        }
        // A send of 600 bytes begins with two rows of 256 bytes. The remaining 88 bytes are rounded up to one more row.
        assert_eq!(turns.iter().sum::<usize>(), texels.len() + small.len());
        assert!(turns.iter().all(|bytes| (512..=768).contains(bytes) || *bytes == turns[turns.len() - 1]));
        let read = |mip_level: u32, layer: u32, [width, height]: [u32; 2]| {
            let to = Buffer::<u32>::new(&gpu, "rows", (64 * height) as usize).expect("allocated");
            gpu.submit("read", |encoder| {
                let origin = wgpu::Origin3d { x: 0, y: 0, z: layer };
                let from = wgpu::TexelCopyTextureInfo { mip_level, origin, ..texture.as_image_copy() };
                let layout =
                    wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None };
                let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
                let to = wgpu::TexelCopyBufferInfo { buffer: to.raw(), layout };
                encoder.copy_texture_to_buffer(from, to, size);
            })
            .expect("copied");
            let words = to.read_blocking(&gpu).expect("read");
            let rows = words.chunks_exact(64).flat_map(|row| &row[..width as usize]);
            rows.flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>()
        };
        assert!(read(0, 1, [64, 6]) == texels && read(1, 0, [32, 3]) == small);
    }
}
