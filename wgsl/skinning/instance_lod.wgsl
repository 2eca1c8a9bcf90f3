// How an instance is skinned: its influences and its level of detail.
struct InstanceLod {
    // Fade of the influences: 0 is full quality, 1 is rigid.
    influence_fade: f32,
    // The largest number of influences; 0 for an instance that is not seen and not skinned.
    max_influences: u32,
    // Level of detail: 0 is the mesh itself. A number beyond the last level means the last level.
    mesh_lod: u32,
}
