//! Matrices of chosen bones on the host: gameplay needs a hand or a head, not the crowd.

use super::crowd::Crowd;
use crate::asset::transform::Affine;
use crate::gpu::{Buffer, Gpu, GpuError};
use crate::{Error, InputError};

/// Bones of instances whose matrices come back.
///
/// Copies, not a kernel: a hundred bones are a hundred copies of 48 bytes, of bones beside each other one, and nothing
/// is bound or compiled. Who wants most of a crowd reads its buffer.
#[derive(Debug, Clone)]
pub struct ChosenBones {
    model_matrices: Buffer<Affine>,
    gathered: Buffer<Affine>,
    // First matrix there, first here, how many.
    runs: Vec<[usize; 3]>,
    chosen: usize,
    bones: usize,
}

impl ChosenBones {
    /// Chooses pairs of instance and bone; more than once, and in any order.
    ///
    /// # Errors
    /// [`InputError`] for instances and bones that the crowd lacks; [`GpuError`].
    pub fn new(gpu: &Gpu, crowd: &Crowd, chosen: &[[u32; 2]]) -> Result<Self, Error> {
        let gathered = Buffer::new(gpu, "chosen bones", chosen.len())?;
        let (runs, model_matrices) =
            (Vec::with_capacity(chosen.len()), crowd.model_matrices.buffer().clone());
        let mut bones = Self { model_matrices, gathered, runs, chosen: 0, bones: crowd.bones };
        bones.choose(chosen)?;
        Ok(bones)
    }

    /// Chooses others, at most as many as at first; no allocation. A refused choice changes nothing.
    ///
    /// # Errors
    /// [`InputError`] for more of them, and for instances and bones that the crowd lacks.
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

    /// Records the copies: after concatenation.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        let bytes = |matrices: usize| (matrices * size_of::<Affine>()) as u64;
        for [there, here, count] in self.runs.iter().map(|run| run.map(bytes)) {
            encoder.copy_buffer_to_buffer(self.model_matrices.raw(), there, self.gathered.raw(), here, count);
        }
    }

    /// The matrices of the last submitted copies, in the order of the choice: see [`Buffer::read`].
    ///
    /// # Errors
    /// Whatever the device reports.
    pub async fn read(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.gathered.read(gpu).await.map(|all| self.used(all))
    }

    /// [`ChosenBones::read`], blocking: see [`Buffer::read_blocking`].
    ///
    /// # Errors
    /// Whatever the device reports, or [`GpuError::Hung`].
    pub fn read_blocking(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.gathered.read_blocking(gpu).map(|all| self.used(all))
    }

    fn used(&self, mut all: Vec<Affine>) -> Vec<Affine> {
        all.truncate(self.chosen);
        all
    }
}
