// One bit per slot of each instance: the bones that are sampled; then, in the same layout, those of them that
// are sampled ahead; and those whose model matrices this frame updates.
@group(0) @binding(14) var<storage, read_write> bits: array<u32>;
