import package::wgsl::animation::gate_state::Lod;

// One per instance.
@group(0) @binding(5) var<storage, read> lods: array<Lod>;
