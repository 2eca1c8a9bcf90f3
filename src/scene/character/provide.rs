//! Allocation of pages (blocks of 64 skinned vertices) for the character instances that a frame's views see.

use std::ops::Range;

use crate::Error;
use crate::gpu::Gpu;
use crate::scene::chunk::halved;
use crate::scene::object_kind::{Provided, Replaced, SeenBy};
use crate::scene::paging::{Paging, Seen};

use super::Character;
use super::runtime::{Room, Runtime, is_out_of_memory};

impl Character {
    /// Allocates the pages that a frame's views need. A chunk is divided if its pages would exceed the device's largest
    /// buffer binding. If memory is short, the result has an LOD bias above 1, which makes levels coarser.
    pub(super) fn provide_pages(&mut self, gpu: &Gpu, seen: &SeenBy<'_>) -> Result<Provided, Error> {
        let lod_bias = match self.runtimes.iter().all(Runtime::is_full) {
            true => 1.0,
            false => {
                let seen = Seen::new(seen, &mut self.held);
                self.provide_seen(gpu, &seen)?
            }
        };
        // After an error in an earlier frame, `replaced` still holds that frame's replacements.
        let replaced = std::mem::replace(&mut self.replaced, Replaced::Nothing);
        Ok(Provided { lod_bias, replaced, ..Provided::default() })
    }

    /// Allocates pages for visible instances. Returns the LOD bias, which is above 1 if memory is short.
    fn provide_seen(&mut self, gpu: &Gpu, seen: &Seen<'_>) -> Result<f32, Error> {
        self.divide(gpu, seen)?;
        loop {
            let lod_bias = seen.lod_bias(self.runtimes.iter().map(chunk));
            let mut is_short = false;
            for runtime in &mut self.runtimes {
                let needed = seen.pages(&runtime.slots, &runtime.paging, lod_bias);
                let [has_other, ends] = runtime.provide(gpu, &needed)?;
                let replaced = if has_other { Replaced::Buffers } else { Replaced::Nothing };
                self.replaced = self.replaced.max(replaced);
                is_short |= ends;
            }
            if !is_short {
                return Ok(lod_bias);
            }
            self.is_memory_short = true;
        }
    }

    /// Divides chunks that need more pages than fit into a buffer binding.
    fn divide(&mut self, gpu: &Gpu, seen: &Seen<'_>) -> Result<(), Error> {
        if self.is_memory_short {
            return Ok(());
        }
        let (capacity, keeps_last, mut at) = (self.plays.len(), self.keeps_last, 0);
        while let Some(Runtime { slots, paging, .. }) = self.runtimes.get(at) {
            let ranges = halved(slots.clone(), |part| seen.fits(part, paging, 1.0));
            let replaced = at;
            if ranges.len() > 1 {
                let model = &self.merged.model;
                let parts = ranges.into_iter().map(|slots| {
                    Runtime::all(gpu, model, &self.shared, &Room { slots, capacity, keeps_last })
                });
                let parts = parts.collect::<Result<Vec<_>, Error>>();
                if is_out_of_memory(&parts) {
                    // Another attempt in every frame would cost more than it gains.
                    self.is_memory_short = true;
                    return Ok(());
                }
                let parts: Vec<Runtime> = parts?.into_iter().flatten().collect();
                at += parts.len();
                self.runtimes.splice(replaced..=replaced, parts);
                self.changed.all(self.plays.len());
                let count = self.plays.len();
                self.layers.iter_mut().for_each(|layer| layer.resize(count));
                self.replaced = Replaced::Chunks;
            } else {
                at += 1;
            }
        }
        Ok(())
    }
}

/// The range of instances in a chunk, and the page counts of its meshes.
fn chunk(runtime: &Runtime) -> (&Range<usize>, &[Paging]) {
    (&runtime.slots, &runtime.paging)
}
