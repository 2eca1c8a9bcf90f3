//! A cache of the pipelines compiled on a device, which all passes share.

use std::collections::HashMap;
use std::sync::Mutex;

use super::GpuError;

/// Compiled objects by the key from which they were compiled.
#[derive(Debug)]
pub(crate) struct Shared<T>(Mutex<HashMap<String, T>>);

impl<T> Default for Shared<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T: Clone> Shared<T> {
    /// The object that was compiled for `key` before, or else the result of `compile`.
    ///
    /// # Errors
    /// Errors of `compile`, which is tried again at the next call.
    pub fn get(&self, key: String, compile: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
        let all = || self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(known) = all().get(&key) {
            return Ok(known.clone());
        }
        // The map is not locked during compilation: drivers take seconds, and two threads may compile different
        // objects.
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
