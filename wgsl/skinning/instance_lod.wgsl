// Level of detail of one instance in skinning: the influences per vertex, and the mesh level.
struct InstanceLod {
    // Fraction by which weak bone influences are faded out: 0 is full quality, 1 is rigid (one bone per vertex). Also called λ;
    // see `fade`.
    influence_fade: f32,
    // Largest number of influences per vertex, at least 1. Also called k; see `truncate`. 0 means that the instance is
    // invisible and is not skinned.
    max_influences: u32,
    // Level of detail of the character's meshes. At level 0, the meshes themselves are drawn. At level n, each mesh uses the
    // coarsest of its `Mesh::levels` whose error is at most the n-th of `level_errors`. Larger values than the last level count
    // as the last level.
    mesh_lod: u32,
    // Tier of the skeleton that vertices follow; 0 is the whole skeleton.
    tier: u32,
}

// Largest number of levels of detail of a mesh, the mesh itself included.
const MAX_LEVELS: u32 = 16u;
