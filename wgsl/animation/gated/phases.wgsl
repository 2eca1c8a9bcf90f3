import package::wgsl::animation::gating::Phase;

// One an instance.
@group(0) @binding(8) var<storage, read_write> phases: array<Phase>;
