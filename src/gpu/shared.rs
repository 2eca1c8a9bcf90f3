//! Caches of the pipelines that were compiled on a device. All passes and renderers share them.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::Mutex;

use super::GpuError;
use super::shaders::Shader;

/// Compiled pipelines, by the key from which each was compiled.
#[derive(Debug)]
pub(crate) struct Shared<K, T>(Mutex<HashMap<K, T>>);

impl<K, T> Default for Shared<K, T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Eq + Hash, T: Clone> Shared<K, T> {
    /// Returns the pipeline that was compiled for `key` before; if there is none, compiles it.
    ///
    /// # Errors
    /// The errors of `compile`. The next call then tries again.
    pub(crate) fn get(&self, key: K, compile: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
        let all = || self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(known) = all().get(&key) {
            return Ok(known.clone());
        }
        // The map is unlocked during compilation, which can take seconds. Two threads may then compile at the same time.
        let compiled = compile()?;
        Ok(all().entry(key).or_insert(compiled).clone())
    }
}

/// Key of a pipeline: a shader and its override constants.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Program {
    /// Unique name of the shader.
    shader: &'static str,
    /// Name of each override constant, and the bits of its value.
    constants: Vec<(&'static str, u64)>,
}

impl Program {
    pub fn new(shader: &'static Shader, constants: &[(&'static str, f64)]) -> Self {
        let constants = constants.iter().map(|(name, value)| (*name, value.to_bits())).collect();
        Self { shader: shader.name, constants }
    }
}

/// Key of a render pipeline: everything from which it is compiled, except the layouts, which depend on the shader alone.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct RenderProgram {
    /// Unique name of the shader.
    pub shader: String,
    /// Entry points. The fragment stage is `None` if only depth is written and nothing is cut out.
    pub vertex: String,
    pub fragment: Option<String>,
    /// Name of each override constant, and the bits of its value.
    pub constants: Vec<(&'static str, u64)>,
    /// The side of triangles that is culled; `None` if both sides are drawn.
    pub cull: Option<wgpu::Face>,
    pub targets: Vec<Option<wgpu::ColorTargetState>>,
    pub depth: Option<wgpu::DepthStencilState>,
    /// Number of samples per pixel.
    pub samples: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::bindings::terrain::height::{Constants, kernel};
    use crate::gpu::{Gpu, Options, shaders};

    #[test]
    fn a_device_compiles_a_pipeline_once() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let height = |gpu: &Gpu, distribution| {
            kernel(gpu, &Constants { distribution, ..Constants::default() }).expect("compiled").pipeline
        };
        let first = height(&gpu, 2);
        assert!(height(&gpu, 2) == first && height(&gpu.clone(), 2) == first);
        assert!(height(&gpu, 1) != first, "other constants, another pipeline");
    }

    #[test]
    fn programs_differ_by_shader_and_bits() {
        let program = |value| Program::new(&shaders::TERRAIN_HEIGHT, &[("DISTRIBUTION", value)]);
        assert_eq!(program(2.0), program(2.0));
        assert_ne!(program(0.0), program(-0.0));
        assert_ne!(program(2.0), Program::new(&shaders::TERRAIN_MORPH, &[("DISTRIBUTION", 2.0)]));
        assert_ne!(program(2.0), Program::new(&shaders::TERRAIN_HEIGHT, &[]));
    }
}
