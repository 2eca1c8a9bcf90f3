//! Pipelines that were compiled on a device, for every pass that asks for the same one again.

use std::collections::HashMap;
use std::sync::Mutex;

use super::GpuError;

/// Compiled things by what they were compiled from.
#[derive(Debug)]
pub(crate) struct Shared<T>(Mutex<HashMap<String, T>>);

impl<T> Default for Shared<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T: Clone> Shared<T> {
    /// What was compiled for `key` before, else what `compile` gives.
    ///
    /// # Errors
    /// Those of `compile`, which is tried again next time.
    pub(crate) fn get(
        &self,
        key: String,
        compile: impl FnOnce() -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let all = || self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(known) = all().get(&key) {
            return Ok(known.clone());
        }
        // Not locked meanwhile: drivers take seconds, and two threads may compile different ones.
        let compiled = compile()?;
        Ok(all().entry(key).or_insert(compiled).clone())
    }
}

#[cfg(test)]
mod tests {
    use crate::gpu::{Gpu, Kernel, Options, shaders};

    #[test]
    fn a_device_compiles_a_pipeline_once() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let height = |gpu: &Gpu, rows| {
            Kernel::new(gpu, &shaders::TERRAIN_HEIGHT, &[("CELL_ROWS", rows)]).expect("compiled").pipeline
        };
        let first = height(&gpu, 2.0);
        assert!(height(&gpu, 2.0) == first && height(&gpu.clone(), 2.0) == first);
        assert!(height(&gpu, 3.0) != first, "other constants, another pipeline");
    }
}
