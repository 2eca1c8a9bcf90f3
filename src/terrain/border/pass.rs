//! The GPU pass of `kernels/terrain/border.wgsl`: a sequence of dispatches over the buffers of a batch.

use super::Neighbours;
use super::visits::{Visit, visits};
use crate::gpu::bindings::terrain::border as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::terrain::border::{BorderParams, NONE};
use crate::terrain::fields::{Fields, places};
use crate::{Error, InputError};

/// Moves the border samples of patches towards the heights of patches that already exist.
#[derive(Debug, Clone)]
pub struct BorderPass {
    within: Kernel,
    across: Kernel,
}

impl BorderPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// Shader compilation errors of the driver.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |others| bindings::kernel(gpu, &bindings::Constants { others });
        Ok(Self { within: kernel(false)?, across: kernel(true)? })
    }

    /// Prepares the transitions of patches that are stored one after the other in `parts`. A transition is `width` samples wide.
    /// `neighbours` holds indices of earlier patches, counted across all parts.
    ///
    /// # Errors
    /// [`InputError`] as [`super::waves`], for a width that is 0 or not below a patch's size, for more entries in `neighbours`
    /// than patches, for parts of different widths, and for buffers that are too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        width: u32,
        neighbours: &[Neighbours],
        parts: &[Fields],
    ) -> Result<Job, Error> {
        let size = parts.first().map_or(0, |part| part.width);
        if width == 0 || width >= size {
            let bound = format!("must be at least 1 and below size = {size}");
            return Err(InputError::new("width", width, bound).into());
        }
        let places = places(parts, size)?;
        let bound = || format!("must be at most {}, the patches in the parts", places.len());
        InputError::check(neighbours.len() <= places.len(), "neighbours.len", neighbours.len(), bound)?;
        let visits = visits(neighbours, &places)?;
        let entries: Vec<_> =
            (0..parts.len()).map(|part| Entries::new(gpu, part, &visits)).collect::<Result<_, _>>()?;
        let mut starts = vec![0; parts.len()];
        let mut steps = Vec::new();
        for Visit { part, source, entries: visited } in &visits {
            let count = visited.len() as u32;
            let params = BorderParams { size, width, start: starts[*part] };
            starts[*part] += count;
            let Entries { neighbours, order } = &entries[*part];
            // A buffer that is bound for writing cannot also be bound for reading. The kernel `within` never reads `others`, so
            // `order` serves as a placeholder.
            let (kernel, others) = if source == part {
                (&self.within, order.slice().cast())
            } else {
                (&self.across, parts[*source].heights.slice())
            };
            let group = bindings::Group {
                params: &Uniform::new(gpu, "border", &params)?,
                heights: parts[*part].heights.slice(),
                neighbours: neighbours.slice(),
                order: order.slice(),
                others,
            };
            let groups = vec![group.bind(gpu, kernel)?];
            steps.push(Step::covering(kernel, groups, [size, size, count]));
        }
        Ok(Job::new(gpu, "terrain/border", steps)?)
    }
}

/// Kernel inputs for all dispatches that write one part, concatenated in dispatch order.
struct Entries {
    neighbours: Buffer<[u32; 4]>,
    order: Buffer<u32>,
}

impl Entries {
    fn new(gpu: &Gpu, part: usize, visits: &[Visit]) -> Result<Self, GpuError> {
        let entries = visits.iter().filter(|visit| visit.part == part).flat_map(|visit| &visit.entries);
        let words = |around: [Option<u32>; 4]| around.map(|neighbour| neighbour.unwrap_or(NONE));
        let (order, neighbours): (Vec<u32>, Vec<[u32; 4]>) =
            entries.map(|(index, around)| (*index, words(*around))).unzip();
        Ok(Self {
            neighbours: Buffer::from_slice(gpu, "neighbours", &neighbours)?,
            order: Buffer::from_slice(gpu, "blend order", &order)?,
        })
    }
}
