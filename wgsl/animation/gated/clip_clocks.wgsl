import package::wgsl::animation::gate_state::ClipClock;

// One per instance.
@group(0) @binding(8) var<storage, read_write> clip_clocks: array<ClipClock>;
