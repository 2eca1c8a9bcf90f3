/// `animation/bounds`
pub static ANIMATION_BOUNDS: Shader = Shader {
    name: "animation/bounds",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_bounds.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "BoundsParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "model_matrices", kind: BindingKind::StorageRead, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "bone_radii", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "bounds", kind: BindingKind::StorageReadWrite, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "BoundsParams", size: 8, members: &[Member { name: "instances", offset: 0, ty: "u32" }, Member { name: "bones", offset: 4, ty: "u32" }] },
    ],
};
/// `animation/budget`
pub static ANIMATION_BUDGET: Shader = Shader {
    name: "animation/budget",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_budget.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "BudgetParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "lods", kind: BindingKind::StorageRead, ty: "array<Lod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "clip_clocks", kind: BindingKind::StorageRead, ty: "array<ClipClock>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "animated_bones", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "table", kind: BindingKind::StorageRead, ty: "array<vec2<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "sampled", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "bits", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "ranks", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "tally", kind: BindingKind::StorageReadWrite, ty: "array<atomic<u32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "STAGE", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "Lod", size: 16, members: &[Member { name: "omega", offset: 0, ty: "u32" }, Member { name: "allowed", offset: 4, ty: "u32" }, Member { name: "weight", offset: 8, ty: "u32" }, Member { name: "flags", offset: 12, ty: "u32" }] },
        Struct { name: "ClipClock", size: 20, members: &[Member { name: "row", offset: 0, ty: "u32" }, Member { name: "fraction_and_reason", offset: 4, ty: "u32" }, Member { name: "clip", offset: 8, ty: "u32" }, Member { name: "ahead_row", offset: 12, ty: "u32" }, Member { name: "ahead_fraction", offset: 16, ty: "u32" }] },
        Struct { name: "BudgetParams", size: 28, members: &[Member { name: "instances", offset: 0, ty: "u32" }, Member { name: "bones", offset: 4, ty: "u32" }, Member { name: "words", offset: 8, ty: "u32" }, Member { name: "stride", offset: 12, ty: "u32" }, Member { name: "budget", offset: 16, ty: "u32" }, Member { name: "clips", offset: 20, ty: "u32" }, Member { name: "tiers", offset: 24, ty: "u32" }] },
        Struct { name: "WordOfBones", size: 40, members: &[Member { name: "instance", offset: 0, ty: "u32" }, Member { name: "slot", offset: 4, ty: "u32" }, Member { name: "candidates", offset: 8, ty: "u32" }, Member { name: "forced", offset: 12, ty: "u32" }, Member { name: "periods", offset: 16, ty: "u32" }, Member { name: "clip_clock", offset: 20, ty: "ClipClock" }] },
    ],
};
/// `animation/clip_clock`
pub static ANIMATION_CLIP_CLOCK: Shader = Shader {
    name: "animation/clip_clock",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_clip_clock.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "ClipClockParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "instances", kind: BindingKind::StorageRead, ty: "array<AnimationInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "clips", kind: BindingKind::StorageRead, ty: "array<ClipEntry>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "timelines", kind: BindingKind::StorageRead, ty: "array<Timeline>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "times", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "lods", kind: BindingKind::StorageRead, ty: "array<Lod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "layer_weights", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "history", kind: BindingKind::StorageReadWrite, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "clip_clocks", kind: BindingKind::StorageReadWrite, ty: "array<ClipClock>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "ClipEntry", size: 16, members: &[Member { name: "first_timeline", offset: 0, ty: "u32" }, Member { name: "timelines", offset: 4, ty: "u32" }, Member { name: "duration", offset: 8, ty: "f32" }, Member { name: "first_row", offset: 12, ty: "u32" }] },
        Struct { name: "Timeline", size: 8, members: &[Member { name: "first_time", offset: 0, ty: "u32" }, Member { name: "keys", offset: 4, ty: "u32" }] },
        Struct { name: "KeyframeCursor", size: 8, members: &[Member { name: "key", offset: 0, ty: "u32" }, Member { name: "fraction", offset: 4, ty: "f32" }] },
        Struct { name: "SetTrack", size: 8, members: &[Member { name: "words", offset: 0, ty: "vec2<u32>" }] },
        Struct { name: "Lod", size: 16, members: &[Member { name: "omega", offset: 0, ty: "u32" }, Member { name: "allowed", offset: 4, ty: "u32" }, Member { name: "weight", offset: 8, ty: "u32" }, Member { name: "flags", offset: 12, ty: "u32" }] },
        Struct { name: "ClipClock", size: 20, members: &[Member { name: "row", offset: 0, ty: "u32" }, Member { name: "fraction_and_reason", offset: 4, ty: "u32" }, Member { name: "clip", offset: 8, ty: "u32" }, Member { name: "ahead_row", offset: 12, ty: "u32" }, Member { name: "ahead_fraction", offset: 16, ty: "u32" }] },
        Struct { name: "AnimationInstance", size: 16, members: &[Member { name: "clip", offset: 0, ty: "u32" }, Member { name: "wrap_code", offset: 4, ty: "u32" }, Member { name: "start", offset: 8, ty: "f32" }, Member { name: "rate", offset: 12, ty: "f32" }] },
        Struct { name: "ClipClockParams", size: 16, members: &[Member { name: "instances", offset: 0, ty: "u32" }, Member { name: "elapsed", offset: 4, ty: "f32" }, Member { name: "layers", offset: 8, ty: "u32" }, Member { name: "ahead", offset: 12, ty: "f32" }] },
    ],
};
/// `animation/compact`
pub static ANIMATION_COMPACT: Shader = Shader {
    name: "animation/compact",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_compact.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "CompactParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "bits", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "slots", kind: BindingKind::StorageRead, ty: "array<Slot>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "updated_bones", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "counts", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "pairs", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "pair_dispatch", kind: BindingKind::StorageReadWrite, ty: "array<vec4<u32>, 1>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "updated_instances", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "instance_dispatches", kind: BindingKind::StorageReadWrite, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "STAGE", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "Lod", size: 16, members: &[Member { name: "omega", offset: 0, ty: "u32" }, Member { name: "allowed", offset: 4, ty: "u32" }, Member { name: "weight", offset: 8, ty: "u32" }, Member { name: "flags", offset: 12, ty: "u32" }] },
        Struct { name: "ClipClock", size: 20, members: &[Member { name: "row", offset: 0, ty: "u32" }, Member { name: "fraction_and_reason", offset: 4, ty: "u32" }, Member { name: "clip", offset: 8, ty: "u32" }, Member { name: "ahead_row", offset: 12, ty: "u32" }, Member { name: "ahead_fraction", offset: 16, ty: "u32" }] },
        Struct { name: "Slot", size: 12, members: &[Member { name: "bone", offset: 0, ty: "u32" }, Member { name: "parent", offset: 4, ty: "u32" }, Member { name: "subtree", offset: 8, ty: "u32" }] },
        Struct { name: "Chain", size: 8, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "count", offset: 4, ty: "u32" }] },
        Struct { name: "CompactParams", size: 20, members: &[Member { name: "instances", offset: 0, ty: "u32" }, Member { name: "bones", offset: 4, ty: "u32" }, Member { name: "words", offset: 8, ty: "u32" }, Member { name: "served", offset: 12, ty: "u32" }, Member { name: "most_groups", offset: 16, ty: "u32" }] },
    ],
};
/// `animation/drive`
pub static ANIMATION_DRIVE: Shader = Shader {
    name: "animation/drive",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_drive.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "DriveParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "driven", kind: BindingKind::StorageRead, ty: "array<DrivenWord>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "lods", kind: BindingKind::StorageRead, ty: "array<Lod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "bits", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "Lod", size: 16, members: &[Member { name: "omega", offset: 0, ty: "u32" }, Member { name: "allowed", offset: 4, ty: "u32" }, Member { name: "weight", offset: 8, ty: "u32" }, Member { name: "flags", offset: 12, ty: "u32" }] },
        Struct { name: "ClipClock", size: 20, members: &[Member { name: "row", offset: 0, ty: "u32" }, Member { name: "fraction_and_reason", offset: 4, ty: "u32" }, Member { name: "clip", offset: 8, ty: "u32" }, Member { name: "ahead_row", offset: 12, ty: "u32" }, Member { name: "ahead_fraction", offset: 16, ty: "u32" }] },
        Struct { name: "DriveParams", size: 12, members: &[Member { name: "driven", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "words", offset: 8, ty: "u32" }] },
        Struct { name: "DrivenWord", size: 8, members: &[Member { name: "at", offset: 0, ty: "u32" }, Member { name: "bones", offset: 4, ty: "u32" }] },
    ],
};
/// `animation/gate`
pub static ANIMATION_GATE: Shader = Shader {
    name: "animation/gate",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_gate.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "GateParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "lods", kind: BindingKind::StorageRead, ty: "array<Lod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "clip_clocks", kind: BindingKind::StorageRead, ty: "array<ClipClock>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "animated_bones", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "table", kind: BindingKind::StorageRead, ty: "array<vec2<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "sampled", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "remaining", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "bits", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "MODE", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "Lod", size: 16, members: &[Member { name: "omega", offset: 0, ty: "u32" }, Member { name: "allowed", offset: 4, ty: "u32" }, Member { name: "weight", offset: 8, ty: "u32" }, Member { name: "flags", offset: 12, ty: "u32" }] },
        Struct { name: "ClipClock", size: 20, members: &[Member { name: "row", offset: 0, ty: "u32" }, Member { name: "fraction_and_reason", offset: 4, ty: "u32" }, Member { name: "clip", offset: 8, ty: "u32" }, Member { name: "ahead_row", offset: 12, ty: "u32" }, Member { name: "ahead_fraction", offset: 16, ty: "u32" }] },
        Struct { name: "Slot", size: 12, members: &[Member { name: "bone", offset: 0, ty: "u32" }, Member { name: "parent", offset: 4, ty: "u32" }, Member { name: "subtree", offset: 8, ty: "u32" }] },
        Struct { name: "Chain", size: 8, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "count", offset: 4, ty: "u32" }] },
        Struct { name: "GateParams", size: 44, members: &[Member { name: "instances", offset: 0, ty: "u32" }, Member { name: "bones", offset: 4, ty: "u32" }, Member { name: "words", offset: 8, ty: "u32" }, Member { name: "stride", offset: 12, ty: "u32" }, Member { name: "ticks", offset: 16, ty: "u32" }, Member { name: "frame_ticks", offset: 20, ty: "u32" }, Member { name: "period", offset: 24, ty: "u32" }, Member { name: "frame", offset: 28, ty: "u32" }, Member { name: "clips", offset: 32, ty: "u32" }, Member { name: "tiers", offset: 36, ty: "u32" }, Member { name: "first_above", offset: 40, ty: "u32" }] },
        Struct { name: "Chosen", size: 8, members: &[Member { name: "bits", offset: 0, ty: "u32" }, Member { name: "ahead", offset: 4, ty: "u32" }] },
        Struct { name: "AccumulatedMotion", size: 28, members: &[Member { name: "allowed", offset: 0, ty: "u32" }, Member { name: "clip_clock", offset: 4, ty: "ClipClock" }, Member { name: "last_row", offset: 24, ty: "u32" }] },
    ],
};
/// `animation/keyframe_cursor`
pub static ANIMATION_KEYFRAME_CURSOR: Shader = Shader {
    name: "animation/keyframe_cursor",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_keyframe_cursor.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "KeyframeCursorParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "instances", kind: BindingKind::StorageRead, ty: "array<AnimationInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "clips", kind: BindingKind::StorageRead, ty: "array<ClipEntry>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "timelines", kind: BindingKind::StorageRead, ty: "array<Timeline>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "times", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "cursors", kind: BindingKind::StorageReadWrite, ty: "array<KeyframeCursor>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "updated_instances", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "dispatches", kind: BindingKind::StorageRead, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "history", kind: BindingKind::StorageRead, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "COMPACTED", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "ClipEntry", size: 16, members: &[Member { name: "first_timeline", offset: 0, ty: "u32" }, Member { name: "timelines", offset: 4, ty: "u32" }, Member { name: "duration", offset: 8, ty: "f32" }, Member { name: "first_row", offset: 12, ty: "u32" }] },
        Struct { name: "Timeline", size: 8, members: &[Member { name: "first_time", offset: 0, ty: "u32" }, Member { name: "keys", offset: 4, ty: "u32" }] },
        Struct { name: "KeyframeCursor", size: 8, members: &[Member { name: "key", offset: 0, ty: "u32" }, Member { name: "fraction", offset: 4, ty: "f32" }] },
        Struct { name: "SetTrack", size: 8, members: &[Member { name: "words", offset: 0, ty: "vec2<u32>" }] },
        Struct { name: "AnimationInstance", size: 16, members: &[Member { name: "clip", offset: 0, ty: "u32" }, Member { name: "wrap_code", offset: 4, ty: "u32" }, Member { name: "start", offset: 8, ty: "f32" }, Member { name: "rate", offset: 12, ty: "f32" }] },
        Struct { name: "KeyframeCursorParams", size: 16, members: &[Member { name: "entries", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "timelines", offset: 8, ty: "u32" }, Member { name: "elapsed", offset: 12, ty: "f32" }] },
    ],
};
/// `animation/local_to_model`
pub static ANIMATION_LOCAL_TO_MODEL: Shader = Shader {
    name: "animation/local_to_model",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_local_to_model.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "LocalToModelParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "slots", kind: BindingKind::StorageRead, ty: "array<Slot>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "chains", kind: BindingKind::StorageRead, ty: "array<Chain>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "updated_bones", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "updated_instances", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "dispatches", kind: BindingKind::StorageRead, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "locals", kind: BindingKind::StorageRead, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "model_matrices", kind: BindingKind::StorageReadWrite, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "COMPACTED", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "Slot", size: 12, members: &[Member { name: "bone", offset: 0, ty: "u32" }, Member { name: "parent", offset: 4, ty: "u32" }, Member { name: "subtree", offset: 8, ty: "u32" }] },
        Struct { name: "Chain", size: 8, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "count", offset: 4, ty: "u32" }] },
        Struct { name: "LocalToModelParams", size: 24, members: &[Member { name: "instances", offset: 0, ty: "u32" }, Member { name: "bones", offset: 4, ty: "u32" }, Member { name: "words", offset: 8, ty: "u32" }, Member { name: "first_chain", offset: 12, ty: "u32" }, Member { name: "chains", offset: 16, ty: "u32" }, Member { name: "first_word", offset: 20, ty: "u32" }] },
        Struct { name: "Rows", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec4<f32>" }, Member { name: "y", offset: 16, ty: "vec4<f32>" }, Member { name: "z", offset: 32, ty: "vec4<f32>" }] },
    ],
};
/// `animation/sample`
pub static ANIMATION_SAMPLE: Shader = Shader {
    name: "animation/sample",
    source: include_str!(concat!(env!("OUT_DIR"), "/animation_sample.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "SampleParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "instances", kind: BindingKind::StorageRead, ty: "array<AnimationInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "tracks", kind: BindingKind::StorageRead, ty: "array<SetTrack>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "values", kind: BindingKind::StorageRead, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "cursors", kind: BindingKind::StorageRead, ty: "array<vec2<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "pairs", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "dispatched", kind: BindingKind::StorageRead, ty: "vec4<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "locals", kind: BindingKind::StorageReadWrite, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "layer_weights", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "COMPACTED", ty: "bool", default: 0.0 },
        Override { name: "LAYERED", ty: "bool", default: 0.0 },
        Override { name: "NLERP", ty: "bool", default: 0.0 },
        Override { name: "SPLINES", ty: "bool", default: 1.0 },
    ],
    structs: &[
        Struct { name: "ClipEntry", size: 16, members: &[Member { name: "first_timeline", offset: 0, ty: "u32" }, Member { name: "timelines", offset: 4, ty: "u32" }, Member { name: "duration", offset: 8, ty: "f32" }, Member { name: "first_row", offset: 12, ty: "u32" }] },
        Struct { name: "Timeline", size: 8, members: &[Member { name: "first_time", offset: 0, ty: "u32" }, Member { name: "keys", offset: 4, ty: "u32" }] },
        Struct { name: "KeyframeCursor", size: 8, members: &[Member { name: "key", offset: 0, ty: "u32" }, Member { name: "fraction", offset: 4, ty: "f32" }] },
        Struct { name: "SetTrack", size: 8, members: &[Member { name: "words", offset: 0, ty: "vec2<u32>" }] },
        Struct { name: "Lod", size: 16, members: &[Member { name: "omega", offset: 0, ty: "u32" }, Member { name: "allowed", offset: 4, ty: "u32" }, Member { name: "weight", offset: 8, ty: "u32" }, Member { name: "flags", offset: 12, ty: "u32" }] },
        Struct { name: "ClipClock", size: 20, members: &[Member { name: "row", offset: 0, ty: "u32" }, Member { name: "fraction_and_reason", offset: 4, ty: "u32" }, Member { name: "clip", offset: 8, ty: "u32" }, Member { name: "ahead_row", offset: 12, ty: "u32" }, Member { name: "ahead_fraction", offset: 16, ty: "u32" }] },
        Struct { name: "AnimationInstance", size: 16, members: &[Member { name: "clip", offset: 0, ty: "u32" }, Member { name: "wrap_code", offset: 4, ty: "u32" }, Member { name: "start", offset: 8, ty: "f32" }, Member { name: "rate", offset: 12, ty: "f32" }] },
        Struct { name: "SampleParams", size: 20, members: &[Member { name: "bones", offset: 0, ty: "u32" }, Member { name: "timelines", offset: 4, ty: "u32" }, Member { name: "pairs", offset: 8, ty: "u32" }, Member { name: "instances", offset: 12, ty: "u32" }, Member { name: "layers", offset: 16, ty: "u32" }] },
        Struct { name: "Between", size: 12, members: &[Member { name: "value", offset: 0, ty: "u32" }, Member { name: "code", offset: 4, ty: "u32" }, Member { name: "fraction", offset: 8, ty: "f32" }] },
        Struct { name: "Local", size: 48, members: &[Member { name: "moved", offset: 0, ty: "vec3<f32>" }, Member { name: "turned", offset: 16, ty: "vec4<f32>" }, Member { name: "scaled", offset: 32, ty: "vec3<f32>" }] },
    ],
};
/// `baseline/copy`
pub static BASELINE_COPY: Shader = Shader {
    name: "baseline/copy",
    source: include_str!(concat!(env!("OUT_DIR"), "/baseline_copy.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "CopyParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "source", kind: BindingKind::StorageRead, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "destination", kind: BindingKind::StorageReadWrite, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "CopyParams", size: 4, members: &[Member { name: "vectors", offset: 0, ty: "u32" }] },
    ],
};
/// `baseline/gather`
pub static BASELINE_GATHER: Shader = Shader {
    name: "baseline/gather",
    source: include_str!(concat!(env!("OUT_DIR"), "/baseline_gather.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "GatherParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "instances", kind: BindingKind::StorageRead, ty: "array<AnimationInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "tracks", kind: BindingKind::StorageRead, ty: "array<SetTrack>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "cursors", kind: BindingKind::StorageRead, ty: "array<vec2<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "values", kind: BindingKind::StorageRead, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "gathered", kind: BindingKind::StorageReadWrite, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "TABLES", ty: "bool", default: 1.0 },
    ],
    structs: &[
        Struct { name: "ClipEntry", size: 16, members: &[Member { name: "first_timeline", offset: 0, ty: "u32" }, Member { name: "timelines", offset: 4, ty: "u32" }, Member { name: "duration", offset: 8, ty: "f32" }, Member { name: "first_row", offset: 12, ty: "u32" }] },
        Struct { name: "Timeline", size: 8, members: &[Member { name: "first_time", offset: 0, ty: "u32" }, Member { name: "keys", offset: 4, ty: "u32" }] },
        Struct { name: "KeyframeCursor", size: 8, members: &[Member { name: "key", offset: 0, ty: "u32" }, Member { name: "fraction", offset: 4, ty: "f32" }] },
        Struct { name: "SetTrack", size: 8, members: &[Member { name: "words", offset: 0, ty: "vec2<u32>" }] },
        Struct { name: "AnimationInstance", size: 16, members: &[Member { name: "clip", offset: 0, ty: "u32" }, Member { name: "wrap_code", offset: 4, ty: "u32" }, Member { name: "start", offset: 8, ty: "f32" }, Member { name: "rate", offset: 12, ty: "f32" }] },
        Struct { name: "GatherParams", size: 12, members: &[Member { name: "pairs", offset: 0, ty: "u32" }, Member { name: "bones", offset: 4, ty: "u32" }, Member { name: "keys", offset: 8, ty: "u32" }] },
    ],
};
/// `baseline/loads`
pub static BASELINE_LOADS: Shader = Shader {
    name: "baseline/loads",
    source: include_str!(concat!(env!("OUT_DIR"), "/baseline_loads.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [8, 8, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "LoadsParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "texels", kind: BindingKind::LoadedTexture, ty: "texture_2d<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "sums", kind: BindingKind::StorageReadWrite, ty: "array<f32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "LoadsParams", size: 16, members: &[Member { name: "threads", offset: 0, ty: "vec2<u32>" }, Member { name: "loads", offset: 8, ty: "u32" }] },
    ],
};
/// `baseline/texels`
pub static BASELINE_TEXELS: Shader = Shader {
    name: "baseline/texels",
    source: include_str!(concat!(env!("OUT_DIR"), "/baseline_texels.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "TexelsParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "windows", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "zones", kind: BindingKind::StorageRead, ty: "array<MapZone>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "texels", kind: BindingKind::StorageRead, ty: "array<vec2<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "places", kind: BindingKind::StorageRead, ty: "array<vec2<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "words", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "Zone", size: 32, members: &[Member { name: "min", offset: 0, ty: "f32" }, Member { name: "max", offset: 4, ty: "f32" }, Member { name: "rise", offset: 8, ty: "vec2<f32>" }, Member { name: "fall", offset: 16, ty: "vec2<f32>" }, Member { name: "height_blend", offset: 24, ty: "f32" }, Member { name: "repeats", offset: 28, ty: "f32" }] },
        Struct { name: "MapZone", size: 40, members: &[Member { name: "zone", offset: 0, ty: "Zone" }, Member { name: "first", offset: 32, ty: "u32" }, Member { name: "edge_log2", offset: 36, ty: "u32" }] },
        Struct { name: "ZoneBlend", size: 48, members: &[Member { name: "color", offset: 0, ty: "vec3<f32>" }, Member { name: "total", offset: 12, ty: "f32" }, Member { name: "weight", offset: 16, ty: "f32" }, Member { name: "nearest", offset: 32, ty: "vec3<f32>" }, Member { name: "distance", offset: 44, ty: "f32" }] },
        Struct { name: "TexelsParams", size: 20, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "zone_count", offset: 4, ty: "u32" }, Member { name: "planes", offset: 8, ty: "u32" }, Member { name: "tiles_per_sample", offset: 12, ty: "u32" }, Member { name: "tiles_per_unit", offset: 16, ty: "u32" }] },
    ],
};
/// `baseline/words`
pub static BASELINE_WORDS: Shader = Shader {
    name: "baseline/words",
    source: include_str!(concat!(env!("OUT_DIR"), "/baseline_words.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "WordsParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "words", kind: BindingKind::StorageReadWrite, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "Words", size: 32, members: &[Member { name: "first", offset: 0, ty: "vec4<u32>" }, Member { name: "second", offset: 16, ty: "vec4<u32>" }] },
        Struct { name: "WordsParams", size: 16, members: &[Member { name: "key", offset: 0, ty: "vec2<u32>" }, Member { name: "vectors", offset: 8, ty: "u32" }, Member { name: "vectors_per_row", offset: 12, ty: "u32" }] },
    ],
};
/// `lod/assign`
pub static LOD_ASSIGN: Shader = Shader {
    name: "lod/assign",
    source: include_str!(concat!(env!("OUT_DIR"), "/lod_assign.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "AssignParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "allowed", kind: BindingKind::StorageRead, ty: "array<Allowed>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "lods", kind: BindingKind::StorageReadWrite, ty: "array<Lod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "instance_lods", kind: BindingKind::StorageReadWrite, ty: "array<InstanceLod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "instances", kind: BindingKind::StorageRead, ty: "array<SceneInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "finest", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "Lod", size: 16, members: &[Member { name: "omega", offset: 0, ty: "u32" }, Member { name: "allowed", offset: 4, ty: "u32" }, Member { name: "weight", offset: 8, ty: "u32" }, Member { name: "flags", offset: 12, ty: "u32" }] },
        Struct { name: "ClipClock", size: 20, members: &[Member { name: "row", offset: 0, ty: "u32" }, Member { name: "fraction_and_reason", offset: 4, ty: "u32" }, Member { name: "clip", offset: 8, ty: "u32" }, Member { name: "ahead_row", offset: 12, ty: "u32" }, Member { name: "ahead_fraction", offset: 16, ty: "u32" }] },
        Struct { name: "Allowed", size: 8, members: &[Member { name: "displacement", offset: 0, ty: "f32" }, Member { name: "distance", offset: 4, ty: "f32" }] },
        Struct { name: "LodCamera", size: 48, members: &[Member { name: "eye", offset: 0, ty: "vec3<f32>" }, Member { name: "focal", offset: 12, ty: "f32" }, Member { name: "ahead", offset: 16, ty: "vec3<f32>" }, Member { name: "pixels", offset: 28, ty: "f32" }, Member { name: "near", offset: 32, ty: "f32" }, Member { name: "perspective", offset: 36, ty: "f32" }, Member { name: "pixel_count", offset: 40, ty: "f32" }, Member { name: "unused", offset: 44, ty: "f32" }] },
        Struct { name: "SceneInstance", size: 80, members: &[Member { name: "cell", offset: 0, ty: "vec3<i32>" }, Member { name: "flags", offset: 12, ty: "u32" }, Member { name: "offset", offset: 16, ty: "vec3<f32>" }, Member { name: "user_data", offset: 28, ty: "u32" }, Member { name: "rotation", offset: 32, ty: "vec4<f32>" }, Member { name: "scale", offset: 48, ty: "vec3<f32>" }, Member { name: "tint", offset: 60, ty: "u32" }, Member { name: "bounding_sphere", offset: 64, ty: "vec4<f32>" }] },
        Struct { name: "Axes", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec3<f32>" }, Member { name: "y", offset: 16, ty: "vec3<f32>" }, Member { name: "z", offset: 32, ty: "vec3<f32>" }] },
        Struct { name: "SelectView", size: 432, members: &[Member { name: "planes", offset: 0, ty: "array<vec4<f32>, 6>" }, Member { name: "cameras", offset: 96, ty: "array<LodCamera, 4>" }, Member { name: "cell", offset: 288, ty: "vec3<i32>" }, Member { name: "mask", offset: 300, ty: "u32" }, Member { name: "camera_count", offset: 304, ty: "u32" }, Member { name: "is_first", offset: 308, ty: "u32" }, Member { name: "casters", offset: 312, ty: "u32" }, Member { name: "blocks", offset: 316, ty: "u32" }, Member { name: "is_next", offset: 320, ty: "u32" }, Member { name: "seconds", offset: 324, ty: "f32" }, Member { name: "unused_a", offset: 328, ty: "u32" }, Member { name: "unused_b", offset: 332, ty: "u32" }, Member { name: "clip_rows", offset: 336, ty: "array<vec4<f32>, 3>" }, Member { name: "last_clip_rows", offset: 384, ty: "array<vec4<f32>, 3>" }] },
        Struct { name: "InstanceLod", size: 16, members: &[Member { name: "influence_fade", offset: 0, ty: "f32" }, Member { name: "max_influences", offset: 4, ty: "u32" }, Member { name: "mesh_lod", offset: 8, ty: "u32" }, Member { name: "tier", offset: 12, ty: "u32" }] },
        Struct { name: "AssignParams", size: 80, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "bone_fraction", offset: 8, ty: "f32" }, Member { name: "influence_fraction", offset: 12, ty: "f32" }, Member { name: "unit", offset: 16, ty: "f32" }, Member { name: "stray", offset: 20, ty: "f32" }, Member { name: "max_influences", offset: 24, ty: "u32" }, Member { name: "omega_start", offset: 28, ty: "f32" }, Member { name: "omega_rate", offset: 32, ty: "f32" }, Member { name: "fade_start", offset: 36, ty: "f32" }, Member { name: "fade_rate", offset: 40, ty: "f32" }, Member { name: "full_weight_allowed", offset: 44, ty: "f32" }, Member { name: "tier_fraction", offset: 48, ty: "f32" }, Member { name: "tier_errors", offset: 64, ty: "vec4<f32>" }] },
    ],
};
/// `lod/attach`
pub static LOD_ATTACH: Shader = Shader {
    name: "lod/attach",
    source: include_str!(concat!(env!("OUT_DIR"), "/lod_attach.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "AttachParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "view", kind: BindingKind::Uniform, ty: "SelectView", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "attachments", kind: BindingKind::StorageRead, ty: "array<Attachment>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "model_matrices", kind: BindingKind::StorageRead, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "instances", kind: BindingKind::StorageRead, ty: "array<SceneInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "allowed", kind: BindingKind::StorageRead, ty: "array<Allowed>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "placements", kind: BindingKind::StorageReadWrite, ty: "array<array<vec4<f32>, 3>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "last_instances", kind: BindingKind::StorageRead, ty: "array<SceneInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "kept", kind: BindingKind::StorageReadWrite, ty: "array<KeptBone>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "Allowed", size: 8, members: &[Member { name: "displacement", offset: 0, ty: "f32" }, Member { name: "distance", offset: 4, ty: "f32" }] },
        Struct { name: "LodCamera", size: 48, members: &[Member { name: "eye", offset: 0, ty: "vec3<f32>" }, Member { name: "focal", offset: 12, ty: "f32" }, Member { name: "ahead", offset: 16, ty: "vec3<f32>" }, Member { name: "pixels", offset: 28, ty: "f32" }, Member { name: "near", offset: 32, ty: "f32" }, Member { name: "perspective", offset: 36, ty: "f32" }, Member { name: "pixel_count", offset: 40, ty: "f32" }, Member { name: "unused", offset: 44, ty: "f32" }] },
        Struct { name: "SceneInstance", size: 80, members: &[Member { name: "cell", offset: 0, ty: "vec3<i32>" }, Member { name: "flags", offset: 12, ty: "u32" }, Member { name: "offset", offset: 16, ty: "vec3<f32>" }, Member { name: "user_data", offset: 28, ty: "u32" }, Member { name: "rotation", offset: 32, ty: "vec4<f32>" }, Member { name: "scale", offset: 48, ty: "vec3<f32>" }, Member { name: "tint", offset: 60, ty: "u32" }, Member { name: "bounding_sphere", offset: 64, ty: "vec4<f32>" }] },
        Struct { name: "Axes", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec3<f32>" }, Member { name: "y", offset: 16, ty: "vec3<f32>" }, Member { name: "z", offset: 32, ty: "vec3<f32>" }] },
        Struct { name: "SelectView", size: 432, members: &[Member { name: "planes", offset: 0, ty: "array<vec4<f32>, 6>" }, Member { name: "cameras", offset: 96, ty: "array<LodCamera, 4>" }, Member { name: "cell", offset: 288, ty: "vec3<i32>" }, Member { name: "mask", offset: 300, ty: "u32" }, Member { name: "camera_count", offset: 304, ty: "u32" }, Member { name: "is_first", offset: 308, ty: "u32" }, Member { name: "casters", offset: 312, ty: "u32" }, Member { name: "blocks", offset: 316, ty: "u32" }, Member { name: "is_next", offset: 320, ty: "u32" }, Member { name: "seconds", offset: 324, ty: "f32" }, Member { name: "unused_a", offset: 328, ty: "u32" }, Member { name: "unused_b", offset: 332, ty: "u32" }, Member { name: "clip_rows", offset: 336, ty: "array<vec4<f32>, 3>" }, Member { name: "last_clip_rows", offset: 384, ty: "array<vec4<f32>, 3>" }] },
        Struct { name: "AttachParams", size: 24, members: &[Member { name: "attached", offset: 0, ty: "u32" }, Member { name: "bones", offset: 4, ty: "u32" }, Member { name: "first", offset: 8, ty: "u32" }, Member { name: "first_last", offset: 12, ty: "u32" }, Member { name: "frame", offset: 16, ty: "u32" }, Member { name: "last_frame", offset: 20, ty: "u32" }] },
        Struct { name: "Attachment", size: 64, members: &[Member { name: "mesh", offset: 0, ty: "u32" }, Member { name: "character", offset: 4, ty: "u32" }, Member { name: "bone", offset: 8, ty: "u32" }, Member { name: "key", offset: 12, ty: "u32" }, Member { name: "offset", offset: 16, ty: "array<vec4<f32>, 3>" }] },
        Struct { name: "KeptBone", size: 64, members: &[Member { name: "rows", offset: 0, ty: "array<vec4<f32>, 3>" }, Member { name: "frame", offset: 48, ty: "u32" }, Member { name: "key", offset: 52, ty: "u32" }, Member { name: "unused_a", offset: 56, ty: "u32" }, Member { name: "unused_b", offset: 60, ty: "u32" }] },
    ],
};
/// `lod/budget`
pub static LOD_BUDGET: Shader = Shader {
    name: "lod/budget",
    source: include_str!(concat!(env!("OUT_DIR"), "/lod_budget.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [256, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "BudgetParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "view", kind: BindingKind::Uniform, ty: "SelectView", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "objects", kind: BindingKind::StorageRead, ty: "array<LodObject>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "block_objects", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "metrics", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "decisions", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "state", kind: BindingKind::StorageReadWrite, ty: "array<BudgetState>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "work", kind: BindingKind::StorageReadWrite, ty: "array<BudgetWork>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "STAGE", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "BudgetState", size: 64, members: &[Member { name: "factors", offset: 0, ty: "array<vec4<f32>, 3>" }, Member { name: "ends_fades", offset: 48, ty: "u32" }, Member { name: "is_missed", offset: 52, ty: "u32" }, Member { name: "triangles", offset: 56, ty: "u32" }, Member { name: "pressure", offset: 60, ty: "u32" }] },
        Struct { name: "LodObject", size: 160, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "levels", offset: 8, ty: "u32" }, Member { name: "first_list", offset: 12, ty: "u32" }, Member { name: "first_draw", offset: 16, ty: "u32" }, Member { name: "parts", offset: 20, ty: "u32" }, Member { name: "metric_scale", offset: 24, ty: "f32" }, Member { name: "flags", offset: 28, ty: "u32" }, Member { name: "thresholds", offset: 32, ty: "array<vec4<f32>, 2>" }, Member { name: "finer", offset: 64, ty: "f32" }, Member { name: "coarser", offset: 68, ty: "f32" }, Member { name: "rate", offset: 72, ty: "f32" }, Member { name: "motion", offset: 76, ty: "f32" }, Member { name: "point", offset: 80, ty: "vec3<f32>" }, Member { name: "periphery", offset: 92, ty: "f32" }, Member { name: "half_size", offset: 96, ty: "vec3<f32>" }, Member { name: "rank", offset: 108, ty: "u32" }, Member { name: "fade_begin", offset: 112, ty: "f32" }, Member { name: "fade_end", offset: 116, ty: "f32" }, Member { name: "metric_floor", offset: 120, ty: "f32" }, Member { name: "unused", offset: 124, ty: "u32" }, Member { name: "triangles", offset: 128, ty: "array<vec4<u32>, 2>" }] },
        Struct { name: "SceneDraw", size: 20, members: &[Member { name: "index_count", offset: 0, ty: "u32" }, Member { name: "instance_count", offset: 4, ty: "u32" }, Member { name: "first_index", offset: 8, ty: "u32" }, Member { name: "base_vertex", offset: 12, ty: "u32" }, Member { name: "first_instance", offset: 16, ty: "u32" }] },
        Struct { name: "Entries", size: 16, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "first_entry", offset: 4, ty: "u32" }, Member { name: "second", offset: 8, ty: "u32" }, Member { name: "second_entry", offset: 12, ty: "u32" }] },
        Struct { name: "SortedEntry", size: 8, members: &[Member { name: "list", offset: 0, ty: "u32" }, Member { name: "word", offset: 4, ty: "u32" }] },
        Struct { name: "LodCamera", size: 48, members: &[Member { name: "eye", offset: 0, ty: "vec3<f32>" }, Member { name: "focal", offset: 12, ty: "f32" }, Member { name: "ahead", offset: 16, ty: "vec3<f32>" }, Member { name: "pixels", offset: 28, ty: "f32" }, Member { name: "near", offset: 32, ty: "f32" }, Member { name: "perspective", offset: 36, ty: "f32" }, Member { name: "pixel_count", offset: 40, ty: "f32" }, Member { name: "unused", offset: 44, ty: "f32" }] },
        Struct { name: "SelectView", size: 432, members: &[Member { name: "planes", offset: 0, ty: "array<vec4<f32>, 6>" }, Member { name: "cameras", offset: 96, ty: "array<LodCamera, 4>" }, Member { name: "cell", offset: 288, ty: "vec3<i32>" }, Member { name: "mask", offset: 300, ty: "u32" }, Member { name: "camera_count", offset: 304, ty: "u32" }, Member { name: "is_first", offset: 308, ty: "u32" }, Member { name: "casters", offset: 312, ty: "u32" }, Member { name: "blocks", offset: 316, ty: "u32" }, Member { name: "is_next", offset: 320, ty: "u32" }, Member { name: "seconds", offset: 324, ty: "f32" }, Member { name: "unused_a", offset: 328, ty: "u32" }, Member { name: "unused_b", offset: 332, ty: "u32" }, Member { name: "clip_rows", offset: 336, ty: "array<vec4<f32>, 3>" }, Member { name: "last_clip_rows", offset: 384, ty: "array<vec4<f32>, 3>" }] },
        Struct { name: "BudgetParams", size: 8, members: &[Member { name: "limit", offset: 0, ty: "u32" }, Member { name: "blocks", offset: 4, ty: "u32" }] },
        Struct { name: "BudgetWork", size: 36880, members: &[Member { name: "triangles", offset: 0, ty: "atomic<u32>" }, Member { name: "fading", offset: 4, ty: "atomic<u32>" }, Member { name: "bin", offset: 8, ty: "u32" }, Member { name: "left", offset: 12, ty: "u32" }, Member { name: "bins", offset: 16, ty: "array<atomic<u32>, 8192>" }, Member { name: "parts", offset: 32784, ty: "array<atomic<u32>, 1024>" }] },
        Struct { name: "Chosen", size: 192, members: &[Member { name: "object", offset: 0, ty: "LodObject" }, Member { name: "metric", offset: 160, ty: "f32" }, Member { name: "last", offset: 164, ty: "u32" }, Member { name: "held", offset: 168, ty: "u32" }, Member { name: "level", offset: 172, ty: "u32" }, Member { name: "is_seen", offset: 176, ty: "bool" }] },
    ],
};
/// `lod/decide`
pub static LOD_DECIDE: Shader = Shader {
    name: "lod/decide",
    source: include_str!(concat!(env!("OUT_DIR"), "/lod_decide.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "view", kind: BindingKind::Uniform, ty: "SelectView", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "objects", kind: BindingKind::StorageRead, ty: "array<LodObject>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "block_objects", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "metrics", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "decisions", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "last_decisions", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "counts", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "finest", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "budget", kind: BindingKind::StorageRead, ty: "array<BudgetState>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "BudgetState", size: 64, members: &[Member { name: "factors", offset: 0, ty: "array<vec4<f32>, 3>" }, Member { name: "ends_fades", offset: 48, ty: "u32" }, Member { name: "is_missed", offset: 52, ty: "u32" }, Member { name: "triangles", offset: 56, ty: "u32" }, Member { name: "pressure", offset: 60, ty: "u32" }] },
        Struct { name: "LodObject", size: 160, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "levels", offset: 8, ty: "u32" }, Member { name: "first_list", offset: 12, ty: "u32" }, Member { name: "first_draw", offset: 16, ty: "u32" }, Member { name: "parts", offset: 20, ty: "u32" }, Member { name: "metric_scale", offset: 24, ty: "f32" }, Member { name: "flags", offset: 28, ty: "u32" }, Member { name: "thresholds", offset: 32, ty: "array<vec4<f32>, 2>" }, Member { name: "finer", offset: 64, ty: "f32" }, Member { name: "coarser", offset: 68, ty: "f32" }, Member { name: "rate", offset: 72, ty: "f32" }, Member { name: "motion", offset: 76, ty: "f32" }, Member { name: "point", offset: 80, ty: "vec3<f32>" }, Member { name: "periphery", offset: 92, ty: "f32" }, Member { name: "half_size", offset: 96, ty: "vec3<f32>" }, Member { name: "rank", offset: 108, ty: "u32" }, Member { name: "fade_begin", offset: 112, ty: "f32" }, Member { name: "fade_end", offset: 116, ty: "f32" }, Member { name: "metric_floor", offset: 120, ty: "f32" }, Member { name: "unused", offset: 124, ty: "u32" }, Member { name: "triangles", offset: 128, ty: "array<vec4<u32>, 2>" }] },
        Struct { name: "SceneDraw", size: 20, members: &[Member { name: "index_count", offset: 0, ty: "u32" }, Member { name: "instance_count", offset: 4, ty: "u32" }, Member { name: "first_index", offset: 8, ty: "u32" }, Member { name: "base_vertex", offset: 12, ty: "u32" }, Member { name: "first_instance", offset: 16, ty: "u32" }] },
        Struct { name: "Entries", size: 16, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "first_entry", offset: 4, ty: "u32" }, Member { name: "second", offset: 8, ty: "u32" }, Member { name: "second_entry", offset: 12, ty: "u32" }] },
        Struct { name: "SortedEntry", size: 8, members: &[Member { name: "list", offset: 0, ty: "u32" }, Member { name: "word", offset: 4, ty: "u32" }] },
        Struct { name: "LodCamera", size: 48, members: &[Member { name: "eye", offset: 0, ty: "vec3<f32>" }, Member { name: "focal", offset: 12, ty: "f32" }, Member { name: "ahead", offset: 16, ty: "vec3<f32>" }, Member { name: "pixels", offset: 28, ty: "f32" }, Member { name: "near", offset: 32, ty: "f32" }, Member { name: "perspective", offset: 36, ty: "f32" }, Member { name: "pixel_count", offset: 40, ty: "f32" }, Member { name: "unused", offset: 44, ty: "f32" }] },
        Struct { name: "SelectView", size: 432, members: &[Member { name: "planes", offset: 0, ty: "array<vec4<f32>, 6>" }, Member { name: "cameras", offset: 96, ty: "array<LodCamera, 4>" }, Member { name: "cell", offset: 288, ty: "vec3<i32>" }, Member { name: "mask", offset: 300, ty: "u32" }, Member { name: "camera_count", offset: 304, ty: "u32" }, Member { name: "is_first", offset: 308, ty: "u32" }, Member { name: "casters", offset: 312, ty: "u32" }, Member { name: "blocks", offset: 316, ty: "u32" }, Member { name: "is_next", offset: 320, ty: "u32" }, Member { name: "seconds", offset: 324, ty: "f32" }, Member { name: "unused_a", offset: 328, ty: "u32" }, Member { name: "unused_b", offset: 332, ty: "u32" }, Member { name: "clip_rows", offset: 336, ty: "array<vec4<f32>, 3>" }, Member { name: "last_clip_rows", offset: 384, ty: "array<vec4<f32>, 3>" }] },
    ],
};
/// `lod/list`
pub static LOD_LIST: Shader = Shader {
    name: "lod/list",
    source: include_str!(concat!(env!("OUT_DIR"), "/lod_list.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [256, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "ListParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "objects", kind: BindingKind::StorageRead, ty: "array<LodObject>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "block_objects", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "decisions", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "counts", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "lists", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "arguments", kind: BindingKind::StorageReadWrite, ty: "array<SceneDraw>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "STAGE", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "LodObject", size: 160, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "levels", offset: 8, ty: "u32" }, Member { name: "first_list", offset: 12, ty: "u32" }, Member { name: "first_draw", offset: 16, ty: "u32" }, Member { name: "parts", offset: 20, ty: "u32" }, Member { name: "metric_scale", offset: 24, ty: "f32" }, Member { name: "flags", offset: 28, ty: "u32" }, Member { name: "thresholds", offset: 32, ty: "array<vec4<f32>, 2>" }, Member { name: "finer", offset: 64, ty: "f32" }, Member { name: "coarser", offset: 68, ty: "f32" }, Member { name: "rate", offset: 72, ty: "f32" }, Member { name: "motion", offset: 76, ty: "f32" }, Member { name: "point", offset: 80, ty: "vec3<f32>" }, Member { name: "periphery", offset: 92, ty: "f32" }, Member { name: "half_size", offset: 96, ty: "vec3<f32>" }, Member { name: "rank", offset: 108, ty: "u32" }, Member { name: "fade_begin", offset: 112, ty: "f32" }, Member { name: "fade_end", offset: 116, ty: "f32" }, Member { name: "metric_floor", offset: 120, ty: "f32" }, Member { name: "unused", offset: 124, ty: "u32" }, Member { name: "triangles", offset: 128, ty: "array<vec4<u32>, 2>" }] },
        Struct { name: "SceneDraw", size: 20, members: &[Member { name: "index_count", offset: 0, ty: "u32" }, Member { name: "instance_count", offset: 4, ty: "u32" }, Member { name: "first_index", offset: 8, ty: "u32" }, Member { name: "base_vertex", offset: 12, ty: "u32" }, Member { name: "first_instance", offset: 16, ty: "u32" }] },
        Struct { name: "Entries", size: 16, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "first_entry", offset: 4, ty: "u32" }, Member { name: "second", offset: 8, ty: "u32" }, Member { name: "second_entry", offset: 12, ty: "u32" }] },
        Struct { name: "SortedEntry", size: 8, members: &[Member { name: "list", offset: 0, ty: "u32" }, Member { name: "word", offset: 4, ty: "u32" }] },
        Struct { name: "ListParams", size: 8, members: &[Member { name: "objects", offset: 0, ty: "u32" }, Member { name: "blocks", offset: 4, ty: "u32" }] },
    ],
};
/// `lod/select`
pub static LOD_SELECT: Shader = Shader {
    name: "lod/select",
    source: include_str!(concat!(env!("OUT_DIR"), "/lod_select.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "view", kind: BindingKind::Uniform, ty: "SelectView", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "objects", kind: BindingKind::StorageRead, ty: "array<LodObject>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "block_objects", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "instances", kind: BindingKind::StorageRead, ty: "array<SceneInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "allowed", kind: BindingKind::StorageReadWrite, ty: "array<Allowed>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "metrics", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "placements", kind: BindingKind::StorageReadWrite, ty: "array<array<vec4<f32>, 3>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "decisions", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "shown", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "Allowed", size: 8, members: &[Member { name: "displacement", offset: 0, ty: "f32" }, Member { name: "distance", offset: 4, ty: "f32" }] },
        Struct { name: "LodCamera", size: 48, members: &[Member { name: "eye", offset: 0, ty: "vec3<f32>" }, Member { name: "focal", offset: 12, ty: "f32" }, Member { name: "ahead", offset: 16, ty: "vec3<f32>" }, Member { name: "pixels", offset: 28, ty: "f32" }, Member { name: "near", offset: 32, ty: "f32" }, Member { name: "perspective", offset: 36, ty: "f32" }, Member { name: "pixel_count", offset: 40, ty: "f32" }, Member { name: "unused", offset: 44, ty: "f32" }] },
        Struct { name: "Axes", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec3<f32>" }, Member { name: "y", offset: 16, ty: "vec3<f32>" }, Member { name: "z", offset: 32, ty: "vec3<f32>" }] },
        Struct { name: "Placed", size: 80, members: &[Member { name: "axes", offset: 0, ty: "Axes" }, Member { name: "at", offset: 48, ty: "vec3<f32>" }, Member { name: "center", offset: 64, ty: "vec3<f32>" }, Member { name: "radius", offset: 76, ty: "f32" }] },
        Struct { name: "LodObject", size: 160, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "levels", offset: 8, ty: "u32" }, Member { name: "first_list", offset: 12, ty: "u32" }, Member { name: "first_draw", offset: 16, ty: "u32" }, Member { name: "parts", offset: 20, ty: "u32" }, Member { name: "metric_scale", offset: 24, ty: "f32" }, Member { name: "flags", offset: 28, ty: "u32" }, Member { name: "thresholds", offset: 32, ty: "array<vec4<f32>, 2>" }, Member { name: "finer", offset: 64, ty: "f32" }, Member { name: "coarser", offset: 68, ty: "f32" }, Member { name: "rate", offset: 72, ty: "f32" }, Member { name: "motion", offset: 76, ty: "f32" }, Member { name: "point", offset: 80, ty: "vec3<f32>" }, Member { name: "periphery", offset: 92, ty: "f32" }, Member { name: "half_size", offset: 96, ty: "vec3<f32>" }, Member { name: "rank", offset: 108, ty: "u32" }, Member { name: "fade_begin", offset: 112, ty: "f32" }, Member { name: "fade_end", offset: 116, ty: "f32" }, Member { name: "metric_floor", offset: 120, ty: "f32" }, Member { name: "unused", offset: 124, ty: "u32" }, Member { name: "triangles", offset: 128, ty: "array<vec4<u32>, 2>" }] },
        Struct { name: "SceneInstance", size: 80, members: &[Member { name: "cell", offset: 0, ty: "vec3<i32>" }, Member { name: "flags", offset: 12, ty: "u32" }, Member { name: "offset", offset: 16, ty: "vec3<f32>" }, Member { name: "user_data", offset: 28, ty: "u32" }, Member { name: "rotation", offset: 32, ty: "vec4<f32>" }, Member { name: "scale", offset: 48, ty: "vec3<f32>" }, Member { name: "tint", offset: 60, ty: "u32" }, Member { name: "bounding_sphere", offset: 64, ty: "vec4<f32>" }] },
        Struct { name: "SceneDraw", size: 20, members: &[Member { name: "index_count", offset: 0, ty: "u32" }, Member { name: "instance_count", offset: 4, ty: "u32" }, Member { name: "first_index", offset: 8, ty: "u32" }, Member { name: "base_vertex", offset: 12, ty: "u32" }, Member { name: "first_instance", offset: 16, ty: "u32" }] },
        Struct { name: "SelectView", size: 432, members: &[Member { name: "planes", offset: 0, ty: "array<vec4<f32>, 6>" }, Member { name: "cameras", offset: 96, ty: "array<LodCamera, 4>" }, Member { name: "cell", offset: 288, ty: "vec3<i32>" }, Member { name: "mask", offset: 300, ty: "u32" }, Member { name: "camera_count", offset: 304, ty: "u32" }, Member { name: "is_first", offset: 308, ty: "u32" }, Member { name: "casters", offset: 312, ty: "u32" }, Member { name: "blocks", offset: 316, ty: "u32" }, Member { name: "is_next", offset: 320, ty: "u32" }, Member { name: "seconds", offset: 324, ty: "f32" }, Member { name: "unused_a", offset: 328, ty: "u32" }, Member { name: "unused_b", offset: 332, ty: "u32" }, Member { name: "clip_rows", offset: 336, ty: "array<vec4<f32>, 3>" }, Member { name: "last_clip_rows", offset: 384, ty: "array<vec4<f32>, 3>" }] },
        Struct { name: "Seen", size: 12, members: &[Member { name: "allowed", offset: 0, ty: "f32" }, Member { name: "distance", offset: 4, ty: "f32" }, Member { name: "metric", offset: 8, ty: "f32" }] },
    ],
};
/// `lod/sorted`
pub static LOD_SORTED: Shader = Shader {
    name: "lod/sorted",
    source: include_str!(concat!(env!("OUT_DIR"), "/lod_sorted.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "SortedParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "sorted", kind: BindingKind::StorageRead, ty: "array<SortedDraw>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "decisions", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "arguments", kind: BindingKind::StorageRead, ty: "array<SceneDraw>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "draws", kind: BindingKind::StorageReadWrite, ty: "array<SceneDraw>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "entries", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "objects", kind: BindingKind::StorageRead, ty: "array<LodObject>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "LodObject", size: 160, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "levels", offset: 8, ty: "u32" }, Member { name: "first_list", offset: 12, ty: "u32" }, Member { name: "first_draw", offset: 16, ty: "u32" }, Member { name: "parts", offset: 20, ty: "u32" }, Member { name: "metric_scale", offset: 24, ty: "f32" }, Member { name: "flags", offset: 28, ty: "u32" }, Member { name: "thresholds", offset: 32, ty: "array<vec4<f32>, 2>" }, Member { name: "finer", offset: 64, ty: "f32" }, Member { name: "coarser", offset: 68, ty: "f32" }, Member { name: "rate", offset: 72, ty: "f32" }, Member { name: "motion", offset: 76, ty: "f32" }, Member { name: "point", offset: 80, ty: "vec3<f32>" }, Member { name: "periphery", offset: 92, ty: "f32" }, Member { name: "half_size", offset: 96, ty: "vec3<f32>" }, Member { name: "rank", offset: 108, ty: "u32" }, Member { name: "fade_begin", offset: 112, ty: "f32" }, Member { name: "fade_end", offset: 116, ty: "f32" }, Member { name: "metric_floor", offset: 120, ty: "f32" }, Member { name: "unused", offset: 124, ty: "u32" }, Member { name: "triangles", offset: 128, ty: "array<vec4<u32>, 2>" }] },
        Struct { name: "SceneDraw", size: 20, members: &[Member { name: "index_count", offset: 0, ty: "u32" }, Member { name: "instance_count", offset: 4, ty: "u32" }, Member { name: "first_index", offset: 8, ty: "u32" }, Member { name: "base_vertex", offset: 12, ty: "u32" }, Member { name: "first_instance", offset: 16, ty: "u32" }] },
        Struct { name: "Entries", size: 16, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "first_entry", offset: 4, ty: "u32" }, Member { name: "second", offset: 8, ty: "u32" }, Member { name: "second_entry", offset: 12, ty: "u32" }] },
        Struct { name: "SortedEntry", size: 8, members: &[Member { name: "list", offset: 0, ty: "u32" }, Member { name: "word", offset: 4, ty: "u32" }] },
        Struct { name: "SortedDraw", size: 16, members: &[Member { name: "instance", offset: 0, ty: "u32" }, Member { name: "first_draw", offset: 4, ty: "u32" }, Member { name: "slot", offset: 8, ty: "u32" }, Member { name: "object", offset: 12, ty: "u32" }] },
        Struct { name: "SortedParams", size: 4, members: &[Member { name: "count", offset: 0, ty: "u32" }] },
    ],
};
/// `skinning/morph`
pub static SKINNING_MORPH: Shader = Shader {
    name: "skinning/morph",
    source: include_str!(concat!(env!("OUT_DIR"), "/skinning_morph.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "MorphParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "vertices", kind: BindingKind::StorageRead, ty: "array<vec2<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "offsets", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "deltas", kind: BindingKind::StorageRead, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "weights", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "seen", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "pairs", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "dispatched", kind: BindingKind::StorageRead, ty: "vec4<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "morphed", kind: BindingKind::StorageReadWrite, ty: "array<vec2<f32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "PAGED", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "InstanceLod", size: 16, members: &[Member { name: "influence_fade", offset: 0, ty: "f32" }, Member { name: "max_influences", offset: 4, ty: "u32" }, Member { name: "mesh_lod", offset: 8, ty: "u32" }, Member { name: "tier", offset: 12, ty: "u32" }] },
        Struct { name: "MorphParams", size: 80, members: &[Member { name: "vertices", offset: 0, ty: "u32" }, Member { name: "targets", offset: 4, ty: "u32" }, Member { name: "instances", offset: 8, ty: "u32" }, Member { name: "pairs", offset: 12, ty: "u32" }, Member { name: "levels", offset: 16, ty: "array<vec4<u32>, 4>" }] },
    ],
};
/// `skinning/morph_weights`
pub static SKINNING_MORPH_WEIGHTS: Shader = Shader {
    name: "skinning/morph_weights",
    source: include_str!(concat!(env!("OUT_DIR"), "/skinning_morph_weights.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "MorphWeightsParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "instances", kind: BindingKind::StorageRead, ty: "array<AnimationInstance>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "entries", kind: BindingKind::StorageRead, ty: "array<WeightEntry>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "instance_lods", kind: BindingKind::StorageRead, ty: "array<InstanceLod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "times", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "values", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "weights", kind: BindingKind::StorageReadWrite, ty: "array<f32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "ClipEntry", size: 16, members: &[Member { name: "first_timeline", offset: 0, ty: "u32" }, Member { name: "timelines", offset: 4, ty: "u32" }, Member { name: "duration", offset: 8, ty: "f32" }, Member { name: "first_row", offset: 12, ty: "u32" }] },
        Struct { name: "Timeline", size: 8, members: &[Member { name: "first_time", offset: 0, ty: "u32" }, Member { name: "keys", offset: 4, ty: "u32" }] },
        Struct { name: "KeyframeCursor", size: 8, members: &[Member { name: "key", offset: 0, ty: "u32" }, Member { name: "fraction", offset: 4, ty: "f32" }] },
        Struct { name: "SetTrack", size: 8, members: &[Member { name: "words", offset: 0, ty: "vec2<u32>" }] },
        Struct { name: "AnimationInstance", size: 16, members: &[Member { name: "clip", offset: 0, ty: "u32" }, Member { name: "wrap_code", offset: 4, ty: "u32" }, Member { name: "start", offset: 8, ty: "f32" }, Member { name: "rate", offset: 12, ty: "f32" }] },
        Struct { name: "InstanceLod", size: 16, members: &[Member { name: "influence_fade", offset: 0, ty: "f32" }, Member { name: "max_influences", offset: 4, ty: "u32" }, Member { name: "mesh_lod", offset: 8, ty: "u32" }, Member { name: "tier", offset: 12, ty: "u32" }] },
        Struct { name: "MorphWeightsParams", size: 12, members: &[Member { name: "targets", offset: 0, ty: "u32" }, Member { name: "pairs", offset: 4, ty: "u32" }, Member { name: "elapsed", offset: 8, ty: "f32" }] },
        Struct { name: "WeightEntry", size: 20, members: &[Member { name: "duration", offset: 0, ty: "f32" }, Member { name: "first_time", offset: 4, ty: "u32" }, Member { name: "keys", offset: 8, ty: "u32" }, Member { name: "first_value", offset: 12, ty: "u32" }, Member { name: "interpolation", offset: 16, ty: "u32" }] },
    ],
};
/// `skinning/pages`
pub static SKINNING_PAGES: Shader = Shader {
    name: "skinning/pages",
    source: include_str!(concat!(env!("OUT_DIR"), "/skinning_pages.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "PageParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "instance_lods", kind: BindingKind::StorageRead, ty: "array<InstanceLod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "held", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "table", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "stack", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "state", kind: BindingKind::StorageReadWrite, ty: "PageState", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "InstanceLod", size: 16, members: &[Member { name: "influence_fade", offset: 0, ty: "f32" }, Member { name: "max_influences", offset: 4, ty: "u32" }, Member { name: "mesh_lod", offset: 8, ty: "u32" }, Member { name: "tier", offset: 12, ty: "u32" }] },
        Struct { name: "PageParams", size: 80, members: &[Member { name: "instances", offset: 0, ty: "u32" }, Member { name: "clusters", offset: 4, ty: "u32" }, Member { name: "levels", offset: 16, ty: "array<vec4<u32>, 4>" }] },
        Struct { name: "PageState", size: 8, members: &[Member { name: "free", offset: 0, ty: "u32" }, Member { name: "short", offset: 4, ty: "u32" }] },
    ],
};
/// `skinning/palette`
pub static SKINNING_PALETTE: Shader = Shader {
    name: "skinning/palette",
    source: include_str!(concat!(env!("OUT_DIR"), "/skinning_palette.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "PaletteParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "bones", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "inverse_binds", kind: BindingKind::StorageRead, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "model_matrices", kind: BindingKind::StorageRead, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "instance_lods", kind: BindingKind::StorageRead, ty: "array<InstanceLod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "palette", kind: BindingKind::StorageReadWrite, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "DUAL", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "InstanceLod", size: 16, members: &[Member { name: "influence_fade", offset: 0, ty: "f32" }, Member { name: "max_influences", offset: 4, ty: "u32" }, Member { name: "mesh_lod", offset: 8, ty: "u32" }, Member { name: "tier", offset: 12, ty: "u32" }] },
        Struct { name: "Rows", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec4<f32>" }, Member { name: "y", offset: 16, ty: "vec4<f32>" }, Member { name: "z", offset: 32, ty: "vec4<f32>" }] },
        Struct { name: "PaletteParams", size: 12, members: &[Member { name: "bones", offset: 0, ty: "u32" }, Member { name: "all_bones", offset: 4, ty: "u32" }, Member { name: "pairs", offset: 8, ty: "u32" }] },
    ],
};
/// `skinning/select`
pub static SKINNING_SELECT: Shader = Shader {
    name: "skinning/select",
    source: include_str!(concat!(env!("OUT_DIR"), "/skinning_select.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "SelectParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "masks", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "updated_bones", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "instance_lods", kind: BindingKind::StorageRead, ty: "array<InstanceLod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "weights", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "offsets", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "skinned", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "pairs", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "dispatched", kind: BindingKind::StorageReadWrite, ty: "Dispatched", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "FINISH", ty: "bool", default: 0.0 },
        Override { name: "CLEAR", ty: "bool", default: 0.0 },
        Override { name: "KEEP", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "InstanceLod", size: 16, members: &[Member { name: "influence_fade", offset: 0, ty: "f32" }, Member { name: "max_influences", offset: 4, ty: "u32" }, Member { name: "mesh_lod", offset: 8, ty: "u32" }, Member { name: "tier", offset: 12, ty: "u32" }] },
        Struct { name: "SelectParams", size: 96, members: &[Member { name: "instances", offset: 0, ty: "u32" }, Member { name: "clusters", offset: 4, ty: "u32" }, Member { name: "words", offset: 8, ty: "u32" }, Member { name: "most", offset: 12, ty: "u32" }, Member { name: "vertices", offset: 16, ty: "u32" }, Member { name: "targets", offset: 20, ty: "u32" }, Member { name: "levels", offset: 32, ty: "array<vec4<u32>, 4>" }] },
        Struct { name: "Dispatched", size: 20, members: &[Member { name: "x", offset: 0, ty: "u32" }, Member { name: "y", offset: 4, ty: "u32" }, Member { name: "z", offset: 8, ty: "u32" }, Member { name: "pairs", offset: 12, ty: "u32" }, Member { name: "count", offset: 16, ty: "atomic<u32>" }] },
    ],
};
/// `skinning/skin`
pub static SKINNING_SKIN: Shader = Shader {
    name: "skinning/skin",
    source: include_str!(concat!(env!("OUT_DIR"), "/skinning_skin.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "SkinParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "vertices", kind: BindingKind::StorageRead, ty: "array<vec2<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "influences", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "palette", kind: BindingKind::StorageRead, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "instance_lods", kind: BindingKind::StorageRead, ty: "array<InstanceLod>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "pairs", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "dispatched", kind: BindingKind::StorageRead, ty: "vec4<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "skinned", kind: BindingKind::StorageReadWrite, ty: "array<vec2<f32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 8, name: "page_table", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "DUAL", ty: "bool", default: 0.0 },
        Override { name: "MORPHED", ty: "bool", default: 0.0 },
        Override { name: "PAGED", ty: "bool", default: 0.0 },
        Override { name: "KEEP", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "InstanceLod", size: 16, members: &[Member { name: "influence_fade", offset: 0, ty: "f32" }, Member { name: "max_influences", offset: 4, ty: "u32" }, Member { name: "mesh_lod", offset: 8, ty: "u32" }, Member { name: "tier", offset: 12, ty: "u32" }] },
        Struct { name: "Rows", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec4<f32>" }, Member { name: "y", offset: 16, ty: "vec4<f32>" }, Member { name: "z", offset: 32, ty: "vec4<f32>" }] },
        Struct { name: "SkinParams", size: 96, members: &[Member { name: "vertices", offset: 0, ty: "u32" }, Member { name: "pairs", offset: 4, ty: "u32" }, Member { name: "bones", offset: 8, ty: "u32" }, Member { name: "instances", offset: 12, ty: "u32" }, Member { name: "last", offset: 16, ty: "u32" }, Member { name: "levels", offset: 32, ty: "array<vec4<u32>, 4>" }] },
        Struct { name: "Sum", size: 64, members: &[Member { name: "a", offset: 0, ty: "vec4<f32>" }, Member { name: "b", offset: 16, ty: "vec4<f32>" }, Member { name: "c", offset: 32, ty: "vec4<f32>" }, Member { name: "d", offset: 48, ty: "vec4<f32>" }] },
    ],
};
/// `surface/cone_map`
pub static SURFACE_CONE_MAP: Shader = Shader {
    name: "surface/cone_map",
    source: include_str!(concat!(env!("OUT_DIR"), "/surface_cone_map.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [8, 8, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "ConeParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "heights", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "pyramids", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "cones", kind: BindingKind::StorageReadWrite, ty: "array<vec2<f32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "SurfaceRay", size: 24, members: &[Member { name: "origin", offset: 0, ty: "vec2<f32>" }, Member { name: "slope", offset: 8, ty: "vec2<f32>" }, Member { name: "cosine", offset: 16, ty: "f32" }, Member { name: "polygon", offset: 20, ty: "f32" }] },
        Struct { name: "SurfaceMarch", size: 20, members: &[Member { name: "address", offset: 0, ty: "u32" }, Member { name: "min_steps", offset: 4, ty: "u32" }, Member { name: "max_steps", offset: 8, ty: "u32" }, Member { name: "binary_steps", offset: 12, ty: "u32" }, Member { name: "mip", offset: 16, ty: "u32" }] },
        Struct { name: "SurfaceHit", size: 24, members: &[Member { name: "uv", offset: 0, ty: "vec2<f32>" }, Member { name: "height", offset: 8, ty: "f32" }, Member { name: "parameter", offset: 12, ty: "f32" }, Member { name: "samples", offset: 16, ty: "u32" }, Member { name: "outcome_code", offset: 20, ty: "u32" }] },
        Struct { name: "ConeParams", size: 32, members: &[Member { name: "size", offset: 0, ty: "vec2<u32>" }, Member { name: "cells", offset: 8, ty: "vec2<u32>" }, Member { name: "pitch", offset: 16, ty: "u32" }, Member { name: "rows", offset: 20, ty: "u32" }, Member { name: "cone_pitch", offset: 24, ty: "u32" }, Member { name: "address", offset: 28, ty: "u32" }] },
    ],
};
/// `surface/height_pyramid`
pub static SURFACE_HEIGHT_PYRAMID: Shader = Shader {
    name: "surface/height_pyramid",
    source: include_str!(concat!(env!("OUT_DIR"), "/surface_height_pyramid.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "PyramidParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "heights", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "pyramids", kind: BindingKind::StorageReadWrite, ty: "array<f32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "SurfaceRay", size: 24, members: &[Member { name: "origin", offset: 0, ty: "vec2<f32>" }, Member { name: "slope", offset: 8, ty: "vec2<f32>" }, Member { name: "cosine", offset: 16, ty: "f32" }, Member { name: "polygon", offset: 20, ty: "f32" }] },
        Struct { name: "SurfaceMarch", size: 20, members: &[Member { name: "address", offset: 0, ty: "u32" }, Member { name: "min_steps", offset: 4, ty: "u32" }, Member { name: "max_steps", offset: 8, ty: "u32" }, Member { name: "binary_steps", offset: 12, ty: "u32" }, Member { name: "mip", offset: 16, ty: "u32" }] },
        Struct { name: "SurfaceHit", size: 24, members: &[Member { name: "uv", offset: 0, ty: "vec2<f32>" }, Member { name: "height", offset: 8, ty: "f32" }, Member { name: "parameter", offset: 12, ty: "f32" }, Member { name: "samples", offset: 16, ty: "u32" }, Member { name: "outcome_code", offset: 20, ty: "u32" }] },
        Struct { name: "PyramidParams", size: 32, members: &[Member { name: "size", offset: 0, ty: "vec2<u32>" }, Member { name: "cells", offset: 8, ty: "vec2<u32>" }, Member { name: "pitch", offset: 16, ty: "u32" }, Member { name: "rows", offset: 20, ty: "u32" }, Member { name: "address", offset: 24, ty: "u32" }, Member { name: "level", offset: 28, ty: "u32" }] },
    ],
};
/// `surface/relief`
pub static SURFACE_RELIEF: Shader = Shader {
    name: "surface/relief",
    source: include_str!(concat!(env!("OUT_DIR"), "/surface_relief.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "march", kind: BindingKind::Uniform, ty: "SurfaceMarch", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "heights", kind: BindingKind::LoadedTexture, ty: "texture_2d<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "acceleration", kind: BindingKind::LoadedTexture, ty: "texture_2d<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "rays", kind: BindingKind::StorageRead, ty: "array<SurfaceRay>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "hits", kind: BindingKind::StorageReadWrite, ty: "array<SurfaceHit>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "METHOD", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "SurfaceRay", size: 24, members: &[Member { name: "origin", offset: 0, ty: "vec2<f32>" }, Member { name: "slope", offset: 8, ty: "vec2<f32>" }, Member { name: "cosine", offset: 16, ty: "f32" }, Member { name: "polygon", offset: 20, ty: "f32" }] },
        Struct { name: "SurfaceMarch", size: 20, members: &[Member { name: "address", offset: 0, ty: "u32" }, Member { name: "min_steps", offset: 4, ty: "u32" }, Member { name: "max_steps", offset: 8, ty: "u32" }, Member { name: "binary_steps", offset: 12, ty: "u32" }, Member { name: "mip", offset: 16, ty: "u32" }] },
        Struct { name: "SurfaceHit", size: 24, members: &[Member { name: "uv", offset: 0, ty: "vec2<f32>" }, Member { name: "height", offset: 8, ty: "f32" }, Member { name: "parameter", offset: 12, ty: "f32" }, Member { name: "samples", offset: 16, ty: "u32" }, Member { name: "outcome_code", offset: 20, ty: "u32" }] },
        Struct { name: "SurfaceGrid", size: 64, members: &[Member { name: "size", offset: 0, ty: "vec2<i32>" }, Member { name: "cells", offset: 8, ty: "vec2<i32>" }, Member { name: "base", offset: 16, ty: "vec2<i32>" }, Member { name: "start", offset: 24, ty: "vec2<f32>" }, Member { name: "tiles", offset: 32, ty: "vec2<f32>" }, Member { name: "travel", offset: 40, ty: "vec2<f32>" }, Member { name: "inverse", offset: 48, ty: "vec2<f32>" }, Member { name: "address", offset: 56, ty: "u32" }] },
        Struct { name: "SurfaceNode", size: 24, members: &[Member { name: "index", offset: 0, ty: "vec2<i32>" }, Member { name: "low", offset: 8, ty: "vec2<i32>" }, Member { name: "high", offset: 16, ty: "vec2<i32>" }] },
        Struct { name: "SurfaceBracket", size: 20, members: &[Member { name: "above", offset: 0, ty: "f32" }, Member { name: "under", offset: 4, ty: "f32" }, Member { name: "height_above", offset: 8, ty: "f32" }, Member { name: "height_under", offset: 12, ty: "f32" }, Member { name: "samples", offset: 16, ty: "u32" }] },
    ],
};
/// `surface/shade`
pub static SURFACE_SHADE: Shader = Shader {
    name: "surface/shade",
    source: include_str!(concat!(env!("OUT_DIR"), "/surface_shade.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "view", kind: BindingKind::Uniform, ty: "ShadeView", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "march", kind: BindingKind::Uniform, ty: "SurfaceMarch", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "heights", kind: BindingKind::LoadedTexture, ty: "texture_2d<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "acceleration", kind: BindingKind::LoadedTexture, ty: "texture_2d<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "points", kind: BindingKind::StorageRead, ty: "array<ShadePoint>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "shades", kind: BindingKind::StorageReadWrite, ty: "array<Shade>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "METHOD", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "SurfaceRay", size: 24, members: &[Member { name: "origin", offset: 0, ty: "vec2<f32>" }, Member { name: "slope", offset: 8, ty: "vec2<f32>" }, Member { name: "cosine", offset: 16, ty: "f32" }, Member { name: "polygon", offset: 20, ty: "f32" }] },
        Struct { name: "SurfaceMarch", size: 20, members: &[Member { name: "address", offset: 0, ty: "u32" }, Member { name: "min_steps", offset: 4, ty: "u32" }, Member { name: "max_steps", offset: 8, ty: "u32" }, Member { name: "binary_steps", offset: 12, ty: "u32" }, Member { name: "mip", offset: 16, ty: "u32" }] },
        Struct { name: "SurfaceHit", size: 24, members: &[Member { name: "uv", offset: 0, ty: "vec2<f32>" }, Member { name: "height", offset: 8, ty: "f32" }, Member { name: "parameter", offset: 12, ty: "f32" }, Member { name: "samples", offset: 16, ty: "u32" }, Member { name: "outcome_code", offset: 20, ty: "u32" }] },
        Struct { name: "SurfaceGrid", size: 64, members: &[Member { name: "size", offset: 0, ty: "vec2<i32>" }, Member { name: "cells", offset: 8, ty: "vec2<i32>" }, Member { name: "base", offset: 16, ty: "vec2<i32>" }, Member { name: "start", offset: 24, ty: "vec2<f32>" }, Member { name: "tiles", offset: 32, ty: "vec2<f32>" }, Member { name: "travel", offset: 40, ty: "vec2<f32>" }, Member { name: "inverse", offset: 48, ty: "vec2<f32>" }, Member { name: "address", offset: 56, ty: "u32" }] },
        Struct { name: "SurfaceNode", size: 24, members: &[Member { name: "index", offset: 0, ty: "vec2<i32>" }, Member { name: "low", offset: 8, ty: "vec2<i32>" }, Member { name: "high", offset: 16, ty: "vec2<i32>" }] },
        Struct { name: "SurfaceBracket", size: 20, members: &[Member { name: "above", offset: 0, ty: "f32" }, Member { name: "under", offset: 4, ty: "f32" }, Member { name: "height_above", offset: 8, ty: "f32" }, Member { name: "height_under", offset: 12, ty: "f32" }, Member { name: "samples", offset: 16, ty: "u32" }] },
        Struct { name: "ShadeView", size: 96, members: &[Member { name: "clip_from_world", offset: 0, ty: "mat4x4<f32>" }, Member { name: "eye", offset: 64, ty: "vec4<f32>" }, Member { name: "shadow_steps", offset: 80, ty: "u32" }, Member { name: "softness", offset: 84, ty: "f32" }] },
        Struct { name: "ShadePoint", size: 80, members: &[Member { name: "light", offset: 0, ty: "vec3<f32>" }, Member { name: "scale", offset: 12, ty: "f32" }, Member { name: "position", offset: 16, ty: "vec3<f32>" }, Member { name: "world", offset: 28, ty: "f32" }, Member { name: "ray", offset: 32, ty: "SurfaceRay" }, Member { name: "hit", offset: 56, ty: "SurfaceHit" }] },
        Struct { name: "Shade", size: 12, members: &[Member { name: "hard", offset: 0, ty: "f32" }, Member { name: "soft", offset: 4, ty: "f32" }, Member { name: "depth", offset: 8, ty: "f32" }] },
    ],
};
/// `surface/tangent`
pub static SURFACE_TANGENT: Shader = Shader {
    name: "surface/tangent",
    source: include_str!(concat!(env!("OUT_DIR"), "/surface_tangent.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "TangentParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "positions", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "normals", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "texture_coordinates", kind: BindingKind::StorageRead, ty: "array<f32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "indices", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "offsets", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 6, name: "corners", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 7, name: "tangents", kind: BindingKind::StorageReadWrite, ty: "array<vec4<f32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "TangentParams", size: 4, members: &[Member { name: "vertices", offset: 0, ty: "u32" }] },
        Struct { name: "Contribution", size: 32, members: &[Member { name: "tangent", offset: 0, ty: "vec3<f32>" }, Member { name: "weight", offset: 12, ty: "f32" }, Member { name: "handedness", offset: 16, ty: "f32" }] },
    ],
};
/// `terrain/blend`
pub static TERRAIN_BLEND: Shader = Shader {
    name: "terrain/blend",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_blend.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "MapParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "windows", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "zones", kind: BindingKind::StorageRead, ty: "array<MapZone>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "texels", kind: BindingKind::StorageRead, ty: "array<vec2<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "places", kind: BindingKind::StorageRead, ty: "array<vec2<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 5, name: "pixels", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "Light", size: 16, members: &[Member { name: "direction", offset: 0, ty: "vec3<f32>" }, Member { name: "ambient", offset: 12, ty: "f32" }] },
        Struct { name: "Zone", size: 32, members: &[Member { name: "min", offset: 0, ty: "f32" }, Member { name: "max", offset: 4, ty: "f32" }, Member { name: "rise", offset: 8, ty: "vec2<f32>" }, Member { name: "fall", offset: 16, ty: "vec2<f32>" }, Member { name: "height_blend", offset: 24, ty: "f32" }, Member { name: "repeats", offset: 28, ty: "f32" }] },
        Struct { name: "MapZone", size: 40, members: &[Member { name: "zone", offset: 0, ty: "Zone" }, Member { name: "first", offset: 32, ty: "u32" }, Member { name: "edge_log2", offset: 36, ty: "u32" }] },
        Struct { name: "ZoneBlend", size: 48, members: &[Member { name: "color", offset: 0, ty: "vec3<f32>" }, Member { name: "total", offset: 12, ty: "f32" }, Member { name: "weight", offset: 16, ty: "f32" }, Member { name: "nearest", offset: 32, ty: "vec3<f32>" }, Member { name: "distance", offset: 44, ty: "f32" }] },
        Struct { name: "MapParams", size: 48, members: &[Member { name: "light", offset: 0, ty: "Light" }, Member { name: "width", offset: 16, ty: "u32" }, Member { name: "run", offset: 20, ty: "f32" }, Member { name: "zone_count", offset: 24, ty: "u32" }, Member { name: "additive", offset: 28, ty: "u32" }, Member { name: "planes", offset: 32, ty: "u32" }, Member { name: "tiles_per_sample", offset: 36, ty: "u32" }, Member { name: "tiles_per_unit", offset: 40, ty: "u32" }, Member { name: "variation", offset: 44, ty: "f32" }] },
    ],
};
/// `terrain/border`
pub static TERRAIN_BORDER: Shader = Shader {
    name: "terrain/border",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_border.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "BorderParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "heights", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "neighbours", kind: BindingKind::StorageRead, ty: "array<vec4<u32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "order", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "others", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "OTHERS", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "BorderParams", size: 12, members: &[Member { name: "size", offset: 0, ty: "u32" }, Member { name: "width", offset: 4, ty: "u32" }, Member { name: "start", offset: 8, ty: "u32" }] },
    ],
};
/// `terrain/despike`
pub static TERRAIN_DESPIKE: Shader = Shader {
    name: "terrain/despike",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_despike.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "DespikeParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "windows", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "outputs", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 1, binding: 0, name: "feature_words", kind: BindingKind::StorageRead, ty: "array<FeatureWord>", stages: &[Stage::Compute] },
        Binding { group: 1, binding: 1, name: "feature_heights", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[] },
    ],
    overrides: &[
        Override { name: "FEATURES", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "FeatureGrid", size: 16, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "words_per_row", offset: 4, ty: "u32" }, Member { name: "words_per_window", offset: 8, ty: "u32" }, Member { name: "start", offset: 12, ty: "u32" }] },
        Struct { name: "FeatureWord", size: 8, members: &[Member { name: "mask", offset: 0, ty: "u32" }, Member { name: "first_value", offset: 4, ty: "u32" }] },
        Struct { name: "DespikeParams", size: 24, members: &[Member { name: "features", offset: 0, ty: "FeatureGrid" }, Member { name: "width", offset: 16, ty: "u32" }, Member { name: "threshold", offset: 20, ty: "i32" }] },
    ],
};
/// `terrain/height`
pub static TERRAIN_HEIGHT: Shader = Shader {
    name: "terrain/height",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_height.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [16, 4, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "level", kind: BindingKind::Uniform, ty: "Level", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "origins", kind: BindingKind::StorageRead, ty: "array<vec2<i32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "coarse", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "fine", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 1, binding: 0, name: "feature_words", kind: BindingKind::StorageRead, ty: "array<FeatureWord>", stages: &[Stage::Compute] },
        Binding { group: 1, binding: 1, name: "feature_heights", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "FEATURES", ty: "u32", default: 0.0 },
        Override { name: "DISTRIBUTION", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "Words", size: 32, members: &[Member { name: "first", offset: 0, ty: "vec4<u32>" }, Member { name: "second", offset: 16, ty: "vec4<u32>" }] },
        Struct { name: "FeatureGrid", size: 16, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "words_per_row", offset: 4, ty: "u32" }, Member { name: "words_per_window", offset: 8, ty: "u32" }, Member { name: "start", offset: 12, ty: "u32" }] },
        Struct { name: "FeatureWord", size: 8, members: &[Member { name: "mask", offset: 0, ty: "u32" }, Member { name: "first_value", offset: 4, ty: "u32" }] },
        Struct { name: "Level", size: 48, members: &[Member { name: "key", offset: 0, ty: "vec2<u32>" }, Member { name: "fine_width", offset: 8, ty: "u32" }, Member { name: "coarse_width", offset: 12, ty: "u32" }, Member { name: "spacing", offset: 16, ty: "u32" }, Member { name: "range", offset: 20, ty: "u32" }, Member { name: "edge_range", offset: 24, ty: "u32" }, Member { name: "features", offset: 32, ty: "FeatureGrid" }] },
    ],
};
/// `terrain/hydraulic`
pub static TERRAIN_HYDRAULIC: Shader = Shader {
    name: "terrain/hydraulic",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_hydraulic.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "HydraulicParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "windows", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "outputs", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "flows", kind: BindingKind::StorageRead, ty: "array<vec4<i32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "flow_outputs", kind: BindingKind::StorageReadWrite, ty: "array<vec4<i32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "HydraulicParams", size: 56, members: &[Member { name: "in_width", offset: 0, ty: "u32" }, Member { name: "wet", offset: 4, ty: "i32" }, Member { name: "settles", offset: 8, ty: "i32" }, Member { name: "rain", offset: 12, ty: "i32" }, Member { name: "evaporation", offset: 16, ty: "i32" }, Member { name: "erosion", offset: 20, ty: "i32" }, Member { name: "deposition", offset: 24, ty: "i32" }, Member { name: "capacity", offset: 28, ty: "i32" }, Member { name: "threshold", offset: 32, ty: "i32" }, Member { name: "steepest", offset: 36, ty: "i32" }, Member { name: "slope_shift", offset: 40, ty: "u32" }, Member { name: "slope_factor", offset: 44, ty: "i32" }, Member { name: "talus", offset: 48, ty: "i32" }, Member { name: "creep", offset: 52, ty: "i32" }] },
        Struct { name: "Cell", size: 32, members: &[Member { name: "ground", offset: 0, ty: "i32" }, Member { name: "water", offset: 4, ty: "i32" }, Member { name: "sediment", offset: 8, ty: "i32" }, Member { name: "shares", offset: 16, ty: "vec4<i32>" }] },
    ],
};
/// `terrain/limit`
pub static TERRAIN_LIMIT: Shader = Shader {
    name: "terrain/limit",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_limit.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "LimitParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "origins", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "eroded", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "corners", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "heights", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "LimitParams", size: 12, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "eroded_width", offset: 4, ty: "u32" }, Member { name: "most", offset: 8, ty: "i32" }] },
    ],
};
/// `terrain/morph`
pub static TERRAIN_MORPH: Shader = Shader {
    name: "terrain/morph",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_morph.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "MorphParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "start_heights", kind: BindingKind::StorageRead, ty: "array<vec4<i32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "target_heights", kind: BindingKind::StorageRead, ty: "array<vec4<i32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "heights", kind: BindingKind::StorageReadWrite, ty: "array<vec4<i32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "MorphParams", size: 8, members: &[Member { name: "vectors", offset: 0, ty: "u32" }, Member { name: "time", offset: 4, ty: "u32" }] },
    ],
};
/// `terrain/node`
pub static TERRAIN_NODE: Shader = Shader {
    name: "terrain/node",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_node.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "NodeParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "heights", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "slots", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "tiles", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "facts", kind: BindingKind::StorageReadWrite, ty: "array<atomic<u32>>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "STAGE", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "NodeParams", size: 16, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "count", offset: 4, ty: "u32" }, Member { name: "size", offset: 8, ty: "u32" }, Member { name: "finer", offset: 12, ty: "u32" }] },
    ],
};
/// `terrain/node_normals`
pub static TERRAIN_NODE_NORMALS: Shader = Shader {
    name: "terrain/node_normals",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_node_normals.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "NodeNormalsParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "heights", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "slots", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "normals", kind: BindingKind::StorageReadWrite, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "NodeNormalsParams", size: 20, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "size", offset: 4, ty: "u32" }, Member { name: "first", offset: 8, ty: "u32" }, Member { name: "step", offset: 12, ty: "u32" }, Member { name: "run", offset: 16, ty: "f32" }] },
    ],
};
/// `terrain/noise`
pub static TERRAIN_NOISE: Shader = Shader {
    name: "terrain/noise",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_noise.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "NoiseParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "origins", kind: BindingKind::StorageRead, ty: "array<vec2<i32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "heights", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "GENERATOR", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "Words", size: 32, members: &[Member { name: "first", offset: 0, ty: "vec4<u32>" }, Member { name: "second", offset: 16, ty: "vec4<u32>" }] },
        Struct { name: "NoiseParams", size: 112, members: &[Member { name: "key", offset: 0, ty: "vec2<u32>" }, Member { name: "width", offset: 8, ty: "u32" }, Member { name: "spacing", offset: 12, ty: "u32" }, Member { name: "base_log2", offset: 16, ty: "u32" }, Member { name: "octaves", offset: 20, ty: "u32" }, Member { name: "ranges", offset: 32, ty: "array<vec4<u32>, 5>" }] },
    ],
};
/// `terrain/normals`
pub static TERRAIN_NORMALS: Shader = Shader {
    name: "terrain/normals",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_normals.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "NormalsParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "windows", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "gradients", kind: BindingKind::StorageReadWrite, ty: "array<vec2<i32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "normals", kind: BindingKind::StorageReadWrite, ty: "array<f32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "NormalsParams", size: 8, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "run", offset: 4, ty: "f32" }] },
    ],
};
/// `terrain/pad`
pub static TERRAIN_PAD: Shader = Shader {
    name: "terrain/pad",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_pad.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "PadParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "patches", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "outputs", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "around", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "PadParams", size: 8, members: &[Member { name: "size", offset: 0, ty: "u32" }, Member { name: "apron", offset: 4, ty: "u32" }] },
    ],
};
/// `terrain/replace`
pub static TERRAIN_REPLACE: Shader = Shader {
    name: "terrain/replace",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_replace.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "ReplaceParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "given", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "heights", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "ReplaceParams", size: 4, members: &[Member { name: "width", offset: 0, ty: "u32" }] },
    ],
};
/// `terrain/smooth`
pub static TERRAIN_SMOOTH: Shader = Shader {
    name: "terrain/smooth",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_smooth.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [16, 4, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "level", kind: BindingKind::Uniform, ty: "Level", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "origins", kind: BindingKind::StorageRead, ty: "array<vec2<i32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "coarse", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "fine", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 4, name: "centers", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 1, binding: 0, name: "feature_words", kind: BindingKind::StorageRead, ty: "array<FeatureWord>", stages: &[Stage::Compute] },
        Binding { group: 1, binding: 1, name: "feature_heights", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "FEATURES", ty: "u32", default: 0.0 },
        Override { name: "DISTRIBUTION", ty: "u32", default: 0.0 },
        Override { name: "STAGE", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "Words", size: 32, members: &[Member { name: "first", offset: 0, ty: "vec4<u32>" }, Member { name: "second", offset: 16, ty: "vec4<u32>" }] },
        Struct { name: "FeatureGrid", size: 16, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "words_per_row", offset: 4, ty: "u32" }, Member { name: "words_per_window", offset: 8, ty: "u32" }, Member { name: "start", offset: 12, ty: "u32" }] },
        Struct { name: "FeatureWord", size: 8, members: &[Member { name: "mask", offset: 0, ty: "u32" }, Member { name: "first_value", offset: 4, ty: "u32" }] },
        Struct { name: "Level", size: 48, members: &[Member { name: "key", offset: 0, ty: "vec2<u32>" }, Member { name: "fine_width", offset: 8, ty: "u32" }, Member { name: "coarse_width", offset: 12, ty: "u32" }, Member { name: "spacing", offset: 16, ty: "u32" }, Member { name: "range", offset: 20, ty: "u32" }, Member { name: "edge_range", offset: 24, ty: "u32" }, Member { name: "features", offset: 32, ty: "FeatureGrid" }] },
    ],
};
/// `terrain/thermal`
pub static TERRAIN_THERMAL: Shader = Shader {
    name: "terrain/thermal",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_thermal.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "params", kind: BindingKind::Uniform, ty: "ThermalParams", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "windows", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "outputs", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
    ],
    structs: &[
        Struct { name: "ThermalParams", size: 8, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "threshold", offset: 4, ty: "i32" }] },
    ],
};
/// `terrain/wrap`
pub static TERRAIN_WRAP: Shader = Shader {
    name: "terrain/wrap",
    source: include_str!(concat!(env!("OUT_DIR"), "/terrain_wrap.wgsl")),
    entry_points: &[
        EntryPoint { name: "main", stage: Stage::Compute, workgroup_size: [64, 1, 1], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "level", kind: BindingKind::Uniform, ty: "Level", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 1, name: "origins", kind: BindingKind::StorageRead, ty: "array<vec2<i32>>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 2, name: "coarse", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 0, binding: 3, name: "fine", kind: BindingKind::StorageReadWrite, ty: "array<i32>", stages: &[Stage::Compute] },
        Binding { group: 1, binding: 0, name: "feature_words", kind: BindingKind::StorageRead, ty: "array<FeatureWord>", stages: &[Stage::Compute] },
        Binding { group: 1, binding: 1, name: "feature_heights", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Compute] },
    ],
    overrides: &[
        Override { name: "FEATURES", ty: "u32", default: 0.0 },
        Override { name: "DISTRIBUTION", ty: "u32", default: 0.0 },
    ],
    structs: &[
        Struct { name: "Words", size: 32, members: &[Member { name: "first", offset: 0, ty: "vec4<u32>" }, Member { name: "second", offset: 16, ty: "vec4<u32>" }] },
        Struct { name: "FeatureGrid", size: 16, members: &[Member { name: "width", offset: 0, ty: "u32" }, Member { name: "words_per_row", offset: 4, ty: "u32" }, Member { name: "words_per_window", offset: 8, ty: "u32" }, Member { name: "start", offset: 12, ty: "u32" }] },
        Struct { name: "FeatureWord", size: 8, members: &[Member { name: "mask", offset: 0, ty: "u32" }, Member { name: "first_value", offset: 4, ty: "u32" }] },
        Struct { name: "Level", size: 48, members: &[Member { name: "key", offset: 0, ty: "vec2<u32>" }, Member { name: "fine_width", offset: 8, ty: "u32" }, Member { name: "coarse_width", offset: 12, ty: "u32" }, Member { name: "spacing", offset: 16, ty: "u32" }, Member { name: "range", offset: 20, ty: "u32" }, Member { name: "edge_range", offset: 24, ty: "u32" }, Member { name: "features", offset: 32, ty: "FeatureGrid" }] },
    ],
};
/// `render/scene_mesh`
pub static RENDER_SCENE_MESH: Shader = Shader {
    name: "render/scene_mesh",
    source: include_str!(concat!(env!("OUT_DIR"), "/render_scene_mesh.wgsl")),
    entry_points: &[
        EntryPoint { name: "relievo_vertex", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_vertex_moving", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_vertex_depth", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_depth", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_depth_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_color", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_color_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_transparent", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_transparent_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_levels", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_levels_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_measure", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_measure_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_surface", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_surface_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_velocity", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_velocity_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "relievo_view", kind: BindingKind::Uniform, ty: "relievo_SceneView", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 1, name: "relievo_placements", kind: BindingKind::StorageRead, ty: "array<array<vec4<f32>, 3>>", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 2, name: "relievo_instances", kind: BindingKind::StorageRead, ty: "array<relievo_SceneInstance>", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 3, name: "relievo_last_instances", kind: BindingKind::StorageRead, ty: "array<relievo_SceneInstance>", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 4, name: "relievo_shadow_map", kind: BindingKind::DepthTexture, ty: "texture_depth_2d", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 5, name: "relievo_shadow_sampler", kind: BindingKind::ComparisonSampler, ty: "sampler_comparison", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 6, name: "relievo_last_decisions", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 0, name: "relievo_scene_object", kind: BindingKind::Uniform, ty: "relievo_SceneObject", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 1, binding: 1, name: "relievo_vertices", kind: BindingKind::StorageRead, ty: "array<vec2<f32>>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 2, name: "relievo_texture_coordinates", kind: BindingKind::StorageRead, ty: "array<vec2<f32>>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 3, name: "relievo_material_of", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 4, name: "relievo_page_table", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 5, name: "relievo_mesh", kind: BindingKind::Uniform, ty: "relievo_MeshParams", stages: &[Stage::Vertex] },
        Binding { group: 2, binding: 0, name: "relievo_materials", kind: BindingKind::StorageRead, ty: "array<relievo_SceneMaterial>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 1, name: "relievo_albedo", kind: BindingKind::TextureArray, ty: "texture_2d_array<f32>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 2, name: "relievo_normals", kind: BindingKind::TextureArray, ty: "texture_2d_array<f32>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 3, name: "relievo_filtering", kind: BindingKind::Sampler, ty: "sampler", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 4, name: "relievo_normal_filtering", kind: BindingKind::Sampler, ty: "sampler", stages: &[Stage::Fragment] },
    ],
    overrides: &[
        Override { name: "relievo_SHADOWED", ty: "bool", default: 0.0 },
        Override { name: "relievo_FADE", ty: "u32", default: 0.0 },
        Override { name: "relievo_DOUBLE_SIDED", ty: "bool", default: 0.0 },
        Override { name: "relievo_TEXTURED", ty: "bool", default: 0.0 },
        Override { name: "relievo_NORMAL_MAPPED", ty: "bool", default: 0.0 },
        Override { name: "relievo_MORPHED", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "relievo_SceneInstance", size: 80, members: &[Member { name: "cell", offset: 0, ty: "vec3<i32>" }, Member { name: "flags", offset: 12, ty: "u32" }, Member { name: "offset", offset: 16, ty: "vec3<f32>" }, Member { name: "user_data", offset: 28, ty: "u32" }, Member { name: "rotation", offset: 32, ty: "vec4<f32>" }, Member { name: "scale", offset: 48, ty: "vec3<f32>" }, Member { name: "tint", offset: 60, ty: "u32" }, Member { name: "bounding_sphere", offset: 64, ty: "vec4<f32>" }] },
        Struct { name: "relievo_Axes", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec3<f32>" }, Member { name: "y", offset: 16, ty: "vec3<f32>" }, Member { name: "z", offset: 32, ty: "vec3<f32>" }] },
        Struct { name: "relievo_LodObject", size: 160, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "levels", offset: 8, ty: "u32" }, Member { name: "first_list", offset: 12, ty: "u32" }, Member { name: "first_draw", offset: 16, ty: "u32" }, Member { name: "parts", offset: 20, ty: "u32" }, Member { name: "metric_scale", offset: 24, ty: "f32" }, Member { name: "flags", offset: 28, ty: "u32" }, Member { name: "thresholds", offset: 32, ty: "array<vec4<f32>, 2>" }, Member { name: "finer", offset: 64, ty: "f32" }, Member { name: "coarser", offset: 68, ty: "f32" }, Member { name: "rate", offset: 72, ty: "f32" }, Member { name: "motion", offset: 76, ty: "f32" }, Member { name: "point", offset: 80, ty: "vec3<f32>" }, Member { name: "periphery", offset: 92, ty: "f32" }, Member { name: "half_size", offset: 96, ty: "vec3<f32>" }, Member { name: "rank", offset: 108, ty: "u32" }, Member { name: "fade_begin", offset: 112, ty: "f32" }, Member { name: "fade_end", offset: 116, ty: "f32" }, Member { name: "metric_floor", offset: 120, ty: "f32" }, Member { name: "unused", offset: 124, ty: "u32" }, Member { name: "triangles", offset: 128, ty: "array<vec4<u32>, 2>" }] },
        Struct { name: "relievo_SceneDraw", size: 20, members: &[Member { name: "index_count", offset: 0, ty: "u32" }, Member { name: "instance_count", offset: 4, ty: "u32" }, Member { name: "first_index", offset: 8, ty: "u32" }, Member { name: "base_vertex", offset: 12, ty: "u32" }, Member { name: "first_instance", offset: 16, ty: "u32" }] },
        Struct { name: "relievo_ColorTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_TransparentTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "Surface", size: 208, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "geometric_normal", offset: 32, ty: "vec3<f32>" }, Member { name: "uv", offset: 48, ty: "vec2<f32>" }, Member { name: "color", offset: 64, ty: "vec3<f32>" }, Member { name: "alpha", offset: 76, ty: "f32" }, Member { name: "sunlit", offset: 80, ty: "f32" }, Member { name: "tint", offset: 96, ty: "vec4<f32>" }, Member { name: "user_data", offset: 112, ty: "u32" }, Member { name: "object", offset: 116, ty: "u32" }, Member { name: "instance", offset: 120, ty: "u32" }, Member { name: "pixel", offset: 128, ty: "vec2<f32>" }, Member { name: "unlit", offset: 144, ty: "vec4<f32>" }, Member { name: "light_position", offset: 160, ty: "vec3<f32>" }, Member { name: "last_position", offset: 176, ty: "vec3<f32>" }, Member { name: "cutoff", offset: 188, ty: "f32" }, Member { name: "depth", offset: 192, ty: "f32" }, Member { name: "level", offset: 196, ty: "u32" }, Member { name: "fade", offset: 200, ty: "f32" }] },
        Struct { name: "relievo_SceneView", size: 256, members: &[Member { name: "clip_from_world", offset: 0, ty: "mat4x4<f32>" }, Member { name: "last_clip_from_world", offset: 64, ty: "mat4x4<f32>" }, Member { name: "eye", offset: 128, ty: "vec4<f32>" }, Member { name: "light", offset: 144, ty: "vec4<f32>" }, Member { name: "light_color", offset: 160, ty: "vec3<f32>" }, Member { name: "side", offset: 172, ty: "f32" }, Member { name: "cell", offset: 176, ty: "vec3<i32>" }, Member { name: "shadow_texel", offset: 188, ty: "f32" }, Member { name: "shadow_rows", offset: 192, ty: "array<vec4<f32>, 3>" }, Member { name: "dither_offset", offset: 240, ty: "vec2<u32>" }] },
        Struct { name: "View", size: 128, members: &[Member { name: "clip_from_world", offset: 0, ty: "mat4x4<f32>" }, Member { name: "eye", offset: 64, ty: "vec4<f32>" }, Member { name: "cell", offset: 80, ty: "vec3<i32>" }, Member { name: "ambient", offset: 92, ty: "f32" }, Member { name: "light", offset: 96, ty: "vec3<f32>" }, Member { name: "light_color", offset: 112, ty: "vec3<f32>" }] },
        Struct { name: "relievo_LevelsTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_MeasureTargets", size: 32, members: &[Member { name: "position", offset: 0, ty: "vec4<f32>" }, Member { name: "id", offset: 16, ty: "vec2<u32>" }] },
        Struct { name: "relievo_SurfaceTargets", size: 48, members: &[Member { name: "normal", offset: 0, ty: "vec4<f32>" }, Member { name: "albedo", offset: 16, ty: "vec4<f32>" }, Member { name: "id", offset: 32, ty: "vec2<u32>" }] },
        Struct { name: "relievo_VelocityTargets", size: 16, members: &[Member { name: "velocity", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_SceneObject", size: 48, members: &[Member { name: "first_instance", offset: 0, ty: "u32" }, Member { name: "number", offset: 4, ty: "u32" }, Member { name: "first_slot", offset: 8, ty: "u32" }, Member { name: "push", offset: 16, ty: "array<vec4<f32>, 2>" }] },
        Struct { name: "relievo_Rows", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec4<f32>" }, Member { name: "y", offset: 16, ty: "vec4<f32>" }, Member { name: "z", offset: 32, ty: "vec4<f32>" }] },
        Struct { name: "relievo_SceneVertex", size: 96, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "tangent", offset: 32, ty: "vec4<f32>" }, Member { name: "uv", offset: 48, ty: "vec4<f32>" }, Member { name: "values", offset: 64, ty: "vec4<f32>" }, Member { name: "words", offset: 80, ty: "vec3<u32>" }, Member { name: "side", offset: 92, ty: "f32" }] },
        Struct { name: "relievo_SceneFragment", size: 144, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "tangent", offset: 32, ty: "vec4<f32>" }, Member { name: "uv", offset: 48, ty: "vec4<f32>" }, Member { name: "values", offset: 64, ty: "vec4<f32>" }, Member { name: "words", offset: 80, ty: "vec3<u32>" }, Member { name: "instance", offset: 92, ty: "u32" }, Member { name: "last_position", offset: 96, ty: "vec3<f32>" }, Member { name: "clip", offset: 112, ty: "vec4<f32>" }, Member { name: "is_outside", offset: 128, ty: "bool" }, Member { name: "level", offset: 132, ty: "u32" }, Member { name: "fade", offset: 136, ty: "f32" }] },
        Struct { name: "relievo_SceneMaterial", size: 32, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }, Member { name: "cutoff", offset: 16, ty: "f32" }, Member { name: "layer", offset: 20, ty: "u32" }, Member { name: "normal_layer", offset: 24, ty: "u32" }, Member { name: "normal_scale", offset: 28, ty: "f32" }] },
        Struct { name: "relievo_MeshParams", size: 12, members: &[Member { name: "clusters", offset: 0, ty: "u32" }, Member { name: "last", offset: 4, ty: "u32" }, Member { name: "partners", offset: 8, ty: "u32" }] },
        Struct { name: "relievo_VertexMorph", size: 8, members: &[Member { name: "partner", offset: 0, ty: "u32" }, Member { name: "way", offset: 4, ty: "f32" }] },
        Struct { name: "relievo_LastMorph", size: 12, members: &[Member { name: "standing", offset: 0, ty: "u32" }, Member { name: "to", offset: 4, ty: "relievo_VertexMorph" }] },
        Struct { name: "relievo_Varyings", size: 112, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }, Member { name: "position", offset: 16, ty: "vec3<f32>" }, Member { name: "normal", offset: 32, ty: "vec3<f32>" }, Member { name: "tangent", offset: 48, ty: "vec4<f32>" }, Member { name: "uv", offset: 64, ty: "vec4<f32>" }, Member { name: "values", offset: 80, ty: "vec4<f32>" }, Member { name: "words", offset: 96, ty: "vec4<u32>" }] },
        Struct { name: "relievo_MovingVaryings", size: 128, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }, Member { name: "position", offset: 16, ty: "vec3<f32>" }, Member { name: "normal", offset: 32, ty: "vec3<f32>" }, Member { name: "tangent", offset: 48, ty: "vec4<f32>" }, Member { name: "uv", offset: 64, ty: "vec4<f32>" }, Member { name: "values", offset: 80, ty: "vec4<f32>" }, Member { name: "words", offset: 96, ty: "vec4<u32>" }, Member { name: "last", offset: 112, ty: "vec3<f32>" }] },
        Struct { name: "relievo_Position", size: 16, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }] },
    ],
};
/// `render/scene_relief`
pub static RENDER_SCENE_RELIEF: Shader = Shader {
    name: "render/scene_relief",
    source: include_str!(concat!(env!("OUT_DIR"), "/render_scene_relief.wgsl")),
    entry_points: &[
        EntryPoint { name: "relievo_vertex", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_vertex_moving", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_vertex_depth", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_depth", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_depth_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_depth_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_depth_cut_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_color", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_color_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_color_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_color_cut_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_levels", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_levels_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_levels_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_levels_cut_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_measure", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_measure_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_measure_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_measure_cut_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_surface", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_surface_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_surface_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_surface_cut_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_velocity", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_velocity_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_velocity_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_velocity_cut_deep", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "relievo_view", kind: BindingKind::Uniform, ty: "relievo_SceneView", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 1, name: "relievo_placements", kind: BindingKind::StorageRead, ty: "array<array<vec4<f32>, 3>>", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 2, name: "relievo_instances", kind: BindingKind::StorageRead, ty: "array<relievo_SceneInstance>", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 3, name: "relievo_last_instances", kind: BindingKind::StorageRead, ty: "array<relievo_SceneInstance>", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 4, name: "relievo_shadow_map", kind: BindingKind::DepthTexture, ty: "texture_depth_2d", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 5, name: "relievo_shadow_sampler", kind: BindingKind::ComparisonSampler, ty: "sampler_comparison", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 6, name: "relievo_last_decisions", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 0, name: "relievo_scene_object", kind: BindingKind::Uniform, ty: "relievo_SceneObject", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 1, binding: 1, name: "relievo_vertices", kind: BindingKind::StorageRead, ty: "array<vec2<f32>>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 2, name: "relievo_texture_coordinates", kind: BindingKind::StorageRead, ty: "array<vec2<f32>>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 3, name: "relievo_material_of", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 4, name: "relievo_page_table", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Vertex] },
        Binding { group: 1, binding: 5, name: "relievo_mesh", kind: BindingKind::Uniform, ty: "relievo_MeshParams", stages: &[Stage::Vertex] },
        Binding { group: 2, binding: 0, name: "relievo_relief", kind: BindingKind::Uniform, ty: "relievo_ReliefParams", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 2, binding: 1, name: "relievo_march", kind: BindingKind::Uniform, ty: "relievo_SurfaceMarch", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 2, name: "relievo_heights", kind: BindingKind::LoadedTexture, ty: "texture_2d<f32>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 3, name: "relievo_acceleration", kind: BindingKind::LoadedTexture, ty: "texture_2d<f32>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 4, name: "relievo_albedo", kind: BindingKind::Texture, ty: "texture_2d<f32>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 5, name: "relievo_normals", kind: BindingKind::Texture, ty: "texture_2d<f32>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 6, name: "relievo_filtering", kind: BindingKind::Sampler, ty: "sampler", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 7, name: "relievo_normal_filtering", kind: BindingKind::Sampler, ty: "sampler", stages: &[Stage::Fragment] },
    ],
    overrides: &[
        Override { name: "relievo_SHADOWED", ty: "bool", default: 0.0 },
        Override { name: "relievo_OWN_DEPTH", ty: "bool", default: 0.0 },
        Override { name: "relievo_REVERSED", ty: "bool", default: 0.0 },
        Override { name: "relievo_FADE", ty: "u32", default: 0.0 },
        Override { name: "relievo_MORPHED", ty: "bool", default: 0.0 },
        Override { name: "relievo_METHOD", ty: "u32", default: 3.0 },
        Override { name: "relievo_SHADOW", ty: "u32", default: 0.0 },
        Override { name: "relievo_NORMAL_MAP", ty: "bool", default: 0.0 },
        Override { name: "relievo_GREEN_UP", ty: "bool", default: 1.0 },
        Override { name: "relievo_SILHOUETTE", ty: "bool", default: 0.0 },
        Override { name: "relievo_CHOOSE_MIP", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "relievo_SceneInstance", size: 80, members: &[Member { name: "cell", offset: 0, ty: "vec3<i32>" }, Member { name: "flags", offset: 12, ty: "u32" }, Member { name: "offset", offset: 16, ty: "vec3<f32>" }, Member { name: "user_data", offset: 28, ty: "u32" }, Member { name: "rotation", offset: 32, ty: "vec4<f32>" }, Member { name: "scale", offset: 48, ty: "vec3<f32>" }, Member { name: "tint", offset: 60, ty: "u32" }, Member { name: "bounding_sphere", offset: 64, ty: "vec4<f32>" }] },
        Struct { name: "relievo_Axes", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec3<f32>" }, Member { name: "y", offset: 16, ty: "vec3<f32>" }, Member { name: "z", offset: 32, ty: "vec3<f32>" }] },
        Struct { name: "relievo_LodObject", size: 160, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "levels", offset: 8, ty: "u32" }, Member { name: "first_list", offset: 12, ty: "u32" }, Member { name: "first_draw", offset: 16, ty: "u32" }, Member { name: "parts", offset: 20, ty: "u32" }, Member { name: "metric_scale", offset: 24, ty: "f32" }, Member { name: "flags", offset: 28, ty: "u32" }, Member { name: "thresholds", offset: 32, ty: "array<vec4<f32>, 2>" }, Member { name: "finer", offset: 64, ty: "f32" }, Member { name: "coarser", offset: 68, ty: "f32" }, Member { name: "rate", offset: 72, ty: "f32" }, Member { name: "motion", offset: 76, ty: "f32" }, Member { name: "point", offset: 80, ty: "vec3<f32>" }, Member { name: "periphery", offset: 92, ty: "f32" }, Member { name: "half_size", offset: 96, ty: "vec3<f32>" }, Member { name: "rank", offset: 108, ty: "u32" }, Member { name: "fade_begin", offset: 112, ty: "f32" }, Member { name: "fade_end", offset: 116, ty: "f32" }, Member { name: "metric_floor", offset: 120, ty: "f32" }, Member { name: "unused", offset: 124, ty: "u32" }, Member { name: "triangles", offset: 128, ty: "array<vec4<u32>, 2>" }] },
        Struct { name: "relievo_SceneDraw", size: 20, members: &[Member { name: "index_count", offset: 0, ty: "u32" }, Member { name: "instance_count", offset: 4, ty: "u32" }, Member { name: "first_index", offset: 8, ty: "u32" }, Member { name: "base_vertex", offset: 12, ty: "u32" }, Member { name: "first_instance", offset: 16, ty: "u32" }] },
        Struct { name: "relievo_ColorTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_TransparentTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "Surface", size: 208, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "geometric_normal", offset: 32, ty: "vec3<f32>" }, Member { name: "uv", offset: 48, ty: "vec2<f32>" }, Member { name: "color", offset: 64, ty: "vec3<f32>" }, Member { name: "alpha", offset: 76, ty: "f32" }, Member { name: "sunlit", offset: 80, ty: "f32" }, Member { name: "tint", offset: 96, ty: "vec4<f32>" }, Member { name: "user_data", offset: 112, ty: "u32" }, Member { name: "object", offset: 116, ty: "u32" }, Member { name: "instance", offset: 120, ty: "u32" }, Member { name: "pixel", offset: 128, ty: "vec2<f32>" }, Member { name: "unlit", offset: 144, ty: "vec4<f32>" }, Member { name: "light_position", offset: 160, ty: "vec3<f32>" }, Member { name: "last_position", offset: 176, ty: "vec3<f32>" }, Member { name: "cutoff", offset: 188, ty: "f32" }, Member { name: "depth", offset: 192, ty: "f32" }, Member { name: "level", offset: 196, ty: "u32" }, Member { name: "fade", offset: 200, ty: "f32" }] },
        Struct { name: "relievo_SceneView", size: 256, members: &[Member { name: "clip_from_world", offset: 0, ty: "mat4x4<f32>" }, Member { name: "last_clip_from_world", offset: 64, ty: "mat4x4<f32>" }, Member { name: "eye", offset: 128, ty: "vec4<f32>" }, Member { name: "light", offset: 144, ty: "vec4<f32>" }, Member { name: "light_color", offset: 160, ty: "vec3<f32>" }, Member { name: "side", offset: 172, ty: "f32" }, Member { name: "cell", offset: 176, ty: "vec3<i32>" }, Member { name: "shadow_texel", offset: 188, ty: "f32" }, Member { name: "shadow_rows", offset: 192, ty: "array<vec4<f32>, 3>" }, Member { name: "dither_offset", offset: 240, ty: "vec2<u32>" }] },
        Struct { name: "View", size: 128, members: &[Member { name: "clip_from_world", offset: 0, ty: "mat4x4<f32>" }, Member { name: "eye", offset: 64, ty: "vec4<f32>" }, Member { name: "cell", offset: 80, ty: "vec3<i32>" }, Member { name: "ambient", offset: 92, ty: "f32" }, Member { name: "light", offset: 96, ty: "vec3<f32>" }, Member { name: "light_color", offset: 112, ty: "vec3<f32>" }] },
        Struct { name: "relievo_LevelsTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_MeasureTargets", size: 32, members: &[Member { name: "position", offset: 0, ty: "vec4<f32>" }, Member { name: "id", offset: 16, ty: "vec2<u32>" }] },
        Struct { name: "relievo_SurfaceTargets", size: 48, members: &[Member { name: "normal", offset: 0, ty: "vec4<f32>" }, Member { name: "albedo", offset: 16, ty: "vec4<f32>" }, Member { name: "id", offset: 32, ty: "vec2<u32>" }] },
        Struct { name: "relievo_VelocityTargets", size: 16, members: &[Member { name: "velocity", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_SceneObject", size: 48, members: &[Member { name: "first_instance", offset: 0, ty: "u32" }, Member { name: "number", offset: 4, ty: "u32" }, Member { name: "first_slot", offset: 8, ty: "u32" }, Member { name: "push", offset: 16, ty: "array<vec4<f32>, 2>" }] },
        Struct { name: "relievo_Rows", size: 48, members: &[Member { name: "x", offset: 0, ty: "vec4<f32>" }, Member { name: "y", offset: 16, ty: "vec4<f32>" }, Member { name: "z", offset: 32, ty: "vec4<f32>" }] },
        Struct { name: "relievo_SceneVertex", size: 96, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "tangent", offset: 32, ty: "vec4<f32>" }, Member { name: "uv", offset: 48, ty: "vec4<f32>" }, Member { name: "values", offset: 64, ty: "vec4<f32>" }, Member { name: "words", offset: 80, ty: "vec3<u32>" }, Member { name: "side", offset: 92, ty: "f32" }] },
        Struct { name: "relievo_SceneFragment", size: 144, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "tangent", offset: 32, ty: "vec4<f32>" }, Member { name: "uv", offset: 48, ty: "vec4<f32>" }, Member { name: "values", offset: 64, ty: "vec4<f32>" }, Member { name: "words", offset: 80, ty: "vec3<u32>" }, Member { name: "instance", offset: 92, ty: "u32" }, Member { name: "last_position", offset: 96, ty: "vec3<f32>" }, Member { name: "clip", offset: 112, ty: "vec4<f32>" }, Member { name: "is_outside", offset: 128, ty: "bool" }, Member { name: "level", offset: 132, ty: "u32" }, Member { name: "fade", offset: 136, ty: "f32" }] },
        Struct { name: "relievo_MeshParams", size: 12, members: &[Member { name: "clusters", offset: 0, ty: "u32" }, Member { name: "last", offset: 4, ty: "u32" }, Member { name: "partners", offset: 8, ty: "u32" }] },
        Struct { name: "relievo_VertexMorph", size: 8, members: &[Member { name: "partner", offset: 0, ty: "u32" }, Member { name: "way", offset: 4, ty: "f32" }] },
        Struct { name: "relievo_LastMorph", size: 12, members: &[Member { name: "standing", offset: 0, ty: "u32" }, Member { name: "to", offset: 4, ty: "relievo_VertexMorph" }] },
        Struct { name: "relievo_ReliefParams", size: 64, members: &[Member { name: "range", offset: 0, ty: "vec4<f32>" }, Member { name: "color", offset: 16, ty: "vec4<f32>" }, Member { name: "scale", offset: 32, ty: "f32" }, Member { name: "plane", offset: 36, ty: "f32" }, Member { name: "world", offset: 40, ty: "f32" }, Member { name: "shadow_steps", offset: 44, ty: "u32" }, Member { name: "softness", offset: 48, ty: "f32" }] },
        Struct { name: "relievo_SurfaceMarch", size: 20, members: &[Member { name: "address", offset: 0, ty: "u32" }, Member { name: "min_steps", offset: 4, ty: "u32" }, Member { name: "max_steps", offset: 8, ty: "u32" }, Member { name: "binary_steps", offset: 12, ty: "u32" }, Member { name: "mip", offset: 16, ty: "u32" }] },
        Struct { name: "relievo_Frame", size: 48, members: &[Member { name: "tangent", offset: 0, ty: "vec3<f32>" }, Member { name: "bitangent", offset: 16, ty: "vec3<f32>" }, Member { name: "normal", offset: 32, ty: "vec3<f32>" }] },
        Struct { name: "relievo_SurfaceHit", size: 24, members: &[Member { name: "uv", offset: 0, ty: "vec2<f32>" }, Member { name: "height", offset: 8, ty: "f32" }, Member { name: "parameter", offset: 12, ty: "f32" }, Member { name: "samples", offset: 16, ty: "u32" }, Member { name: "outcome_code", offset: 20, ty: "u32" }] },
        Struct { name: "relievo_Traced", size: 144, members: &[Member { name: "hit", offset: 0, ty: "relievo_SurfaceHit" }, Member { name: "frame", offset: 32, ty: "relievo_Frame" }, Member { name: "settings", offset: 80, ty: "relievo_SurfaceMarch" }, Member { name: "position", offset: 112, ty: "vec3<f32>" }, Member { name: "depth", offset: 124, ty: "f32" }, Member { name: "is_outside", offset: 128, ty: "bool" }] },
        Struct { name: "relievo_SurfaceRay", size: 24, members: &[Member { name: "origin", offset: 0, ty: "vec2<f32>" }, Member { name: "slope", offset: 8, ty: "vec2<f32>" }, Member { name: "cosine", offset: 16, ty: "f32" }, Member { name: "polygon", offset: 20, ty: "f32" }] },
        Struct { name: "relievo_SurfaceBracket", size: 20, members: &[Member { name: "above", offset: 0, ty: "f32" }, Member { name: "under", offset: 4, ty: "f32" }, Member { name: "height_above", offset: 8, ty: "f32" }, Member { name: "height_under", offset: 12, ty: "f32" }, Member { name: "samples", offset: 16, ty: "u32" }] },
        Struct { name: "relievo_SurfaceGrid", size: 64, members: &[Member { name: "size", offset: 0, ty: "vec2<i32>" }, Member { name: "cells", offset: 8, ty: "vec2<i32>" }, Member { name: "base", offset: 16, ty: "vec2<i32>" }, Member { name: "start", offset: 24, ty: "vec2<f32>" }, Member { name: "tiles", offset: 32, ty: "vec2<f32>" }, Member { name: "travel", offset: 40, ty: "vec2<f32>" }, Member { name: "inverse", offset: 48, ty: "vec2<f32>" }, Member { name: "address", offset: 56, ty: "u32" }] },
        Struct { name: "relievo_SurfaceNode", size: 24, members: &[Member { name: "index", offset: 0, ty: "vec2<i32>" }, Member { name: "low", offset: 8, ty: "vec2<i32>" }, Member { name: "high", offset: 16, ty: "vec2<i32>" }] },
        Struct { name: "relievo_SurfaceShadow", size: 12, members: &[Member { name: "scale", offset: 0, ty: "f32" }, Member { name: "steps", offset: 4, ty: "u32" }, Member { name: "softness", offset: 8, ty: "f32" }] },
        Struct { name: "relievo_Varyings", size: 112, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }, Member { name: "position", offset: 16, ty: "vec3<f32>" }, Member { name: "normal", offset: 32, ty: "vec3<f32>" }, Member { name: "tangent", offset: 48, ty: "vec4<f32>" }, Member { name: "uv", offset: 64, ty: "vec4<f32>" }, Member { name: "values", offset: 80, ty: "vec4<f32>" }, Member { name: "words", offset: 96, ty: "vec4<u32>" }] },
        Struct { name: "relievo_MovingVaryings", size: 128, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }, Member { name: "position", offset: 16, ty: "vec3<f32>" }, Member { name: "normal", offset: 32, ty: "vec3<f32>" }, Member { name: "tangent", offset: 48, ty: "vec4<f32>" }, Member { name: "uv", offset: 64, ty: "vec4<f32>" }, Member { name: "values", offset: 80, ty: "vec4<f32>" }, Member { name: "words", offset: 96, ty: "vec4<u32>" }, Member { name: "last", offset: 112, ty: "vec3<f32>" }] },
        Struct { name: "relievo_Position", size: 16, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_color_deep_targets", size: 32, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }, Member { name: "depth", offset: 16, ty: "f32" }] },
        Struct { name: "relievo_color_cut_deep_targets", size: 32, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }, Member { name: "depth", offset: 16, ty: "f32" }] },
        Struct { name: "relievo_levels_deep_targets", size: 32, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }, Member { name: "depth", offset: 16, ty: "f32" }] },
        Struct { name: "relievo_levels_cut_deep_targets", size: 32, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }, Member { name: "depth", offset: 16, ty: "f32" }] },
        Struct { name: "relievo_measure_deep_targets", size: 32, members: &[Member { name: "position", offset: 0, ty: "vec4<f32>" }, Member { name: "id", offset: 16, ty: "vec2<u32>" }, Member { name: "depth", offset: 24, ty: "f32" }] },
        Struct { name: "relievo_measure_cut_deep_targets", size: 32, members: &[Member { name: "position", offset: 0, ty: "vec4<f32>" }, Member { name: "id", offset: 16, ty: "vec2<u32>" }, Member { name: "depth", offset: 24, ty: "f32" }] },
        Struct { name: "relievo_surface_deep_targets", size: 48, members: &[Member { name: "normal", offset: 0, ty: "vec4<f32>" }, Member { name: "albedo", offset: 16, ty: "vec4<f32>" }, Member { name: "id", offset: 32, ty: "vec2<u32>" }, Member { name: "depth", offset: 40, ty: "f32" }] },
        Struct { name: "relievo_surface_cut_deep_targets", size: 48, members: &[Member { name: "normal", offset: 0, ty: "vec4<f32>" }, Member { name: "albedo", offset: 16, ty: "vec4<f32>" }, Member { name: "id", offset: 32, ty: "vec2<u32>" }, Member { name: "depth", offset: 40, ty: "f32" }] },
        Struct { name: "relievo_velocity_deep_targets", size: 32, members: &[Member { name: "velocity", offset: 0, ty: "vec4<f32>" }, Member { name: "depth", offset: 16, ty: "f32" }] },
        Struct { name: "relievo_velocity_cut_deep_targets", size: 32, members: &[Member { name: "velocity", offset: 0, ty: "vec4<f32>" }, Member { name: "depth", offset: 16, ty: "f32" }] },
    ],
};
/// `render/scene_terrain`
pub static RENDER_SCENE_TERRAIN: Shader = Shader {
    name: "render/scene_terrain",
    source: include_str!(concat!(env!("OUT_DIR"), "/render_scene_terrain.wgsl")),
    entry_points: &[
        EntryPoint { name: "relievo_vertex", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_vertex_moving", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_vertex_depth", stage: Stage::Vertex, workgroup_size: [0, 0, 0], inputs: &[Input { location: 0, name: "entry", ty: "u32" }] },
        EntryPoint { name: "relievo_depth", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_depth_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_color", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_color_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_levels", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_levels_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_measure", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_measure_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_surface", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_surface_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_velocity", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
        EntryPoint { name: "relievo_velocity_cut", stage: Stage::Fragment, workgroup_size: [0, 0, 0], inputs: &[] },
    ],
    bindings: &[
        Binding { group: 0, binding: 0, name: "relievo_view", kind: BindingKind::Uniform, ty: "relievo_SceneView", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 4, name: "relievo_shadow_map", kind: BindingKind::DepthTexture, ty: "texture_depth_2d", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 0, binding: 5, name: "relievo_shadow_sampler", kind: BindingKind::ComparisonSampler, ty: "sampler_comparison", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 1, binding: 0, name: "relievo_ground", kind: BindingKind::Uniform, ty: "relievo_TerrainView", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 1, binding: 1, name: "relievo_nodes", kind: BindingKind::StorageRead, ty: "array<relievo_TerrainNode>", stages: &[Stage::Vertex] },
        Binding { group: 2, binding: 0, name: "relievo_terrain", kind: BindingKind::Uniform, ty: "relievo_TerrainParams", stages: &[Stage::Vertex, Stage::Fragment] },
        Binding { group: 2, binding: 1, name: "relievo_heights", kind: BindingKind::StorageRead, ty: "array<i32>", stages: &[Stage::Vertex] },
        Binding { group: 2, binding: 2, name: "relievo_patches", kind: BindingKind::StorageRead, ty: "array<relievo_TerrainPatch>", stages: &[Stage::Vertex] },
        Binding { group: 2, binding: 3, name: "relievo_zones", kind: BindingKind::StorageRead, ty: "array<relievo_Zone>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 4, name: "relievo_textures", kind: BindingKind::TextureArray, ty: "texture_2d_array<f32>", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 5, name: "relievo_texture_sampler", kind: BindingKind::Sampler, ty: "sampler", stages: &[Stage::Fragment] },
        Binding { group: 2, binding: 6, name: "relievo_holes", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Vertex] },
        Binding { group: 2, binding: 7, name: "relievo_normals", kind: BindingKind::StorageRead, ty: "array<u32>", stages: &[Stage::Fragment] },
    ],
    overrides: &[
        Override { name: "relievo_SHADOWED", ty: "bool", default: 0.0 },
        Override { name: "relievo_FADE", ty: "u32", default: 0.0 },
        Override { name: "relievo_WIREFRAME", ty: "bool", default: 0.0 },
    ],
    structs: &[
        Struct { name: "relievo_Allowed", size: 8, members: &[Member { name: "displacement", offset: 0, ty: "f32" }, Member { name: "distance", offset: 4, ty: "f32" }] },
        Struct { name: "relievo_LodCamera", size: 48, members: &[Member { name: "eye", offset: 0, ty: "vec3<f32>" }, Member { name: "focal", offset: 12, ty: "f32" }, Member { name: "ahead", offset: 16, ty: "vec3<f32>" }, Member { name: "pixels", offset: 28, ty: "f32" }, Member { name: "near", offset: 32, ty: "f32" }, Member { name: "perspective", offset: 36, ty: "f32" }, Member { name: "pixel_count", offset: 40, ty: "f32" }, Member { name: "unused", offset: 44, ty: "f32" }] },
        Struct { name: "relievo_LodObject", size: 160, members: &[Member { name: "first", offset: 0, ty: "u32" }, Member { name: "instances", offset: 4, ty: "u32" }, Member { name: "levels", offset: 8, ty: "u32" }, Member { name: "first_list", offset: 12, ty: "u32" }, Member { name: "first_draw", offset: 16, ty: "u32" }, Member { name: "parts", offset: 20, ty: "u32" }, Member { name: "metric_scale", offset: 24, ty: "f32" }, Member { name: "flags", offset: 28, ty: "u32" }, Member { name: "thresholds", offset: 32, ty: "array<vec4<f32>, 2>" }, Member { name: "finer", offset: 64, ty: "f32" }, Member { name: "coarser", offset: 68, ty: "f32" }, Member { name: "rate", offset: 72, ty: "f32" }, Member { name: "motion", offset: 76, ty: "f32" }, Member { name: "point", offset: 80, ty: "vec3<f32>" }, Member { name: "periphery", offset: 92, ty: "f32" }, Member { name: "half_size", offset: 96, ty: "vec3<f32>" }, Member { name: "rank", offset: 108, ty: "u32" }, Member { name: "fade_begin", offset: 112, ty: "f32" }, Member { name: "fade_end", offset: 116, ty: "f32" }, Member { name: "metric_floor", offset: 120, ty: "f32" }, Member { name: "unused", offset: 124, ty: "u32" }, Member { name: "triangles", offset: 128, ty: "array<vec4<u32>, 2>" }] },
        Struct { name: "relievo_SceneDraw", size: 20, members: &[Member { name: "index_count", offset: 0, ty: "u32" }, Member { name: "instance_count", offset: 4, ty: "u32" }, Member { name: "first_index", offset: 8, ty: "u32" }, Member { name: "base_vertex", offset: 12, ty: "u32" }, Member { name: "first_instance", offset: 16, ty: "u32" }] },
        Struct { name: "relievo_SelectView", size: 432, members: &[Member { name: "planes", offset: 0, ty: "array<vec4<f32>, 6>" }, Member { name: "cameras", offset: 96, ty: "array<relievo_LodCamera, 4>" }, Member { name: "cell", offset: 288, ty: "vec3<i32>" }, Member { name: "mask", offset: 300, ty: "u32" }, Member { name: "camera_count", offset: 304, ty: "u32" }, Member { name: "is_first", offset: 308, ty: "u32" }, Member { name: "casters", offset: 312, ty: "u32" }, Member { name: "blocks", offset: 316, ty: "u32" }, Member { name: "is_next", offset: 320, ty: "u32" }, Member { name: "seconds", offset: 324, ty: "f32" }, Member { name: "unused_a", offset: 328, ty: "u32" }, Member { name: "unused_b", offset: 332, ty: "u32" }, Member { name: "clip_rows", offset: 336, ty: "array<vec4<f32>, 3>" }, Member { name: "last_clip_rows", offset: 384, ty: "array<vec4<f32>, 3>" }] },
        Struct { name: "relievo_ColorTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_TransparentTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "Surface", size: 208, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "geometric_normal", offset: 32, ty: "vec3<f32>" }, Member { name: "uv", offset: 48, ty: "vec2<f32>" }, Member { name: "color", offset: 64, ty: "vec3<f32>" }, Member { name: "alpha", offset: 76, ty: "f32" }, Member { name: "sunlit", offset: 80, ty: "f32" }, Member { name: "tint", offset: 96, ty: "vec4<f32>" }, Member { name: "user_data", offset: 112, ty: "u32" }, Member { name: "object", offset: 116, ty: "u32" }, Member { name: "instance", offset: 120, ty: "u32" }, Member { name: "pixel", offset: 128, ty: "vec2<f32>" }, Member { name: "unlit", offset: 144, ty: "vec4<f32>" }, Member { name: "light_position", offset: 160, ty: "vec3<f32>" }, Member { name: "last_position", offset: 176, ty: "vec3<f32>" }, Member { name: "cutoff", offset: 188, ty: "f32" }, Member { name: "depth", offset: 192, ty: "f32" }, Member { name: "level", offset: 196, ty: "u32" }, Member { name: "fade", offset: 200, ty: "f32" }] },
        Struct { name: "relievo_SceneView", size: 256, members: &[Member { name: "clip_from_world", offset: 0, ty: "mat4x4<f32>" }, Member { name: "last_clip_from_world", offset: 64, ty: "mat4x4<f32>" }, Member { name: "eye", offset: 128, ty: "vec4<f32>" }, Member { name: "light", offset: 144, ty: "vec4<f32>" }, Member { name: "light_color", offset: 160, ty: "vec3<f32>" }, Member { name: "side", offset: 172, ty: "f32" }, Member { name: "cell", offset: 176, ty: "vec3<i32>" }, Member { name: "shadow_texel", offset: 188, ty: "f32" }, Member { name: "shadow_rows", offset: 192, ty: "array<vec4<f32>, 3>" }, Member { name: "dither_offset", offset: 240, ty: "vec2<u32>" }] },
        Struct { name: "View", size: 128, members: &[Member { name: "clip_from_world", offset: 0, ty: "mat4x4<f32>" }, Member { name: "eye", offset: 64, ty: "vec4<f32>" }, Member { name: "cell", offset: 80, ty: "vec3<i32>" }, Member { name: "ambient", offset: 92, ty: "f32" }, Member { name: "light", offset: 96, ty: "vec3<f32>" }, Member { name: "light_color", offset: 112, ty: "vec3<f32>" }] },
        Struct { name: "relievo_LevelsTargets", size: 16, members: &[Member { name: "color", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_MeasureTargets", size: 32, members: &[Member { name: "position", offset: 0, ty: "vec4<f32>" }, Member { name: "id", offset: 16, ty: "vec2<u32>" }] },
        Struct { name: "relievo_SurfaceTargets", size: 48, members: &[Member { name: "normal", offset: 0, ty: "vec4<f32>" }, Member { name: "albedo", offset: 16, ty: "vec4<f32>" }, Member { name: "id", offset: 32, ty: "vec2<u32>" }] },
        Struct { name: "relievo_VelocityTargets", size: 16, members: &[Member { name: "velocity", offset: 0, ty: "vec4<f32>" }] },
        Struct { name: "relievo_SceneVertex", size: 96, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "tangent", offset: 32, ty: "vec4<f32>" }, Member { name: "uv", offset: 48, ty: "vec4<f32>" }, Member { name: "values", offset: 64, ty: "vec4<f32>" }, Member { name: "words", offset: 80, ty: "vec3<u32>" }, Member { name: "side", offset: 92, ty: "f32" }] },
        Struct { name: "relievo_SceneFragment", size: 144, members: &[Member { name: "position", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }, Member { name: "tangent", offset: 32, ty: "vec4<f32>" }, Member { name: "uv", offset: 48, ty: "vec4<f32>" }, Member { name: "values", offset: 64, ty: "vec4<f32>" }, Member { name: "words", offset: 80, ty: "vec3<u32>" }, Member { name: "instance", offset: 92, ty: "u32" }, Member { name: "last_position", offset: 96, ty: "vec3<f32>" }, Member { name: "clip", offset: 112, ty: "vec4<f32>" }, Member { name: "is_outside", offset: 128, ty: "bool" }, Member { name: "level", offset: 132, ty: "u32" }, Member { name: "fade", offset: 136, ty: "f32" }] },
        Struct { name: "relievo_TerrainFrame", size: 208, members: &[Member { name: "cameras", offset: 0, ty: "array<relievo_LodCamera, 4>" }, Member { name: "camera_count", offset: 192, ty: "u32" }, Member { name: "fraction", offset: 196, ty: "f32" }] },
        Struct { name: "relievo_TerrainView", size: 448, members: &[Member { name: "base", offset: 0, ty: "vec2<i32>" }, Member { name: "rest", offset: 16, ty: "vec3<f32>" }, Member { name: "object", offset: 28, ty: "u32" }, Member { name: "frames", offset: 32, ty: "array<relievo_TerrainFrame, 2>" }] },
        Struct { name: "relievo_TerrainNode", size: 32, members: &[Member { name: "borders", offset: 0, ty: "vec4<f32>" }, Member { name: "inner", offset: 16, ty: "f32" }, Member { name: "plain", offset: 20, ty: "u32" }, Member { name: "unused_b", offset: 24, ty: "f32" }, Member { name: "unused_c", offset: 28, ty: "f32" }] },
        Struct { name: "relievo_TerrainParams", size: 64, members: &[Member { name: "in_width", offset: 0, ty: "u32" }, Member { name: "size", offset: 4, ty: "u32" }, Member { name: "spacing", offset: 8, ty: "f32" }, Member { name: "run", offset: 12, ty: "f32" }, Member { name: "tiling", offset: 16, ty: "f32" }, Member { name: "tiles_per_unit", offset: 20, ty: "f32" }, Member { name: "zone_count", offset: 24, ty: "u32" }, Member { name: "additive", offset: 28, ty: "u32" }, Member { name: "planes", offset: 32, ty: "u32" }, Member { name: "variation", offset: 36, ty: "f32" }, Member { name: "first_patch", offset: 40, ty: "u32" }, Member { name: "normals_width", offset: 44, ty: "u32" }, Member { name: "relief_depth", offset: 48, ty: "f32" }, Member { name: "relief_distance", offset: 52, ty: "f32" }, Member { name: "erosion_depth", offset: 56, ty: "f32" }, Member { name: "unused", offset: 60, ty: "f32" }] },
        Struct { name: "relievo_TerrainPatch", size: 32, members: &[Member { name: "origin", offset: 0, ty: "vec2<i32>" }, Member { name: "uv", offset: 8, ty: "vec2<f32>" }, Member { name: "window", offset: 16, ty: "u32" }, Member { name: "level", offset: 20, ty: "u32" }, Member { name: "holes", offset: 24, ty: "u32" }, Member { name: "eroded", offset: 28, ty: "u32" }] },
        Struct { name: "relievo_Zone", size: 32, members: &[Member { name: "min", offset: 0, ty: "f32" }, Member { name: "max", offset: 4, ty: "f32" }, Member { name: "rise", offset: 8, ty: "vec2<f32>" }, Member { name: "fall", offset: 16, ty: "vec2<f32>" }, Member { name: "height_blend", offset: 24, ty: "f32" }, Member { name: "repeats", offset: 28, ty: "f32" }] },
        Struct { name: "relievo_Erosion", size: 8, members: &[Member { name: "offset", offset: 0, ty: "u32" }, Member { name: "weight", offset: 4, ty: "f32" }] },
        Struct { name: "relievo_GroundVertex", size: 48, members: &[Member { name: "at", offset: 0, ty: "vec2<u32>" }, Member { name: "coarse", offset: 8, ty: "f32" }, Member { name: "position", offset: 16, ty: "vec3<f32>" }, Member { name: "height", offset: 28, ty: "f32" }, Member { name: "gradient", offset: 32, ty: "vec2<f32>" }] },
        Struct { name: "relievo_Relief", size: 16, members: &[Member { name: "zone", offset: 0, ty: "u32" }, Member { name: "plane", offset: 4, ty: "u32" }, Member { name: "depth", offset: 8, ty: "f32" }, Member { name: "level", offset: 12, ty: "f32" }] },
        Struct { name: "relievo_Ground", size: 32, members: &[Member { name: "color", offset: 0, ty: "vec3<f32>" }, Member { name: "normal", offset: 16, ty: "vec3<f32>" }] },
        Struct { name: "relievo_ZoneBlend", size: 48, members: &[Member { name: "color", offset: 0, ty: "vec3<f32>" }, Member { name: "total", offset: 12, ty: "f32" }, Member { name: "weight", offset: 16, ty: "f32" }, Member { name: "nearest", offset: 32, ty: "vec3<f32>" }, Member { name: "distance", offset: 44, ty: "f32" }] },
        Struct { name: "relievo_Varyings", size: 112, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }, Member { name: "position", offset: 16, ty: "vec3<f32>" }, Member { name: "normal", offset: 32, ty: "vec3<f32>" }, Member { name: "tangent", offset: 48, ty: "vec4<f32>" }, Member { name: "uv", offset: 64, ty: "vec4<f32>" }, Member { name: "values", offset: 80, ty: "vec4<f32>" }, Member { name: "words", offset: 96, ty: "vec4<u32>" }] },
        Struct { name: "relievo_MovingVaryings", size: 128, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }, Member { name: "position", offset: 16, ty: "vec3<f32>" }, Member { name: "normal", offset: 32, ty: "vec3<f32>" }, Member { name: "tangent", offset: 48, ty: "vec4<f32>" }, Member { name: "uv", offset: 64, ty: "vec4<f32>" }, Member { name: "values", offset: 80, ty: "vec4<f32>" }, Member { name: "words", offset: 96, ty: "vec4<u32>" }, Member { name: "last", offset: 112, ty: "vec3<f32>" }] },
        Struct { name: "relievo_Position", size: 16, members: &[Member { name: "clip", offset: 0, ty: "vec4<f32>" }] },
    ],
};
/// What the texts of kinds stand beside, without entry points; its names have no prefix yet.
pub static SCENE_CORE: &str = include_str!(concat!(env!("OUT_DIR"), "/scene_core.wgsl"));
/// The outputs in it: name, and whether it needs motion.
pub static SCENE_OUTPUTS: &[(&str, bool)] = &[("color", false), ("transparent", false), ("levels", false), ("measure", false), ("surface", false), ("velocity", true)];
/// Every module for others' shaders.
pub static MODULES: &[Module] = &[Module { name: "animation", source: include_str!(concat!(env!("OUT_DIR"), "/module_animation.wgsl")) }, Module { name: "lod", source: include_str!(concat!(env!("OUT_DIR"), "/module_lod.wgsl")) }, Module { name: "skinning", source: include_str!(concat!(env!("OUT_DIR"), "/module_skinning.wgsl")) }, Module { name: "surface", source: include_str!(concat!(env!("OUT_DIR"), "/module_surface.wgsl")) }, Module { name: "terrain", source: include_str!(concat!(env!("OUT_DIR"), "/module_terrain.wgsl")) }];
/// Every shader of the crate.
pub static ALL: &[&Shader] = &[&ANIMATION_BOUNDS, &ANIMATION_BUDGET, &ANIMATION_CLIP_CLOCK, &ANIMATION_COMPACT, &ANIMATION_DRIVE, &ANIMATION_GATE, &ANIMATION_KEYFRAME_CURSOR, &ANIMATION_LOCAL_TO_MODEL, &ANIMATION_SAMPLE, &BASELINE_COPY, &BASELINE_GATHER, &BASELINE_LOADS, &BASELINE_TEXELS, &BASELINE_WORDS, &LOD_ASSIGN, &LOD_ATTACH, &LOD_BUDGET, &LOD_DECIDE, &LOD_LIST, &LOD_SELECT, &LOD_SORTED, &SKINNING_MORPH, &SKINNING_MORPH_WEIGHTS, &SKINNING_PAGES, &SKINNING_PALETTE, &SKINNING_SELECT, &SKINNING_SKIN, &SURFACE_CONE_MAP, &SURFACE_HEIGHT_PYRAMID, &SURFACE_RELIEF, &SURFACE_SHADE, &SURFACE_TANGENT, &TERRAIN_BLEND, &TERRAIN_BORDER, &TERRAIN_DESPIKE, &TERRAIN_HEIGHT, &TERRAIN_HYDRAULIC, &TERRAIN_LIMIT, &TERRAIN_MORPH, &TERRAIN_NODE, &TERRAIN_NODE_NORMALS, &TERRAIN_NOISE, &TERRAIN_NORMALS, &TERRAIN_PAD, &TERRAIN_REPLACE, &TERRAIN_SMOOTH, &TERRAIN_THERMAL, &TERRAIN_WRAP, &RENDER_SCENE_MESH, &RENDER_SCENE_RELIEF, &RENDER_SCENE_TERRAIN];
