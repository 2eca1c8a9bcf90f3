// A bit for each slot of each instance: those that are sampled; then likewise, those of them that are sampled ahead.
@group(0) @binding(14) var<storage, read_write> bits: array<u32>;
