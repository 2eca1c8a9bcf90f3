import package::wgsl::animation::gating::Lod;

// One an instance.
@group(0) @binding(5) var<storage, read> lods: array<Lod>;
