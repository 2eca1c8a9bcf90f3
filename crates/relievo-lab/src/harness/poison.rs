//! Outputs that are filled with a poison value before a kernel runs. They show what the kernel forgets to
//! write, and what it writes beyond the end.

use relievo::gpu::{Buffer, Gpu, GpuError};

use crate::harness::compare::Comparison;

/// The poison value of every word.
pub const POISON: u32 = 0xdead_beef;

/// Elements of the guard beyond the end.
const GUARD: usize = 64;

/// A poisoned output of `len` elements, followed by a guard.
#[derive(Debug, Clone)]
pub struct Poisoned<T> {
    /// The buffer, guard included.
    pub buffer: Buffer<T>,
    len: usize,
}

impl<T: bytemuck::Pod> Poisoned<T> {
    /// Creates a poisoned buffer.
    ///
    /// # Errors
    /// What the device reports.
    pub fn new(gpu: &Gpu, len: usize) -> Result<Self, GpuError> {
        let buffer = Buffer::new(gpu, "poisoned", len + GUARD)?;
        let poisoned = Self { buffer, len };
        poisoned.poison(gpu)?;
        Ok(poisoned)
    }

    /// Poisons every word again.
    ///
    /// # Errors
    /// What the device reports.
    pub(crate) fn poison(&self, gpu: &Gpu) -> Result<(), GpuError> {
        let words = vec![POISON; (self.len + GUARD) * size_of::<T>() / 4];
        self.buffer.write(gpu, bytemuck::cast_slice(&words))
    }

    /// Compares the output with `compare`. A changed guard is a fault too.
    ///
    /// # Errors
    /// What the device reports.
    pub async fn check(
        &self,
        gpu: &Gpu,
        compare: impl FnOnce(&[T]) -> Comparison,
    ) -> Result<Comparison, GpuError> {
        let all = self.buffer.read(gpu).await?;
        let (output, guard) = all.split_at(self.len);
        let touched = bytemuck::cast_slice::<T, u32>(guard).iter().position(|word| *word != POISON);
        Ok(match touched {
            Some(word) => {
                Comparison::failed(self.len, format!("word {word} beyond the output's end was written"))
            }
            None => compare(output),
        })
    }
}
