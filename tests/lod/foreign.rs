//! Levels of detail that another program makes: meshoptimizer simplifies models at rest.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use relievo::asset::{Influences, Mesh, Model};
use relievo::ops::skinning::join_levels;
use relievo_samples::{creature, rock};

/// A model with about this share of its triangles, and only the vertices that these use.
pub fn simplified(model: &Model, share: f32) -> Model {
    let meshes = model.meshes.iter().map(|mesh| {
        let bytes: Vec<u8> = mesh.positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        let vertices = meshopt::VertexDataAdapter::new(&bytes, 12, 0).expect("positions");
        let count = (share * mesh.indices.len() as f32) as usize;
        let none = meshopt::SimplifyOptions::None;
        with_triangles(model, mesh, &meshopt::simplify(&mesh.indices, &vertices, count, 1.0, none, None))
    });
    Model { meshes: meshes.collect(), ..model.clone() }
}

/// A mesh with other triangles, and only the vertices that these use, in a new order.
fn with_triangles(model: &Model, mesh: &Mesh, indices: &[u32]) -> Mesh {
    let (mut places, mut kept) = (HashMap::new(), Vec::new());
    let place = |vertex: &u32| {
        *places.entry(*vertex).or_insert_with(|| {
            kept.push(*vertex as usize);
            kept.len() as u32 - 1
        })
    };
    let indices = indices.iter().map(place).collect();
    let influences = kept.iter().map(|vertex| mesh.influences.of(*vertex).to_vec());
    let bones = model.skins[mesh.skin].bones.len();
    Mesh {
        indices,
        positions: kept.iter().map(|vertex| mesh.positions[*vertex]).collect(),
        normals: kept.iter().map(|vertex| mesh.normals[*vertex]).collect(),
        tangents: kept.iter().map(|vertex| mesh.tangents[*vertex]).collect(),
        uv: kept.iter().map(|vertex| mesh.uv[*vertex]).collect(),
        influences: Influences::new("weights", bones, influences).expect("valid"),
        ..mesh.clone()
    }
}

/// A model and its levels with these shares of the triangles.
pub fn levels_of(model: Model, shares: &[f32]) -> Vec<Model> {
    let coarse: Vec<Model> = shares.iter().map(|share| simplified(&model, *share)).collect();
    [vec![model], coarse].concat()
}

/// Shares of the triangles that levels 1, 2, 3 keep.
pub const SHARES: [f32; 3] = [0.5, 0.15, 0.04];

/// The creature with its walk alone.
pub fn walker() -> Model {
    let mut creature = creature().expect("valid");
    creature.clips.truncate(1);
    creature
}

/// The creature in its walk, and three levels that meshoptimizer made.
pub fn joined_creature() -> Model {
    join_levels(&levels_of(walker(), &SHARES)).expect("joined")
}

/// The rock, and three levels that meshoptimizer made.
pub fn joined_rock() -> Model {
    join_levels(&levels_of(rock().expect("valid"), &SHARES)).expect("joined")
}

/// Files that are the levels of one model, the finest first, from the variable `RELIEVO_LEVELS`, such as
/// `near.glb:far.glb`.
pub fn files() -> Vec<PathBuf> {
    let files = std::env::var_os("RELIEVO_LEVELS").expect("RELIEVO_LEVELS names files");
    std::env::split_paths(&files).collect()
}

/// Reads the finest level of each file.
pub fn read(files: &[PathBuf]) -> Vec<Model> {
    let read = |path: &PathBuf| Model::from_file(Path::new(path)).expect("a model");
    files.iter().map(read).collect()
}
