//! Pages for what the views of a frame see of a character.

use std::ops::Range;

use crate::Error;
use crate::gpu::Gpu;
use crate::lod::{LodObject, SceneInstance, SelectView};
use crate::scene::chunk::halved;
use crate::scene::paging::{Paging, Seen};

use super::Character;
use super::runtime::{Runtime, is_out_of_memory};

/// What was provided for a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::scene) struct Provided {
    /// The factor by which levels of detail must be coarser: 1 unless memory has ended.
    pub coarsening: f32,
    pub replaced: Replaced,
}

/// What is another than before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::scene) enum Replaced {
    Nothing,
    /// The pages of some chunks.
    Pages,
    /// The chunks. The instances of those that were divided start afresh.
    Chunks,
}

impl Character {
    /// Provides the pages that the views of a frame need. A chunk whose pages would exceed a binding is divided; where
    /// memory ends, levels of detail must be coarser.
    pub fn provide(
        &mut self,
        gpu: &Gpu,
        views: &[SelectView],
        object: &LodObject,
        instances: &[SceneInstance],
    ) -> Result<Provided, Error> {
        let coarsening = match self.runtimes.iter().all(Runtime::is_full) {
            true => 1.0,
            false => self.provide_seen(gpu, &Seen::new(views, object, instances))?,
        };
        // After an error it says what was replaced before.
        let replaced = std::mem::replace(&mut self.replaced, Replaced::Nothing);
        Ok(Provided { coarsening, replaced })
    }

    /// Provides pages for what is seen; the factor by which levels of detail must be coarser.
    fn provide_seen(&mut self, gpu: &Gpu, seen: &Seen<'_>) -> Result<f32, Error> {
        self.divide(gpu, seen)?;
        loop {
            let coarsening = seen.coarsening(self.runtimes.iter().map(chunk));
            let mut is_short = false;
            for runtime in &mut self.runtimes {
                let needed = seen.pages(&runtime.slots, &runtime.paging, coarsening);
                let [has_other, ends] = runtime.provide(gpu, &needed)?;
                let replaced = if has_other { Replaced::Pages } else { Replaced::Nothing };
                self.replaced = self.replaced.max(replaced);
                is_short |= ends;
            }
            if !is_short {
                return Ok(coarsening);
            }
            self.is_memory_short = true;
        }
    }

    /// Divides the chunks that need more pages than a binding holds.
    fn divide(&mut self, gpu: &Gpu, seen: &Seen<'_>) -> Result<(), Error> {
        if self.is_memory_short {
            return Ok(());
        }
        let mut at = 0;
        while let Some(Runtime { slots, paging, .. }) = self.runtimes.get(at) {
            let ranges = halved(slots.clone(), |part| seen.fits(part, paging, 1.0));
            let replaced = at;
            if ranges.len() > 1 {
                let model = &self.merged.model;
                let parts = ranges
                    .into_iter()
                    .map(|part| Runtime::all(gpu, model, &self.shared, part, self.keeps_last));
                let parts = parts.collect::<Result<Vec<_>, Error>>();
                if is_out_of_memory(&parts) {
                    // Another attempt in each frame would cost more than it gains.
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

/// The instances and pages of a chunk.
fn chunk(runtime: &Runtime) -> (&Range<usize>, &[Paging]) {
    (&runtime.slots, &runtime.paging)
}
