// Which influences of an instance count, and which vertices.
struct InstanceLod {
    // The λ of `fade`: 0 is full quality, 1 rigid.
    fade: f32,
    // The k of `truncate`, the most influences, at least 1; 0 of instances that are not seen, which are not skinned.
    most: u32,
    // The character's level of detail: 0 is its meshes themselves; at level n each has the coarsest of `Mesh::levels` that
    // is off by no more than the n-th of `level_errors`. Of one that there is not, the last.
    level: u32,
}
