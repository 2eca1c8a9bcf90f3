//! The levels of detail of a crowd's meshes.

use serde::Serialize;

use crate::InputError;
use crate::asset::{Mesh, Model};
use crate::skinning::{MeshLevels, add_levels, level_errors, own_levels};

/// A model whose meshes have levels.
pub(crate) struct Levelled {
    pub model: Model,
    /// One a mesh.
    pub levels: Vec<MeshLevels>,
    /// How far all of it may be off at levels 1, 2 … of an instance.
    pub errors: Vec<f32>,
    /// Of each mesh, for each level of an instance its own.
    pub own: Vec<Vec<u32>>,
}

impl Levelled {
    /// For one of a model's clips, looked at in so many poses.
    pub(crate) fn new(model: &Model, clip: usize, poses: usize) -> Result<Self, InputError> {
        let mut model = model.clone();
        let levels = add_levels(&mut model, &[clip], poses)?;
        let errors = level_errors(&model.meshes);
        let own = model.meshes.iter().map(|mesh| own_levels(mesh, &errors)).collect();
        Ok(Self { model, levels, errors, own })
    }
}

/// A level of detail of a mesh that instances have.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LevelReport {
    /// How many it has.
    pub triangles: usize,
    /// How many they have.
    pub vertices: usize,
    /// How far it may be off the mesh, in the model's metres.
    pub error_metres: f32,
    /// Units from which on it is used.
    pub from: f32,
}

impl LevelReport {
    /// Of a mesh's levels that are used: `own` has the mesh's level at each of an instance, and `begins` the metres from
    /// which on instances have levels 1, 2 ….
    pub(crate) fn of_mesh(mesh: &Mesh, own: &[u32], begins: &[f32], metres_a_unit: f32) -> Vec<Self> {
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
