// The level of detail of one instance: its influences and its vertices.
struct InstanceLod {
    // The λ of `fade`: 0 is full quality, 1 is rigid.
    influence_fade: f32,
    // The k of `truncate`, the largest number of influences, at least 1; 0 for an instance that is not seen, which is not
    // skinned.
    max_influences: u32,
    // The character's level of detail. Level 0 stands for the meshes themselves; at level n each mesh uses the coarsest of
    // its `Mesh::levels` whose error is at most the n-th of `level_errors`. A number beyond the last level means the last.
    mesh_lod: u32,
}

// The most levels of detail of a mesh, itself included.
const MAX_LEVELS: u32 = 16u;
