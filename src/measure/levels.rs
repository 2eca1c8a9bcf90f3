//! The levels of detail of a crowd's meshes.

use serde::Serialize;

use crate::InputError;
use crate::asset::{Mesh, Model};
use crate::skinning::{MeshLevels, add_levels, level_errors, own_levels};

/// A model whose meshes have levels of detail.
pub(crate) struct Levelled {
    pub model: Model,
    /// The levels of each mesh.
    pub levels: Vec<MeshLevels>,
    /// The largest error over all meshes at levels 1, 2 … of an instance, in metres.
    pub errors: Vec<f32>,
    /// For each mesh, its own level at each level of an instance.
    pub own: Vec<Vec<u32>>,
}

impl Levelled {
    /// Makes levels for one of a model's clips, whose error is measured in `poses` poses.
    pub(crate) fn new(model: &Model, clip: usize, poses: usize) -> Result<Self, InputError> {
        let mut model = model.clone();
        let levels = add_levels(&mut model, &[clip], poses)?;
        let errors = level_errors(&model.meshes);
        let own = model.meshes.iter().map(|mesh| own_levels(mesh, &errors)).collect();
        Ok(Self { model, levels, errors, own })
    }
}

/// A level of detail of a mesh that instances use.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LevelReport {
    /// Number of triangles of the level.
    pub triangles: usize,
    /// Number of vertices of the level.
    pub vertices: usize,
    /// The largest distance between the level and the mesh, in metres of the model.
    pub error_metres: f32,
    /// The distance from which on the level is used, in units.
    pub from: f32,
}

impl LevelReport {
    /// Reports the levels of a mesh that are used. `own` holds the mesh's level at each level of an instance,
    /// and `begins` the distances in metres from which on instances have levels 1, 2 ….
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
