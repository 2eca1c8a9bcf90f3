//! `--mesh`: the levels of detail of a crowd's meshes.

use std::fmt;

use relievo::InputError;
#[cfg(feature = "gpu")]
use relievo::asset::{Mesh, Model};
use relievo::skinning::{MeshLevels, add_levels, level_errors, own_levels};

use super::skinning::bounded;
#[cfg(feature = "gpu")]
use crate::progress::during;

/// Which triangles of its meshes a crowd has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Triangles {
    All,
    /// As few as it takes for no surface to be more than so many pixels off.
    Bounded(f32),
}

impl Triangles {
    /// From the command line.
    pub fn new(text: &str) -> Result<Self, InputError> {
        match bounded("mesh", text) {
            Some(pixels) => Ok(Self::Bounded(pixels?)),
            None if text == "full" => Ok(Self::All),
            None => Err(InputError::new("mesh", text, "must be full or bounded:PIXELS")),
        }
    }
}

impl fmt::Display for Triangles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("full"),
            Self::Bounded(pixels) => write!(f, "bounded:{pixels}"),
        }
    }
}

/// A model whose meshes have levels.
#[cfg(feature = "gpu")]
pub struct Levelled {
    pub model: Model,
    /// One a mesh.
    pub levels: Vec<MeshLevels>,
    /// How far all of it may be off at levels 1, 2 … of an instance.
    pub errors: Vec<f32>,
    /// Of each mesh, for each level of an instance its own.
    pub own: Vec<Vec<u32>>,
}

#[cfg(feature = "gpu")]
impl Levelled {
    /// For one of a model's clips, looked at in so many poses.
    pub fn new(model: &Model, clip: usize, poses: usize) -> Result<Self, InputError> {
        let mut model = model.clone();
        let levels = during("simplifying", || add_levels(&mut model, &[clip], poses))?;
        let errors = level_errors(&model.meshes);
        let own = model.meshes.iter().map(|mesh| own_levels(mesh, &errors)).collect();
        Ok(Self { model, levels, errors, own })
    }
}

/// What `scene.json` says of a level.
#[cfg(feature = "gpu")]
#[derive(serde::Serialize)]
pub struct LevelReport {
    triangles: usize,
    vertices: usize,
    error_metres: f32,
    /// Units from which on it is used.
    from: f32,
}

#[cfg(feature = "gpu")]
impl LevelReport {
    /// Of a mesh's levels that are used: `own` has the mesh's level at each of an instance, and `begins` the metres from
    /// which on instances have levels 1, 2 ….
    pub fn of_mesh(mesh: &Mesh, own: &[u32], begins: &[f32], metres_a_unit: f32) -> Vec<Self> {
        let used = own.windows(2).zip(begins).filter(|(pair, _)| pair[0] < pair[1]);
        let report = |(pair, begin): (&[u32], &f32)| {
            let level = &mesh.levels[pair[1] as usize - 1];
            let mut vertices = level.indices.clone();
            vertices.sort_unstable();
            vertices.dedup();
            Self {
                triangles: level.indices.len() / 3,
                vertices: vertices.len(),
                error_metres: level.error,
                from: begin / metres_a_unit,
            }
        };
        used.map(report).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for name in ["full", "bounded:0.25"] {
            assert_eq!(Triangles::new(name).expect("valid").to_string(), name);
        }
        for name in ["", "bounded", "bounded:-1", "bounded:NaN", "half", "full:1"] {
            assert_eq!(Triangles::new(name).expect_err("refused").path, "mesh", "{name}");
        }
    }
}
