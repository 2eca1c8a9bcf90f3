//! Complete fields on the device: all kernels in the order of a recipe. This is the GPU counterpart of [`crate::terrain::field`].
//!
//! A window is a patch with the samples around it that erosion needs. Together, the buffers never hold more than two `i32` per
//! sample of the windows, or ten with hydraulic erosion. These numbers include the results. Each stage frees the data that the
//! next stage does not read, but for the flow of hydraulic erosion. An index of features takes two more bits per sample and level.

use crate::Error;
use crate::gpu::{Gpu, GpuError};
use crate::terrain::border::{BorderPass, neighbours};
use crate::terrain::config::Border;
use crate::terrain::despike::{DespikeBuffers, DespikePass};
use crate::terrain::erosion::{Eroding, ErosionPass};
use crate::terrain::features::FeatureIndex;
use crate::terrain::fields::{Fields, REMEDY, after};
use crate::terrain::pad::{PadPass, Surround, surrounds};
use crate::terrain::recipe::Recipe;
use crate::terrain::regions::{HeightBuffers, HeightScratch, RegionPass};
use crate::terrain::window::Lattice;
use crate::terrain::window::{Window, Windows};

/// Generates the fields of patches according to one recipe.
#[derive(Debug, Clone)]
pub struct Generator {
    recipe: Recipe,
    regions: RegionPass,
    border: BorderPass,
    pad: PadPass,
    despike: DespikePass,
    erosion: ErosionPass,
}

impl Generator {
    /// Checks the recipe and compiles all pipelines that it needs.
    ///
    /// # Errors
    /// [`crate::InputError`] for a recipe out of bounds; [`GpuError`].
    pub fn new(gpu: &Gpu, recipe: Recipe) -> Result<Self, Error> {
        recipe.validate(&[], 0)?;
        let injection = recipe.features.injection();
        Ok(Self {
            regions: RegionPass::new(gpu, &recipe.config, injection)?,
            border: BorderPass::new(gpu)?,
            pad: PadPass::new(gpu)?,
            despike: match injection {
                Some(_) => DespikePass::with_features(gpu)?,
                None => DespikePass::new(gpu)?,
            },
            erosion: ErosionPass::new(gpu, &recipe)?,
            recipe,
        })
    }

    /// Largest number of patches in one part of the result.
    pub(crate) fn patches_per_part(&self, gpu: &Gpu, margin: u32) -> usize {
        self.most(gpu, self.recipe.config.patch_size + 2 * self.recipe.apron(margin))
    }

    /// Largest number of windows in one part. With hydraulic erosion, it is a quarter of [`Fields::most`], because the flow takes
    /// four words per sample.
    fn most(&self, gpu: &Gpu, width: u32) -> usize {
        let windows = Fields::most(gpu, width);
        if self.recipe.hydraulic.is_some() { (windows / 4).max(1) } else { windows }
    }

