//! Readback of the model matrices of chosen bones, for host code that needs a hand or a head and not the whole
//! crowd.

use super::crowd::Crowd;
use crate::asset::transform::Affine;
use crate::gpu::{Buffer, Gpu, GpuError};
use crate::{Error, InputError};

/// Bones of instances whose model matrices are copied to the host.
///
/// This uses copies and not a kernel: a hundred bones are a hundred copies of 48 bytes, or one copy for
/// adjacent bones, and nothing is bound or compiled. To read most of a crowd, read its buffer instead.
#[derive(Debug, Clone)]
pub struct ChosenBones {
    model_matrices: Buffer<Affine>,
    gathered: Buffer<Affine>,
    // The first matrix in the crowd, the first one here, and their number.
    runs: Vec<[usize; 3]>,
    chosen: usize,
    bones: usize,
}

impl ChosenBones {
    /// Chooses pairs of instance and bone, in any order; pairs may repeat.
    ///
    /// # Errors
    /// [`InputError`] for instances and bones that the crowd does not have; [`GpuError`].
    pub fn new(gpu: &Gpu, crowd: &Crowd, chosen: &[[u32; 2]]) -> Result<Self, Error> {
        let gathered = Buffer::new(gpu, "chosen bones", chosen.len())?;
        let (runs, model_matrices) =
            (Vec::with_capacity(chosen.len()), crowd.model_matrices.buffer().clone());
        let mut bones = Self { model_matrices, gathered, runs, chosen: 0, bones: crowd.bones };
        bones.choose(chosen)?;
        Ok(bones)
    }

    /// Chooses other pairs, at most as many as at first, without allocation. If they are refused, the choice
    /// stays.
    ///
    /// # Errors
    /// [`InputError`] for more pairs, and for instances and bones that the crowd does not have.
    pub fn choose(&mut self, chosen: &[[u32; 2]]) -> Result<(), InputError> {
        if chosen.len() > self.gathered.len() {
            let bound = format!("must be at most {}, as many as at first", self.gathered.len());
            return Err(InputError::new("chosen.len", chosen.len(), bound));
        }
        let limits = [("instance", self.model_matrices.len() / self.bones), ("bone", self.bones)];
        for (at, pair) in chosen.iter().enumerate() {
            for (value, (field, limit)) in pair.iter().zip(limits) {
                if *value as usize >= limit {
                    let bound = format!("must be below {limit}");
                    return Err(InputError::new(format!("chosen[{at}].{field}"), value, bound));
                }
            }
        }
        self.runs.clear();
        self.chosen = chosen.len();
        for (at, [instance, bone]) in chosen.iter().enumerate() {
            let there = *instance as usize * self.bones + *bone as usize;
            match self.runs.last_mut() {
                Some([first, _, count]) if *first + *count == there => *count += 1,
                _ => self.runs.push([there, at, 1]),
            }
        }
        Ok(())
    }

    /// Records the copies. Call it after concatenation.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        let bytes = |matrices: usize| (matrices * size_of::<Affine>()) as u64;
        for [there, here, count] in self.runs.iter().map(|run| run.map(bytes)) {
            encoder.copy_buffer_to_buffer(self.model_matrices.raw(), there, self.gathered.raw(), here, count);
        }
    }

    /// The matrices of the last submitted copies, in the order of the choice; see [`Buffer::read`].
    ///
    /// # Errors
    /// Errors of the device.
    pub async fn read(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.gathered.read(gpu).await.map(|all| self.used(all))
    }

    /// As [`ChosenBones::read`], but blocks; see [`Buffer::read_blocking`].
    ///
    /// # Errors
    /// Errors of the device, or [`GpuError::Hung`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_blocking(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.gathered.read_blocking(gpu).map(|all| self.used(all))
    }

    fn used(&self, mut all: Vec<Affine>) -> Vec<Affine> {
        all.truncate(self.chosen);
        all
    }
}
