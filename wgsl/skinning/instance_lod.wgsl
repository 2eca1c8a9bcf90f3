// The level of detail of one instance: its influences and its vertices.
struct InstanceLod {
    // Influence fade, the λ of `fade`: 0 is full quality, 1 is rigid.
    influence_fade: f32,
    // Largest number of influences, the k of `truncate`, at least 1. 0: the instance is not visible and is not skinned.
    max_influences: u32,
    // The character's level of detail. Level 0 is the meshes themselves. At level n, each mesh uses the coarsest of its
    // `Mesh::levels` whose error is at most the n-th of `level_errors`. Numbers beyond the last level count as the last.
    mesh_lod: u32,
}

// The largest number of levels of detail of a mesh, the mesh itself included.
const MAX_LEVELS: u32 = 16u;