    /// Generates the final heights of `patches`, with `margin` samples around each. The result is split into parts that each fit
    /// one storage binding. After each part, `progress` is called with the part's number of patches. Waits for the device.
    ///
    /// Apart from features, at most two `i32` per sample of the windows are allocated at once, or ten with hydraulic erosion.
    ///
    /// # Errors
    /// [`crate::InputError`] for patches out of bounds; [`GpuError`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn generate(
        &self,
        gpu: &Gpu,
        patches: &[[i32; 2]],
        margin: u32,
        progress: &mut (dyn FnMut(usize) + Send),
    ) -> Result<Vec<Fields>, Error> {
        gpu.block_on(self.generate_async(gpu, patches, margin, progress))
    }

    /// Generates the final heights of `patches` like `Generator::generate`, but without blocking: the future completes when the
    /// device has finished; see [`Gpu::wait_async`].
    ///
    /// # Errors
    /// [`crate::InputError`] for patches out of bounds; [`GpuError`].
    pub async fn generate_async(
        &self,
        gpu: &Gpu,
        patches: &[[i32; 2]],
        margin: u32,
        progress: &mut (dyn FnMut(usize) + Send),
    ) -> Result<Vec<Fields>, Error> {
        self.recipe.validate(patches, margin)?;
        let apron = self.recipe.apron(margin);
        if patches.is_empty() {
            return Ok(Vec::new());
        }
        if let Border::Blend(_) = self.recipe.config.border {
            // A patch may depend on patches in any other part, so all patches are generated at once.
            let fields = self.by_themselves(gpu, patches, apron).await?;
            progress(patches.len());
            return Ok(fields);
        }
        let mut parts = Vec::new();
        for part in patches.chunks(self.patches_per_part(gpu, margin)) {
            if self.recipe.config.border == Border::Wrap {
                parts.extend(self.by_themselves(gpu, part, apron).await?);
            } else {
                let windows = self.windows(gpu, part, apron).await?;
                let injected = self.recipe.injected(part, apron);
                parts.push(self.finish(gpu, apron, &injected, windows).await?);
            }
            progress(part.len());
        }
        Ok(parts)
    }

    async fn windows(&self, gpu: &Gpu, patches: &[[i32; 2]], apron: u32) -> Result<Fields, Error> {
        let capacity = patches.iter().map(|patch| self.seen_features(Window { patch: *patch, apron })).sum();
        self.generated(gpu, patches, apron, capacity).await
    }

    /// Generates the fields of `patches`, with `apron` samples around each and memory for `capacity` features.
    async fn generated(
        &self,
        gpu: &Gpu,
        patches: &[[i32; 2]],
        apron: u32,
        capacity: usize,
    ) -> Result<Fields, Error> {
        let config = &self.recipe.config;
        let count = patches.len() as u32;
        let fields = Fields::new(gpu, "terrain heights", config.patch_size + 2 * apron, count)?;
        let scratch = HeightScratch::new(gpu, config, Windows { count, apron })?;
        let buffers = HeightBuffers { output: &fields.heights, scratch: &scratch };
        let job = self.regions.prepare(gpu, config, Windows { count, apron }, capacity, buffers)?;
        job.set(gpu, patches, &self.recipe.features)?;
        gpu.run_async("terrain heights", |encoder| job.record(encoder)).await?;
        Ok(fields)
    }

    /// Number of features that influence a window: the features within the window's base lattice and one point around it.
    fn seen_features(&self, window: Window) -> usize {
        let (config, features) = (&self.recipe.config, &self.recipe.features);
        if features.is_empty() {
            return 0;
        }
        let spacing = config.sample_spacing();
        let finer = 1 << config.levels();
        let base = window.levels(config)[0];
        // The region suffices for every position of the window relative to the base lattice, with one cell to spare.
        let origin = base.map(|span| (span.first - 2) * finer * spacing);
        let width = base.map(|span| (span.width() as i64 + 4) * finer).into_iter().max().unwrap_or(0) as u32;
        features.on_lattice([0, 0], Lattice { origin, width, spacing }, false).len()
    }

    async fn by_themselves(&self, gpu: &Gpu, patches: &[[i32; 2]], apron: u32) -> Result<Vec<Fields>, Error> {
        let config = &self.recipe.config;
        let alone = self.alone(gpu, patches).await?;
        if apron == 0 {
            return Ok(alone);
        }
        let width = config.patch_size + 2 * apron;
        let mut sizes = part_sizes(patches.len(), self.most(gpu, width));
        let all = surrounds(config, patches);
        let injected = self.recipe.injected(patches, apron);
        // The last part takes all remaining patches.
        sizes.pop();
        let (mut parts, mut start) = (Vec::new(), 0);
        for size in sizes {
            let part = start..start + size;
            let windows = self.padded(gpu, apron, &all[part.clone()], &alone).await?;
            parts.push(self.finish(gpu, apron, &injected[part], windows).await?);
            start += size;
        }
        let last = self.padded(gpu, apron, &all[start..], &alone).await?;
        // The patches without aprons are no longer read. The following stages need their memory.
        drop(alone);
        parts.push(self.finish(gpu, apron, &injected[start..], last).await?);
        Ok(parts)
    }

    /// Gathers windows around patches; `alone` holds all patches without their surroundings.
    async fn padded(
        &self,
        gpu: &Gpu,
        apron: u32,
        around: &[Surround],
        alone: &[Fields],
    ) -> Result<Fields, Error> {
        let width = self.recipe.config.patch_size + 2 * apron;
        let windows = Fields::new(gpu, "terrain windows", width, around.len() as u32)?;
        let job = self.pad.prepare(gpu, apron, around, alone, &windows.heights)?;
        gpu.run_async("terrain/pad", |encoder| job.record(encoder)).await?;
        Ok(windows)
    }

    /// Generates patches without samples around them, and applies the transitions of `blend`.
    async fn alone(&self, gpu: &Gpu, patches: &[[i32; 2]]) -> Result<Vec<Fields>, Error> {
        let config = &self.recipe.config;
        let mut parts = Vec::new();
        for part in patches.chunks(Fields::most(gpu, config.patch_size)) {
            parts.push(self.generated(gpu, part, 0, self.recipe.features.len()).await?);
        }
        if let Border::Blend(width) = config.border {
            let job = self.border.prepare(gpu, width, &neighbours(patches), &parts)?;
            job.run_async(gpu).await?;
        }
        Ok(parts)
    }

    /// Despikes and erodes windows. The stages alternate between the windows' buffer and a second buffer.
    async fn finish(
        &self,
        gpu: &Gpu,
        apron: u32,
        injected: &[Vec<(u32, u32)>],
        windows: Fields,
    ) -> Result<Fields, Error> {
        if self.recipe.apron(0) == 0 {
            return Ok(windows);
        }
        // Every stage drops a ring of samples, so the second buffer can be one sample smaller on each side.
        let other = Fields::new(gpu, "terrain windows", windows.cropped(1).width, windows.count)?;
        let mut both = [windows, other];
        if let Some(despike) = self.recipe.despike {
            let features = self.index(gpu, apron, injected)?;
            let buffers = DespikeBuffers { windows: &both[0], features: &features, cropped: &both[1] };
            let job = self.despike.prepare(gpu, despike, buffers)?;
            gpu.run_async("terrain/despike", |encoder| job.record(encoder)).await?;
            both = after(both, 1);
        }
        let flows = self.erosion.flows(gpu, &both[0]).map_err(|error| error.with_remedy(REMEDY))?;
        let eroding = Eroding { windows: &both, flows: flows.as_ref() };
        let (jobs, windows) = self.erosion.prepare(gpu, eroding)?;
        for job in jobs {
            job.run_async(gpu).await?;
        }
        Ok(windows)
    }

    /// Index of all injected points of the windows. `injected` has the (column, row) pairs of each window.
    fn index(&self, gpu: &Gpu, apron: u32, injected: &[Vec<(u32, u32)>]) -> Result<FeatureIndex, GpuError> {
        let width = self.recipe.config.patch_size + 2 * apron;
        let points = injected.iter().map(Vec::len).sum::<usize>();
        let capacity = if self.recipe.features.is_empty() { 0 } else { points.max(1) };
        let index = FeatureIndex::new(gpu, &[width], injected.len() as u32, capacity)?;
        index.write(&mut &*gpu, injected.len() as u32, |_, window| {
            // The index counts from one point before the window, hence + 1. Despiking reads no heights, so they are 0.
            injected[window as usize].iter().map(|(column, row)| (column + 1, row + 1, 0)).collect()
        })?;
        Ok(index)
    }
}

/// Splits `count` patches into the fewest parts of at most `most` patches, smaller parts first. Memory for a later part is not
/// allocated while an earlier part is processed, so the earlier part can use it as scratch.
fn part_sizes(count: usize, most: usize) -> Vec<usize> {
    let parts = count.div_ceil(most.max(1));
    (0..parts).map(|part| (count + part) / parts.max(1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_grow_and_hold_all() {
        assert!(part_sizes(0, 5).is_empty());
        assert_eq!(part_sizes(5, 5), [5]);
        assert_eq!(part_sizes(6, 5), [3, 3]);
        assert_eq!(part_sizes(11, 3), [2, 3, 3, 3]);
        for (count, most) in (1..60).flat_map(|count| (1..60).map(move |most| (count, most))) {
            let sizes = part_sizes(count, most);
            assert_eq!(sizes.iter().sum::<usize>(), count);
            assert!(sizes.is_sorted() && sizes.iter().all(|size| (1..=most).contains(size)), "{sizes:?}");
        }
    }
}
