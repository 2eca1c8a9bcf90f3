// How an instance is skinned.
struct InstanceLod {
    // 0 is full quality, 1 rigid.
    fade: f32,
    // The most influences; 0 where it is not seen, and not skinned.
    most: u32,
    // Of detail: 0 is the mesh itself; of one that it lacks, its last.
    level: u32,
}
