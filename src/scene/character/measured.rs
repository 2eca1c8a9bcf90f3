//! A character's device data after a frame, read back for measurements.

use super::Character;
use crate::Error;
use crate::asset::Affine;
use crate::gpu::Gpu;
use crate::skinning::vertex::Vertex;

impl Character {
    /// The model matrices of the whole skeletons of all instances after the last frame, and the number of bones of each. Those of an
    /// instance with a reduced skeleton are outdated.
    pub fn read_matrices(&self, gpu: &Gpu) -> Result<(Vec<Affine>, usize), Error> {
        let (stride, bones) = (self.shared.tiers.skeleton.len(), self.merged.model.skeleton.len());
        let mut all = Vec::with_capacity(bones * self.plays.len());
        for runtime in &self.runtimes {
            let found = runtime.frame.model_matrices().read_blocking(gpu)?;
            let of_instances = found.chunks_exact(stride).take(runtime.slots.len());
            of_instances.for_each(|matrices| all.extend_from_slice(&matrices[..bones]));
        }
        Ok((all, bones))
    }

    /// The skinned vertices of the instances in `indices`, read back from the device. The result has one list per instance,
    /// with the vertices of each mesh; `None` for a vertex without a page.
    pub fn skinned(&self, gpu: &Gpu, indices: &[u32]) -> Result<Vec<Vec<Vec<Option<Vertex>>>>, Error> {
        let mut all: Vec<Vec<Vec<Option<Vertex>>>> = vec![Vec::new(); indices.len()];
        for runtime in &self.runtimes {
            let own = (0..indices.len()).filter(|at| runtime.slots.contains(&(indices[*at] as usize)));
            let own: Vec<usize> = own.collect();
            let slots = own.iter().map(|at| indices[*at] as usize - runtime.slots.start);
            let slots: Vec<usize> = slots.collect();
            for skin in runtime.skins.iter().filter(|_| !own.is_empty()) {
                for (at, vertices) in own.iter().zip(skin.read_each(gpu, &slots)?) {
                    all[*at].push(vertices);
                }
            }
        }
        Ok(all)
    }
}
