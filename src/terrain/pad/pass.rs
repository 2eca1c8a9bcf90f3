//! The GPU pass of `kernels/terrain/pad.wgsl`.

use super::{Surround, validate};
use crate::gpu::bindings::terrain::pad as bindings;
use crate::gpu::{Buffer, Gpu, Job, Step, Uniform, pass};
use crate::shared::terrain::pad::{ELSEWHERE, NONE, PadParams};
use crate::terrain::fields::{Fields, Place, places};
use crate::{Error, InputError};

pass! {
    /// Gathers windows of samples from patches and their neighbours.
    pub struct PadPass;
}

impl PadPass {
    /// Prepares a job that gathers windows, one for each entry of `surrounds`. A window extends `apron` samples beyond its patch
    /// on every side. The job reads the patches from `parts`, where they are stored one after the other, and writes `windows`.
    /// Indices in `surrounds` count patches across all parts.
    ///
    /// # Errors
    /// [`InputError`] when the apron is not smaller than a patch, when an entry of `surrounds` lacks the patch in the middle or
    /// names a patch beyond `parts`, when parts have different widths, or when a buffer is too short; [`crate::gpu::GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        apron: u32,
        surrounds: &[Surround],
        parts: &[Fields],
        windows: &Buffer<i32>,
    ) -> Result<Job, Error> {
        let size = parts.first().map_or(0, |part| part.width);
        validate(size, apron)?;
        let places = places(parts, size)?;
        check_surrounds(surrounds, places.len())?;
        let width = size + 2 * apron;
        windows.check_holds("windows", surrounds.len() * (width as usize).pow(2))?;
        let tiles: Vec<_> = surrounds.iter().flatten().map(|tile| tile.map(|patch| places[patch])).collect();
        let uniform = Uniform::new(gpu, "pad", &PadParams { size, apron })?;
        let mut steps = Vec::new();
        for (part, patches) in parts.iter().enumerate() {
            let Some(around) = tiles_in(part, &tiles) else { continue };
            let around = Buffer::from_slice(gpu, "surroundings", &around)?;
            let group = bindings::Group {
                params: &uniform,
                patches: patches.heights.slice(),
                around: around.slice(),
                outputs: windows.slice(),
            };
            let groups = vec![group.bind(gpu, &self.kernel)?];
            steps.push(Step::covering(&self.kernel, groups, [width, width, surrounds.len() as u32]));
        }
        Ok(Job::new(gpu, "terrain/pad", steps)?)
    }
}

/// Tile indices for the dispatch that reads `part`; `None` if that part holds none of the tiles.
fn tiles_in(part: usize, tiles: &[Option<Place>]) -> Option<Vec<u32>> {
    let here = |tile: &Option<Place>| tile.is_some_and(|place| place.part == part);
    tiles.iter().any(here).then(|| {
        (tiles.iter())
            .map(|tile| match tile {
                Some(place) if place.part == part => place.index,
                Some(_) => ELSEWHERE,
                None => NONE,
            })
            .collect()
    })
}

/// Checks that every entry of `surrounds` has a patch in the middle, and that all indices are below `count`.
fn check_surrounds(surrounds: &[Surround], count: usize) -> Result<(), InputError> {
    for (index, around) in surrounds.iter().enumerate() {
        if around[4].is_none() {
            return Err(InputError::new(
                format!("surrounds[{index}][4]"),
                "none",
                "must be the patch itself",
            ));
        }
        for (tile, patch) in around.iter().enumerate() {
            if let Some(beyond) = patch.filter(|patch| *patch >= count) {
                let bound = format!("must be below {count}, the patches in the parts");
                return Err(InputError::new(format!("surrounds[{index}][{tile}]"), beyond, bound));
            }
        }
    }
    Ok(())
}
