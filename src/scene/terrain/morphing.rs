//! Terrain that blends the heights of two recipes.

use crate::Error;
use crate::gpu::{Gpu, Staged};
use crate::terrain::fields::Fields;
use crate::terrain::morph::reference::morph;
use crate::terrain::morph::{Morph, MorphedFields};

/// The heights of two recipes, and their blend.
#[derive(Debug)]
pub(in crate::scene) struct Morphing {
    blend: MorphedFields,
    /// Height windows of both recipes on the host: for each recipe, one window per patch.
    ends: [Vec<Vec<i32>>; 2],
    morph: Morph,
    /// Whether the device must compute the blend in the next frame.
    is_due: bool,
}

impl Morphing {
    /// Blends two sets of fields on the device, and waits for the result.
    pub async fn new(gpu: &Gpu, [from, to]: [Vec<Fields>; 2], morph: Morph) -> Result<Self, Error> {
        let blend = MorphedFields::new(gpu, &from, &to)?;
        blend.set(gpu, morph)?;
        gpu.run_async("terrain/morph", |encoder| blend.record(encoder)).await?;
        let ends = [read(gpu, &from).await?, read(gpu, &to).await?];
        Ok(Self { blend, ends, morph, is_due: false })
    }

    /// The blended fields, in parts that each fit one binding of the device.
    pub fn fields(&self) -> Vec<Fields> {
        self.blend.fields().to_vec()
    }

    /// Sets another blend. Returns the blended height windows, patch by patch. They equal the windows that the device
    /// will compute.
    pub fn set(&mut self, time: Morph) -> impl Iterator<Item = Vec<i32>> {
        self.is_due |= time != self.morph;
        self.morph = time;
        let [from, to] = &self.ends;
        from.iter().zip(to).map(move |(from, to)| morph(from, to, time.fixed_time()))
    }

    /// Makes the next frame compute the blend again, because the device may have missed the last recording.
    pub fn refresh(&mut self) {
        self.is_due = true;
    }

    /// Stages the time of the blend, if the device must compute the blend.
    pub fn stage(&self, staged: &mut Staged) -> Result<(), Error> {
        if self.is_due { self.blend.stage(staged, self.morph) } else { Ok(()) }
    }

    /// Records the computation of the blend, if the device must compute the blend.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if std::mem::take(&mut self.is_due) {
            self.blend.record(encoder);
        }
    }
}

async fn read(gpu: &Gpu, parts: &[Fields]) -> Result<Vec<Vec<i32>>, Error> {
    let mut windows = Vec::new();
    for part in parts {
        windows.extend(part.read(gpu).await?);
    }
    Ok(windows)
}
