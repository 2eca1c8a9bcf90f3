/// Of `animation/`.
pub mod animation {
/// Of `animation/bounds.wgsl`.
pub mod bounds {
/// Parameters of the kernel `animation/bounds`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct BoundsParams {
    /// Number of instances.
    pub instances: u32,
    /// Number of bones per instance.
    pub bones: u32,
}

/// Factor by which extents grow, to cover rounding errors.
pub const GROWTH: f32 = 1.0000019;

/// Length that is added to the length of a matrix row: 2⁻⁶². It is needed because devices may flush squares to 0.
pub const LEAST: f32 = 2.1684043e-19;

/// Fraction of the center's distance that is added to extents, to cover rounding errors.
pub const OF_CENTER: f32 = 4.7683716e-7;

/// Number of threads in a workgroup.
pub const THREADS: u32 = 64;
}
/// Of `animation/budget.wgsl`.
pub mod budget {
/// Parameters of the kernel `animation/budget`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct BudgetParams {
    /// Number of instances.
    pub instances: u32,
    /// Number of bones per instance.
    pub bones: u32,
    /// Number of 32-bit words per instance. Each bone has one bit.
    pub words: u32,
    /// Number of entries per row of the table.
    pub stride: u32,
    /// Largest number of bones that may be sampled in a frame.
    pub budget: u32,
    /// Number of clips.
    pub clips: u32,
    /// Number of skeleton tiers.
    pub tiers: u32,
}

/// Stage: one workgroup finds the lowest rank that is served.
pub const CHOOSE: u32 = 1;

/// Stage: a thread selects the bones above the lowest served rank and counts the bones of the lowest served rank.
pub const DECIDE: u32 = 2;

/// Index in `tally`: number of bones that must be sampled.
pub const FORCED: u32 = 1024;

/// Index in `tally`: the lowest rank that is served.
pub const LOWEST: u32 = 1025;

/// Stage: a thread ranks up to 32 bones of one instance and counts the ranks.
pub const RANK: u32 = 0;

/// Number of ranks; higher ranks are served first.
pub const RANKS: u32 = 1024;

/// Index in `tally`: number of bones of the lowest rank that the budget permits.
pub const ROOM: u32 = 1026;

/// Stage: a thread selects bones of the lowest served rank while the budget lasts.
pub const SETTLE: u32 = 4;

/// Stage: one workgroup computes prefix sums, over the instances, of the numbers of bones of the lowest served rank.
pub const SUM: u32 = 3;

/// Index in `tally`: number of bones of the lowest rank in the first instance. The numbers of the other instances follow.
pub const TIES: u32 = 1027;

/// Number of threads in a workgroup.
pub const WIDTH: u32 = 64;
}
/// Of `animation/clip.wgsl`.
pub mod clip {
/// Timeline number of a track whose value never changes.
pub const CONSTANT: u32 = 1073741823;

/// Location of a clip's data in a set of clips.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct ClipEntry {
    /// Index of the clip's first timeline.
    pub first_timeline: u32,
    /// Number of the clip's timelines.
    pub timelines: u32,
    /// Duration of the clip in seconds.
    pub duration: f32,
    /// Index of the clip's first row in gate tables. A clip has one row per time of its first timeline, and one row for the
    /// whole clip.
    pub first_row: u32,
}

/// A position between two keys of a timeline.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct KeyframeCursor {
    /// Index of the last key at or before the time, counted from the timeline's first key; 0 before the first key.
    pub key: u32,
    /// Fraction of the interval from `key` to the next key, 0 to below 1. The fraction is 0 before the first key and after the
    /// last.
    pub fraction: f32,
}

/// A track of a set of clips, in two words that one memory operation loads. Read the track with `timeline_of`,
/// `interpolation_of` and `first_value_of`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SetTrack {
    /// x: the track word. y: the index of the track's first value. If the track is a constant spline, it has three values, and y
    /// is the index of the middle one.
    pub words: [u32; 2],
}

/// A list of key times that several tracks share.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Timeline {
    /// Index of the timeline's first key time.
    pub first_time: u32,
    /// Number of key times, at least 1.
    pub keys: u32,
}

/// The 2 bits of a track word from bit 30 on.
pub const fn track_interpolation(word: u32) -> u32 {
    word >> 30
}

/// The 30 bits of a track word from bit 0 on.
pub const fn track_timeline(word: u32) -> u32 {
    word & 1073741823
}

/// Packs a word: Track: timeline 30, interpolation 2 bits, the lowest first.
pub const fn track_word(timeline: u32, interpolation: u32) -> u32 {
    assert!(timeline <= 0x3fffffff && interpolation <= 0x3, "a value exceeds its bits: Track: timeline 30, interpolation 2");
    timeline | (interpolation << 30)
}
}
/// Of `animation/clip_clock.wgsl`.
pub mod clip_clock {
/// Flag in the first word of `history`: layers were blended over the clip.
pub const BLENDED: u32 = 2147483648;

/// Factor in the hash of the clips above the base layer (`clips_above`).
pub const CLIP_HASH_FACTOR: u32 = 31;

/// Parameters of the kernel `animation/clip_clock`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct ClipClockParams {
    /// Number of instances.
    pub instances: u32,
    /// Elapsed time in seconds, the same for all instances. At elapsed time 0, the clip time of an instance is its `start`.
    pub elapsed: f32,
    /// Number of layers above the base layer.
    pub layers: u32,
    /// Look-ahead in seconds: the time by which bones may be sampled ahead; 0 for none.
    pub ahead: f32,
}

/// Lowest bit of the skeleton tier in the first word of `history`.
pub const TIER_SHIFT: u32 = 24;
}
/// Of `animation/clock.wgsl`.
pub mod clock {
/// Number of loops at and beyond which an f32 cannot resolve a position in a clip.
pub const MAX_TURNS: f32 = 16777216.0;

/// Wrap code: times outside the clip are clamped to the clip's start or end. With code 0, the clip loops.
pub const WRAP_CLAMP: u32 = 1;
}
/// Of `animation/compact.wgsl`.
pub mod compact {
/// Parameters of the kernel `animation/compact`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct CompactParams {
    /// Number of instances.
    pub instances: u32,
    /// Number of bones per instance.
    pub bones: u32,
    /// Number of 32-bit words per instance. Each slot has one bit.
    pub words: u32,
    /// Number of dispatches, besides the first one, that handle updated instances.
    pub served: u32,
    /// Largest number of workgroups along x.
    pub most_groups: u32,
}

/// Stage: one workgroup sums the counts, lists the instances and writes the arguments.
pub const SCAN: u32 = 1;

/// Stage: a thread lists the pairs of one word of bits.
pub const SCATTER: u32 = 2;

/// Stage: a thread spreads the active bits of one instance to all slots below them, and counts the active bits.
pub const SPREAD: u32 = 0;

/// Number of threads in a workgroup.
pub const WIDTH: u32 = 64;
}
/// Of `animation/drive.wgsl`.
pub mod drive {
/// Parameters of the kernel `animation/drive`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct DriveParams {
    /// Number of entries in `driven`.
    pub driven: u32,
    /// Number of instances.
    pub instances: u32,
    /// Number of 32-bit words per instance. Each slot has one bit.
    pub words: u32,
}

/// The driven bones of one instance in one word of bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct DrivenWord {
    /// Index of the word: instance * words + word.
    pub at: u32,
    /// Driven bones, one bit per bone in the order of bones.
    pub bones: u32,
}
}
/// Of `animation/gate.wgsl`.
pub mod gate {
/// Mode: a bone is sampled when the motion that it missed exceeds its error budget.
pub const BOUNDED: u32 = 4;

/// Lowest bit of a field in a bone's encoded error budget. The field is the fraction of the remaining budget that the bone may
/// use, in 1/FRACTION_ONE.
pub const BUDGET_FRACTION_SHIFT: u32 = 8;

/// Mask of a field in a bone's encoded error budget. The field is the exponent of the quantization slack, which is added to
/// missed motion. The slack is 2^(exponent − 1), or 0 for exponent 0.
pub const BUDGET_SLACK_MASK: u32 = 31;

/// Exclusive upper bound of the allowed motion, in units of the table.
pub const EVERYTHING: u32 = 1073741824;

/// Parameters of the kernel `animation/gate`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct GateParams {
    /// Number of instances.
    pub instances: u32,
    /// Number of bones per instance.
    pub bones: u32,
    /// Number of 32-bit words per instance. Each slot has one bit.
    pub words: u32,
    /// Number of entries per row of the table.
    pub stride: u32,
    /// Number of ticks since the start.
    pub ticks: u32,
    /// Number of ticks since the last frame.
    pub frame_ticks: u32,
    /// Longest period, in ticks.
    pub period: u32,
    /// Number of frames since the start.
    pub frame: u32,
    /// Number of clips.
    pub clips: u32,
    /// Number of skeleton tiers.
    pub tiers: u32,
    /// Index of the table's row with the nearest animated ancestors of all slots in the first clip. The nearest animated
    /// ancestor of a slot is the nearest slot above it that the clip moves. Rows for the other clips follow.
    pub first_above: u32,
}

/// Mode: all bones that the clip moves are sampled.
pub const OFF: u32 = 0;

/// Mode: each bone is sampled with probability Ω.
pub const RANDOM: u32 = 3;

/// Flag in a bone's encoded error budget: the remaining budget is stored for later bones.
pub const REMAINING: u32 = 64;

/// First factor of the hash `scramble`.
pub const SCRAMBLE_FIRST: u32 = 569420461;

/// Second factor of the hash `scramble`.
pub const SCRAMBLE_SECOND: u32 = 1935289751;

/// Mode: each bone skips one update per period. The period depends on the bone's priority and Ω.
pub const SKIP_PERIOD: u32 = 1;

/// Flag in a bone's encoded error budget: the bone above is not the previous one in the order.
pub const STARTS: u32 = 32;

/// Mode: in a fraction Ω of the frames, all bones of an instance are sampled; in the other frames, none are.
pub const UNIFORM: u32 = 2;
}
/// Of `animation/gate_state.wgsl`.
pub mod gate_state {
/// Position of an instance in its clip, on the clip's common timeline (its first one).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct ClipClock {
    /// Index of a row in the gate's table: the clip's first row, plus the index of the last key at or before the current time.
    pub row: u32,
    /// Progress word: the fraction of the interval to the next row, 0 to FRACTION_ONE, and the `UpdateReason`.
    pub fraction_and_reason: u32,
    /// Index of the clip in its set.
    pub clip: u32,
    /// Row at the look-ahead time: a later time, for which bones may already be sampled in this frame. It equals `row` if there
    /// is no look-ahead time.
    pub ahead_row: u32,
    /// Fraction of the interval from the look-ahead row to the next row, 0 to FRACTION_ONE.
    pub ahead_fraction: u32,
}

/// The fraction 1 in fixed point: the whole interval from one row to the next.
pub const FRACTION_ONE: u32 = 65536;

/// Value of `Lod::weight` for an instance that counts in full.
pub const FULL_WEIGHT: u32 = 65535;

/// Flag of an instance that is sampled in full this frame, whatever the gate says.
pub const LOD_FORCED: u32 = 2;

/// Flag of an instance that is not in view. The instance costs nothing, and is sampled in full when it comes back into view.
pub const LOD_HIDDEN: u32 = 1;

/// Level of detail of an instance, as gates read it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Lod {
    /// Level of detail by distance, Ω: 0 to `OMEGA_ONE`. At `OMEGA_ONE`, no update is skipped. See `Range::omega`.
    pub omega: u32,
    /// Motion that a gate may miss, in units of the gate's table. See `Projection::allowed`.
    pub allowed: u32,
    /// Weight of this instance's motion relative to other instances, 0 to FULL_WEIGHT, proportional to the instance's size on
    /// screen.
    pub weight: u32,
    /// Flags word: LOD_HIDDEN, LOD_FORCED or 0, and the skeleton tier. An instance with both flags counts as hidden and is not
    /// sampled.
    pub flags: u32,
}

/// Value of `Lod::omega` at full detail.
pub const OMEGA_ONE: u32 = 65536;

/// Flag in the word of a pair, which stands for one bone of one instance: the bone is sampled at the look-ahead time.
pub const PAIR_AHEAD: u32 = 2147483648;

/// Update reason: layers are blended over the clip.
pub const UPDATE_REASON_BLENDED: u32 = 3;

/// Update reason: all bones are sampled.
pub const UPDATE_REASON_FORCED: u32 = 2;

/// Update reason: the gate decides which bones are sampled.
pub const UPDATE_REASON_FREE: u32 = 0;

/// Update reason: no bone is sampled.
pub const UPDATE_REASON_HIDDEN: u32 = 1;

/// The 8 bits of a lod_flags word from bit 0 on.
pub const fn lod_flags_bits(word: u32) -> u32 {
    word & 255
}

/// The 8 bits of a lod_flags word from bit 8 on.
pub const fn lod_flags_tier(word: u32) -> u32 {
    (word >> 8) & 255
}

/// Packs a word: LodFlags: bits 8, tier 8 bits, the lowest first.
pub const fn lod_flags_word(bits: u32, tier: u32) -> u32 {
    assert!(bits <= 0xff && tier <= 0xff, "a value exceeds its bits: LodFlags: bits 8, tier 8");
    bits | (tier << 8)
}

/// The 20 bits of a progress word from bit 0 on.
pub const fn progress_fraction(word: u32) -> u32 {
    word & 1048575
}

/// The 12 bits of a progress word from bit 20 on.
pub const fn progress_reason(word: u32) -> u32 {
    word >> 20
}

/// Packs a word: Progress: fraction 20, reason 12 bits, the lowest first.
pub const fn progress_word(fraction: u32, reason: u32) -> u32 {
    assert!(fraction <= 0xfffff && reason <= 0xfff, "a value exceeds its bits: Progress: fraction 20, reason 12");
    fraction | (reason << 20)
}
}
/// Of `animation/instance.wgsl`.
pub mod instance {
/// The clip that a character plays, and how the character plays it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct AnimationInstance {
    /// Index of the clip in the set.
    pub clip: u32,
    /// Treatment of times outside the clip: 0 loops, 1 clamps.
    pub wrap_code: u32,
    /// Time inside the clip at elapsed time 0, in seconds.
    pub start: f32,
    /// Playback rate in clip seconds per second; negative plays backwards.
    pub rate: f32,
}
}
/// Of `animation/interpolation.wgsl`.
pub mod interpolation {
/// Interpolation along a straight line; rotations take the shortest arc.
pub const INTERPOLATION_LINEAR: u32 = 1;

/// Interpolation by a cubic Hermite spline: a key has an in-tangent, a value and an out-tangent.
pub const INTERPOLATION_SPLINE: u32 = 2;

/// Interpolation: a value stays constant until the next key.
pub const INTERPOLATION_STEP: u32 = 0;
}
/// Of `animation/keyframe_cursor.wgsl`.
pub mod keyframe_cursor {
/// Parameters of the kernel `animation/keyframe_cursor`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct KeyframeCursorParams {
    /// Number of entries in `instances`: layers times instances.
    pub entries: u32,
    /// Number of instances.
    pub instances: u32,
    /// Number of cursors allocated per instance and layer.
    pub timelines: u32,
    /// Elapsed time in seconds, the same for all instances. At elapsed time 0, the clip time of an instance is its `start`.
    pub elapsed: f32,
}
}
/// Of `animation/local_to_model.wgsl`.
pub mod local_to_model {
/// Parameters of the kernel `animation/local_to_model`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct LocalToModelParams {
    /// Number of instances.
    pub instances: u32,
    /// Number of bones per instance.
    pub bones: u32,
    /// Number of 32-bit words per instance in `updated_bones`.
    pub words: u32,
    /// Index in `chains` of this dispatch's first chain.
    pub first_chain: u32,
    /// Number of chains that this dispatch handles.
    pub chains: u32,
    /// Index of the word in `updated_bones` at which the updated bits begin.
    pub first_word: u32,
}
}
/// Of `animation/order.wgsl`.
pub mod order {
/// `Slot::parent` of a bone whose parent has the previous slot.
pub const CONTINUES: u32 = 4294967294;

/// Consecutive slots that lead from parent to child.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Chain {
    /// Index of the first slot.
    pub first: u32,
    /// Number of slots.
    pub count: u32,
}

/// `Slot::parent` of a root bone.
pub const NO_PARENT: u32 = 4294967295;

/// Position of a bone in the order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Slot {
    /// Index of the bone.
    pub bone: u32,
    /// Index of the parent bone, CONTINUES or NO_PARENT.
    pub parent: u32,
    /// Number of slots of the bone and all its descendants. These slots are consecutive, and this slot is the first.
    pub subtree: u32,
}
}
/// Of `animation/rotation.wgsl`.
pub mod rotation {
/// Factor of the last coefficient in `SLERP_U` and `SLERP_V`. It compensates for omitted terms of the polynomial. With this
/// value, five terms have the smallest maximum error on halved arcs.
pub const SLERP_REST: f32 = 1.15;

/// Coefficients 1/(i(2i + 1)), for i from 1 to 5, of Eberly's polynomial (Eberly 2011) for cosines from √½ to 1. The last one
/// compensates for omitted terms.
pub const SLERP_U: [f32; 5] = [0.33333334, 0.1, 0.04761905, 0.027777778, 0.02090909];

/// Coefficients i/(2i + 1), for i from 1 to 5, of Eberly's polynomial. The last one compensates for omitted terms.
pub const SLERP_V: [f32; 5] = [0.33333334, 0.4, 0.42857143, 0.44444445, 0.52272725];
}
/// Of `animation/sample.wgsl`.
pub mod sample {
/// Parameters of the kernel `animation/sample`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct SampleParams {
    /// Number of bones per instance.
    pub bones: u32,
    /// Number of cursors allocated per instance and layer.
    pub timelines: u32,
    /// Number of bones of all instances together.
    pub pairs: u32,
    /// Number of instances.
    pub instances: u32,
    /// Number of layers, the base layer included.
    pub layers: u32,
}

/// Smallest squared length at which a quaternion from a spline has a direction. For a shorter quaternion, the rotation is the
/// value of the key before the position.
pub const VANISHING: f32 = 1e-12;
}
}
/// Of `baseline/`.
pub mod baseline {
/// Of `baseline/copy.wgsl`.
pub mod copy {
/// Parameters of the kernel `baseline/copy`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct CopyParams {
    /// Number of 16-byte vectors.
    pub vectors: u32,
}
}
/// Of `baseline/gather.wgsl`.
pub mod gather {
/// Parameters of the kernel `baseline/gather`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct GatherParams {
    /// Number of bones of all instances together.
    pub pairs: u32,
    /// Number of bones per instance.
    pub bones: u32,
    /// Number of keys per track.
    pub keys: u32,
}
}
/// Of `baseline/loads.wgsl`.
pub mod loads {
/// Parameters of the kernel `baseline/loads`. The kernel loads texels and adds them up, to measure the cost of texel loads
/// alone. Each thread walks along a row of the texture.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct LoadsParams {
    /// Number of threads along x and y.
    pub threads: glam::UVec2,
    /// Number of texels that each thread loads.
    pub loads: u32,
}
}
/// Of `baseline/texels.wgsl`.
pub mod texels {
/// Parameters of the kernel `baseline/texels`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct TexelsParams {
    /// Number of samples along an edge of a window.
    pub width: u32,
    /// Number of zones.
    pub zone_count: u32,
    /// Number of planes from which textures are projected: 1 (from above) or 3 (triplanar).
    pub planes: u32,
    /// Texture tiles per sample, in 2^-22 tiles.
    pub tiles_per_sample: u32,
    /// Texture tiles per world unit of height, in 2^-22 tiles.
    pub tiles_per_unit: u32,
}
}
/// Of `baseline/words.wgsl`.
pub mod words {
/// Parameters of the kernel `baseline/words`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct WordsParams {
    /// Key of the random words.
    pub key: glam::UVec2,
    /// Number of vectors of four words.
    pub vectors: u32,
    /// Number of vectors per row (one y).
    pub vectors_per_row: u32,
}
}
}
/// Of `lod/`.
pub mod lod {
/// Of `lod/allowed.wgsl`.
pub mod allowed {
/// Safety factor for floating-point error in `camera_allows` and in all values computed from its result. With this factor,
/// rounding never permits an error above `pixels`.
pub const ALLOWED_MARGIN: f32 = 0.9999;

/// Largest error and nearest eye of an instance, over all views of a frame that see it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Allowed {
    /// Displacement that these views allow, in model units; UNSEEN_ALLOWED if no view sees the instance.
    pub displacement: f32,
    /// Distance from the nearest eye to the middle of the bounding sphere, in world units; 0 in a parallel view.
    pub distance: f32,
}

/// Smallest model scale by which an allowed displacement is divided. Smaller scales count as this one.
pub const LEAST_SCALE: f32 = 1e-9;

/// Upper bound of the allowed displacement, in model units. It keeps divisions by a displacement finite.
pub const MAX_ALLOWED: f32 = 1000000000.0;

/// Displacement that is allowed to an instance that no view of the frame has seen.
pub const UNSEEN_ALLOWED: f32 = -1.0;
}
/// Of `lod/assign.wgsl`.
pub mod assign {
/// Parameters of the kernel `lod/assign`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct AssignParams {
    /// Index in `allowed` of the object's first instance.
    pub first: u32,
    /// Number of instances.
    pub instances: u32,
    /// Fraction of the allowed displacement that unsampled bones may use, 0 to 1.
    pub bone_fraction: f32,
    /// Fraction of the allowed displacement that influence fades may use, 0 to 1.
    pub influence_fraction: f32,
    /// Unit of the gate's table in model units, above 0.
    pub unit: f32,
    /// Largest displacement of a vertex whose influences have faded completely, in model units, at least 0.
    pub stray: f32,
    /// Largest number of influences of a visible instance, 1 to 8.
    pub max_influences: u32,
    /// Distance in world units up to which Ω is 1.
    pub omega_start: f32,
    /// Decrease of Ω per world unit beyond `omega_start`; 0 if Ω is always 1.
    pub omega_rate: f32,
    /// Distance in world units up to which influences have their full weight.
    pub fade_start: f32,
    /// Increase of the influence fade per world unit beyond `fade_start`; 0 if influences do not fade by distance.
    pub fade_rate: f32,
    /// Allowed displacement up to which an instance's motion has full weight, in model units, above 0.
    pub full_weight_allowed: f32,
    /// Largest error of a skeleton tier, as a fraction of the displacement that bones may use, 0 to 1. The rest is for bones that
    /// the gate skips.
    pub tier_fraction: f32,
    /// Error of each skeleton tier in model units, ascending from 0. A tier that does not exist has an error that nothing allows.
    pub tier_errors: glam::Vec4,
}

/// Number of steps to which the influence fade is rounded, so that an instance that hardly moves keeps its fade.
pub const FADE_STEPS: f32 = 64.0;

/// Largest number of skeleton tiers.
pub const MAX_TIERS: u32 = 4;

/// Largest `Lod::allowed`. It is exact in an f32, and below the motion of a whole clip, 2^30.
pub const MAX_UNITS: f32 = 1073741760.0;

/// An instance changes to a coarser tier only if the tier's error is below this fraction of its limit (hysteresis).
pub const TIER_HYSTERESIS: f32 = 0.8;
}
/// Of `lod/attach.wgsl`.
pub mod attach {
/// Parameters of the kernel `lod/attach`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct AttachParams {
    /// Number of valid entries in `attachments`.
    pub attached: u32,
    /// Number of bones of the character.
    pub bones: u32,
    /// Index in the scene of the character's first instance.
    pub first: u32,
    /// Index in `placements` of the last frame's first transform, equal to the number of instances; 0 if the last frame is not
    /// kept.
    pub first_last: u32,
    /// Number of the frame, counted from 1.
    pub frame: u32,
    /// Number of the previous frame; 0 if its data is not known.
    pub last_frame: u32,
}

/// A mesh that is attached to a bone.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Attachment {
    /// Index in the scene of the mesh's instance.
    pub mesh: u32,
    /// Index of the character's instance, counted from the character's first one.
    pub character: u32,
    /// Index of the bone.
    pub bone: u32,
    /// Key of the attachment. No other attachment has the same key, now or later.
    pub key: u32,
    /// Transform from the mesh's space to the bone's space, three rows.
    pub offset: [[f32; 4]; 3],
}

/// Transform that a bone gave to an attached mesh in an earlier frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct KeptBone {
    /// Product of the bone's model matrix and the mesh's offset, three rows.
    pub rows: [[f32; 4]; 3],
    /// Number of the frame in which the bone had this transform; 0 for none.
    pub frame: u32,
    /// Key of the attachment.
    pub key: u32,
    /// Padding, not read.
    pub unused_a: u32,
    /// Padding, not read.
    pub unused_b: u32,
}

/// `Attachment.mesh` of an unused entry.
pub const NO_MESH: u32 = 4294967295;
}
/// Of `lod/budget.wgsl`.
pub mod budget {
/// Number of bins of all ranks.
pub const ALL_BINS: u32 = 8192;

/// Stage: a thread per instance adds the instance's triangles to the sum of triangles, and the instance's savings to the bins.
pub const BINS: u32 = 0;

/// Number of parts per bin.
pub const BIN_PARTS: u32 = 1024;

/// Parameters of the kernel `lod/budget`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct BudgetParams {
    /// Largest number of triangles, in units of the budget.
    pub limit: u32,
    /// Number of blocks of instances.
    pub blocks: u32,
}

/// Sums over the instances of all views that share the budget. The atomic sums are zero between frames.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct BudgetWork {
    /// Number of triangles without a budget, in units of the budget.
    pub triangles: u32,
    /// Number of triangles with this frame's factors, both levels of each fade included, in units of the budget.
    pub fading: u32,
    /// Bin of the smallest sufficient factor. 0xffffffff if the triangles fit without a budget; `ALL_BINS` if even the coarsest
    /// levels do not fit.
    pub bin: u32,
    /// Number of triangles that remain before the savings of `bin` are subtracted.
    pub left: u32,
    /// Savings in triangles per bin.
    pub bins: [u32; 8192],
    /// Savings in triangles per part of `bin`.
    pub parts: [u32; 1024],
}

/// Stage: a thread per instance adds the triangles that the instance draws. An instance that fades counts with both levels.
pub const FADES: u32 = 4;

/// Stage: one workgroup finds the bin whose savings bring the triangles within the budget.
pub const FIND_BIN: u32 = 1;

/// Stage: one workgroup finds the part whose savings bring the triangles within the budget, and writes the factors.
pub const FIND_PART: u32 = 3;

/// Stage: one thread ends all fades of the frame if the triangles with both levels of each fade exceed the budget.
pub const FINISH: u32 = 5;

/// Largest factor of the metric: 2 to the power of 16.
pub const MAX_FACTOR: f32 = 65536.0;

/// Number of parts for a doubling of the factor.
pub const OCTAVE: f32 = 65536.0;

/// Stage: a thread per instance adds the instance's savings in the found bin to the parts of this bin.
pub const PARTS: u32 = 2;

/// Number of bins per rank.
pub const RANK_BINS: u32 = 1024;

/// Safety margin for the rounding of `log2` and `exp2`, in parts of a bin.
pub const ROUNDED_PARTS: u32 = 2;

/// Time constant of the pressure's exponential fall, in seconds.
pub const SETTLING: f32 = 0.15;
}
/// Of `lod/budget_state.wgsl`.
pub mod budget_state {
/// State of a triangle budget: how much the budget coarsens the levels of detail of its objects.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct BudgetState {
    /// Factor per rank, 1 or more. It multiplies the metric by which levels are chosen. Elements from `NO_RANK` on are 1.
    pub factors: [[f32; 4]; 3],
    /// 1 if all fades end in this frame, because the budget cannot hold both levels of every fade; else 0.
    pub ends_fades: u32,
    /// 1 if even the coarsest levels exceed the budget, else 0.
    pub is_missed: u32,
    /// Number of triangles drawn, in units of the budget. An instance that fades counts with both levels.
    pub triangles: u32,
    /// Degree of coarsening: an integer position on a scale. The scale has one section per rank, in the order of ranks. Within a
    /// section, the position is proportional to the logarithm of the rank's factor.
    pub pressure: u32,
}
}
/// Of `lod/criterion.wgsl`.
pub mod criterion {
/// Criterion: the metric is the square root of the ratio of the viewport's area to the projected area of the model's box.
pub const CRITERION_BOX: u32 = 4;

/// Criterion: the metric is the distance from the eye to the middle of the bounding sphere, in world units.
pub const CRITERION_DISTANCE: u32 = 1;

/// Criterion: the metric is the displacement that the camera allows, in model units. The CRITERION constants are values of the
/// criterion in an object's flags word.
pub const CRITERION_ERROR: u32 = 0;

/// Criterion: the metric is the number of world units per pixel at the middle of the bounding sphere (thesis B equation 3.3).
pub const CRITERION_MAGNIFICATION: u32 = 6;

/// Criterion: the metric is the distance from the eye to the nearest point of the model's box, in world units.
pub const CRITERION_NEAREST: u32 = 3;

/// Criterion: the metric is the distance from the eye to a chosen point of the model, in world units.
pub const CRITERION_POINT: u32 = 2;

/// Criterion: the metric is the square root of the ratio of the viewport's area to the projected area of the bounding sphere.
pub const CRITERION_SPHERE: u32 = 5;

/// Upper bound of the metric, for every criterion.
pub const MAX_METRIC: f32 = 3e38;
}
/// Of `lod/decide.wgsl`.
pub mod decide {
/// Value of `finest` for an instance that no view of the frame has seen.
pub const UNSEEN_LEVEL: u32 = 4294967295;
}
/// Of `lod/instance.wgsl`.
pub mod instance {
/// Edge length of a cell, in world units. A position consists of a cell index and an offset, so that it stays precise far from
/// the origin.
pub const CELL_SIZE: f32 = 256.0;

/// Instance flag: the instance exists.
pub const INSTANCE_ALIVE: u32 = 1;

/// Instance flag: the instance is a character with an attached mesh. No displacement is allowed to its bones, so the gate that
/// bounds errors samples them in every frame in which a view sees the character.
pub const INSTANCE_CARRIES: u32 = 4;

/// Instance flag: the instance casts shadows.
pub const INSTANCE_CASTS: u32 = 2;

/// Instance flag: the instance is a mesh that is attached to a bone. Its placement is stored only per view, as rows of a matrix.
pub const INSTANCE_FOLLOWS: u32 = 8;

/// Instance flag: the instance is a character that needs all bones of its skeleton, because the host drives bones or layers are
/// blended. It keeps skeleton tier 0.
pub const INSTANCE_WHOLE: u32 = 16;

/// An instance of an object: its placement, flags and tint.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SceneInstance {
    /// Cell that contains the instance's position.
    pub cell: [i32; 3],
    /// Instance flags (`INSTANCE_ALIVE`, `INSTANCE_CASTS`, `INSTANCE_CARRIES`, `INSTANCE_FOLLOWS`, `INSTANCE_WHOLE`) in the lower
    /// 16 bits. The upper 16 bits are the visibility mask.
    pub flags: u32,
    /// Position of the instance relative to the cell's corner, in world units.
    pub offset: [f32; 3],
    /// User data: a word that the caller's shading function reads.
    pub user_data: u32,
    /// Rotation: a unit quaternion (x, y, z, w).
    pub rotation: [f32; 4],
    /// Scale factors along the model's axes, applied before the rotation. Negative factors mirror.
    pub scale: [f32; 3],
    /// Tint that multiplies the instance's colours: red, green, blue and alpha, 8 bits each, red in the lowest byte.
    pub tint: u32,
    /// Sphere around everything that the instance may draw, in model space: center (xyz) and radius (w).
    pub bounding_sphere: [f32; 4],
}

/// The 16 bits of a instance_flags word from bit 0 on.
pub const fn instance_flags_bits(word: u32) -> u32 {
    word & 65535
}

/// The 16 bits of a instance_flags word from bit 16 on.
pub const fn instance_flags_mask(word: u32) -> u32 {
    word >> 16
}

/// Packs a word: InstanceFlags: bits 16, mask 16 bits, the lowest first.
pub const fn instance_flags_word(bits: u32, mask: u32) -> u32 {
    assert!(bits <= 0xffff && mask <= 0xffff, "a value exceeds its bits: InstanceFlags: bits 16, mask 16");
    bits | (mask << 16)
}
}
/// Of `lod/list.wgsl`.
pub mod list {
/// Parameters of the kernel `lod/list`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct ListParams {
    /// Number of objects.
    pub objects: u32,
    /// Number of blocks of instances.
    pub blocks: u32,
}

/// Stage: a thread per instance writes list entries. The threads of a block synchronize at barriers.
pub const PLACE: u32 = 1;

/// Number of blocks per workgroup in the stage `PLACE`.
pub const PLACED_BLOCKS: u32 = 4;

/// Number of runs into which an object's blocks are divided. The runs are summed in parallel, with one thread per run and list.
pub const RUNS: u32 = 8;

/// Stage: a workgroup per object computes prefix sums of the counts of its blocks.
pub const SUM: u32 = 0;
}
/// Of `lod/object.wgsl`.
pub mod object {
/// Number of instances in a block. The instances of each object occupy whole blocks.
pub const BLOCK: u32 = 64;

/// Number of steps of a fade in a decision word.
pub const FADE_PROGRESS: u32 = 65535;

/// Number of steps of a fade's weight in a list entry.
pub const FADE_STEPS: u32 = 127;

/// Level-of-detail settings of an object, and the location of its instances, lists and draws.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct LodObject {
    /// Index of the object's first instance in the scene, a multiple of `BLOCK`.
    pub first: u32,
    /// Number of instances of the object, a multiple of `BLOCK`.
    pub instances: u32,
    /// Number of levels of detail, 1 to `OBJECT_LEVELS`.
    pub levels: u32,
    /// Index of the word at which the object's first list begins in a view's lists. Each list takes `instances` words.
    pub first_list: u32,
    /// Index of the object's first draw in a view's draws. Each part of the object has `OBJECT_LISTS` draws.
    pub first_draw: u32,
    /// Number of parts of the object, each with draws of its own.
    pub parts: u32,
    /// Factor of the metric, above 0: the LOD bias. If the metric is the allowed displacement, the factor includes the fraction of
    /// the displacement that levels may use.
    pub metric_scale: f32,
    /// Flags word of the object, see `object_flags_word`.
    pub flags: u32,
    /// Threshold per level, ascending: the smallest metric at which the level is drawn. Without a geomorph, the first threshold
    /// is 0. With a geomorph, a level begins to move towards the next one at its threshold, so the first threshold is above 0.
    pub thresholds: [[f32; 4]; 2],
    /// Factor for the thresholds of the last frame's level and of finer levels. While the metric is between a threshold times
    /// `finer` and this threshold times `coarser`, an instance keeps its level (hysteresis), or fades from one level to the
    /// next.
    pub finer: f32,
    /// Factor for the thresholds of levels that are coarser than the last frame's level.
    pub coarser: f32,
    /// Steps per second of a fade that runs in time; a whole fade has `FADE_PROGRESS` steps.
    pub rate: f32,
    /// Relative growth of the metric with an instance's speed on screen, per picture height per second; 0 for none.
    pub motion: f32,
    /// Middle of the model's box, or the point to which distances are measured, in model space.
    pub point: [f32; 3],
    /// Relative growth of the metric with an instance's distance from the picture's middle, per half picture height; 0 for none.
    pub periphery: f32,
    /// Half the size of the model's box along the model's axes.
    pub half_size: [f32; 3],
    /// Rank of the object in a triangle budget: objects of rank 0 are coarsened first. `NO_RANK` if the budget spares the
    /// object.
    pub rank: u32,
    /// Metric at which instances begin to fade out, with `TRANSITION_ALPHA`.
    pub fade_begin: f32,
    /// Metric at which instances have faded out, with `TRANSITION_ALPHA`.
    pub fade_end: f32,
    /// Factor of a term that is added to the metric: `metric_floor` times (a budget's factor minus 1). With this term, the
    /// largest factor reaches every level even from a metric of 0.
    pub metric_floor: f32,
    /// Padding, not read.
    pub unused: u32,
    /// Number of triangles per level, in units of the triangle budget.
    pub triangles: [[u32; 4]; 2],
}

/// Number of steps of a geomorph from one level to the next.
pub const MORPH_STEPS: u32 = 511;

/// Object index of a block that belongs to no object.
pub const NO_OBJECT: u32 = 4294967295;

/// Rank of an object that a triangle budget never coarsens.
pub const NO_RANK: u32 = 8;

/// Largest number of levels of detail of an object, the finest included.
pub const OBJECT_LEVELS: u32 = 8;

/// Largest number of lists of an object in a view. Each level has four lists: unmirrored and mirrored instances, each without a
/// fade (`solid_list`) and with a fade (`fading_list`).
pub const OBJECT_LISTS: u32 = 32;

/// Number of ranks, the importance classes of a triangle budget.
pub const RANKS: u32 = 8;

/// The arguments of an indexed indirect draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SceneDraw {
    /// Number of indices to draw.
    pub index_count: u32,
    /// Number of instances to draw.
    pub instance_count: u32,
    /// Index in the index buffer of the first index to draw.
    pub first_index: u32,
    /// Number that is added to each index.
    pub base_vertex: u32,
    /// Number of the first instance.
    pub first_instance: u32,
}

/// Metric word of an instance that the view does not see.
pub const UNSEEN_METRIC: u32 = 4294967295;

/// The 3 bits of a decision word from bit 2 on.
pub const fn decision_level(word: u32) -> u32 {
    (word >> 2) & 7
}

/// The 1 bits of a decision word from bit 1 on.
pub const fn decision_mirrored(word: u32) -> u32 {
    (word >> 1) & 1
}

/// The 3 bits of a decision word from bit 5 on.
pub const fn decision_next(word: u32) -> u32 {
    (word >> 5) & 7
}

/// The 1 bits of a decision word from bit 0 on.
pub const fn decision_seen(word: u32) -> u32 {
    word & 1
}

/// The 16 bits of a decision word from bit 8 on.
pub const fn decision_steps(word: u32) -> u32 {
    (word >> 8) & 65535
}

/// Packs a word: Decision: seen 1, mirrored 1, level 3, next 3, steps 16 bits, the lowest first.
pub const fn decision_word(seen: u32, mirrored: u32, level: u32, next: u32, steps: u32) -> u32 {
    assert!(seen <= 0x1 && mirrored <= 0x1 && level <= 0x7 && next <= 0x7 && steps <= 0xffff, "a value exceeds its bits: Decision: seen 1, mirrored 1, level 3, next 3, steps 16");
    seen | (mirrored << 1) | (level << 2) | (next << 5) | (steps << 8)
}

/// The 1 bits of a fade word from bit 7 on.
pub const fn fade_rest(word: u32) -> u32 {
    (word >> 7) & 1
}

/// The 7 bits of a fade word from bit 0 on.
pub const fn fade_weight(word: u32) -> u32 {
    word & 127
}

/// Packs a word: Fade: weight 7, rest 1 bits, the lowest first.
pub const fn fade_word(weight: u32, rest: u32) -> u32 {
    assert!(weight <= 0x7f && rest <= 0x1, "a value exceeds its bits: Fade: weight 7, rest 1");
    weight | (rest << 7)
}

/// The 20 bits of a list_entry word from bit 0 on.
pub const fn list_entry_instance(word: u32) -> u32 {
    word & 1048575
}

/// The 3 bits of a list_entry word from bit 20 on.
pub const fn list_entry_level(word: u32) -> u32 {
    (word >> 20) & 7
}

/// The 9 bits of a list_entry word from bit 23 on.
pub const fn list_entry_steps(word: u32) -> u32 {
    word >> 23
}

/// Packs a word: ListEntry: instance 20, level 3, steps 9 bits, the lowest first.
pub const fn list_entry_word(instance: u32, level: u32, steps: u32) -> u32 {
    assert!(instance <= 0xfffff && level <= 0x7 && steps <= 0x1ff, "a value exceeds its bits: ListEntry: instance 20, level 3, steps 9");
    instance | (level << 20) | (steps << 23)
}

/// The 31 bits of a metric word from bit 0 on.
pub const fn metric_bits(word: u32) -> u32 {
    word & 2147483647
}

/// The 1 bits of a metric word from bit 31 on.
pub const fn metric_mirrored(word: u32) -> u32 {
    word >> 31
}

/// Packs a word: Metric: bits 31, mirrored 1 bits, the lowest first.
pub const fn metric_word(bits: u32, mirrored: u32) -> u32 {
    assert!(bits <= 0x7fffffff && mirrored <= 0x1, "a value exceeds its bits: Metric: bits 31, mirrored 1");
    bits | (mirrored << 31)
}

/// The 4 bits of a object_flags word from bit 7 on.
pub const fn object_flags_criterion(word: u32) -> u32 {
    (word >> 7) & 15
}

/// The 1 bits of a object_flags word from bit 1 on.
pub const fn object_flags_never_culled(word: u32) -> u32 {
    (word >> 1) & 1
}

/// The 1 bits of a object_flags word from bit 0 on.
pub const fn object_flags_shown(word: u32) -> u32 {
    word & 1
}

/// The 1 bits of a object_flags word from bit 2 on.
pub const fn object_flags_timed(word: u32) -> u32 {
    (word >> 2) & 1
}

/// The 4 bits of a object_flags word from bit 3 on.
pub const fn object_flags_transition(word: u32) -> u32 {
    (word >> 3) & 15
}

/// Packs a word: ObjectFlags: shown 1, never_culled 1, timed 1, transition 4, criterion 4 bits, the lowest first.
pub const fn object_flags_word(shown: u32, never_culled: u32, timed: u32, transition: u32, criterion: u32) -> u32 {
    assert!(shown <= 0x1 && never_culled <= 0x1 && timed <= 0x1 && transition <= 0xf && criterion <= 0xf, "a value exceeds its bits: ObjectFlags: shown 1, never_culled 1, timed 1, transition 4, criterion 4");
    shown | (never_culled << 1) | (timed << 2) | (transition << 3) | (criterion << 7)
}
}
/// Of `lod/select.wgsl`.
pub mod select {
/// Largest speed in the picture that counts, in picture heights per second.
pub const MAX_MOTION: f32 = 4.0;
}
/// Of `lod/sorted.wgsl`.
pub mod sorted {
/// A draw of one part of one instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SortedDraw {
    /// Index of the instance in the scene.
    pub instance: u32,
    /// Index in `arguments` of the part's first draw.
    pub first_draw: u32,
    /// Index of the instance in its object.
    pub slot: u32,
    /// Index of the object.
    pub object: u32,
}

/// Parameters of the kernel `lod/sorted`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct SortedParams {
    /// Number of sorted draws.
    pub count: u32,
}
}
/// Of `lod/transition.wgsl`.
pub mod transition {
/// Level of an instance that had no level in the last frame.
pub const NO_LEVEL: u32 = 4294967295;

/// List index of an entry that does not exist.
pub const NO_LIST: u32 = 4294967295;

/// Transition: levels change at once, and instances fade out between two metrics (thesis A section 7.4).
pub const TRANSITION_ALPHA: u32 = 6;

/// Transition: both levels are blended (thesis A section 7.3.1).
pub const TRANSITION_CROSS_FADE: u32 = 3;

/// Transition: both levels are drawn, each in its own pixels of a pattern.
pub const TRANSITION_DITHER: u32 = 2;

/// Transition: the current level is opaque, and the next level is blended over it (thesis A section 7.3.2).
pub const TRANSITION_FADE_IN: u32 = 4;

/// Transition: vertices move to their partners in the next coarser level.
pub const TRANSITION_GEOMORPH: u32 = 1;

/// Transition: levels change at once. The TRANSITION constants are values of the transition in an object's flags word.
pub const TRANSITION_HARD: u32 = 0;

/// Transition in two phases (thesis A section 7.3.3). First the next level fades in over the opaque current level. Then the next
/// level is opaque while the current level fades out.
pub const TRANSITION_TWO_PHASE: u32 = 5;
}
/// Of `lod/view.wgsl`.
pub mod view {
/// A camera that decides levels of detail.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct LodCamera {
    /// Position of the camera in world units, relative to the corner of the view's cell.
    pub eye: glam::Vec3,
    /// Pixels per world unit at distance 1 along the axis. In a parallel view, pixels per world unit at any distance.
    pub focal: f32,
    /// Unit vector of the view direction, for perspective and parallel views.
    pub ahead: glam::Vec3,
    /// Allowed error on screen, in pixels.
    pub pixels: f32,
    /// Distance of the near plane, in world units.
    pub near: f32,
    /// 1 for a perspective view, 0 for a parallel one.
    pub perspective: f32,
    /// Number of pixels in the viewport.
    pub pixel_count: f32,
    /// Padding, not read.
    pub unused: f32,
}

/// Bound of the relative rounding error of a computation from positions in a view. The error is relative to the sum of these
/// positions' lengths.
pub const POSITION_SLACK: f32 = 3e-6;

/// A view: its volume, and the cameras that decide levels of detail.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct SelectView {
    /// Planes of the view volume, relative to the corner of the view's cell: unit normals that point inwards (xyz), and
    /// distances (w). The plane (0, 0, 0, 1) excludes nothing.
    pub planes: [glam::Vec4; 6],
    /// Cameras that decide levels of detail; the first `camera_count` are valid.
    pub cameras: [crate::shared::lod::view::LodCamera; 4],
    /// Cell of the view. Its corner is the origin of all positions in the view.
    pub cell: glam::IVec3,
    /// Visibility mask, 16 bits: the view sees instances whose mask has a bit in common with this one.
    pub mask: u32,
    /// Number of valid cameras, 1 to `VIEW_CAMERAS`.
    pub camera_count: u32,
    /// 1 if this is the first view of the frame, which resets the allowed displacements; else 0.
    pub is_first: u32,
    /// 1 if the view sees only instances that cast shadows, else 0.
    pub casters: u32,
    /// Number of blocks of instances.
    pub blocks: u32,
    /// 1 if the view was in the last frame too, else 0. If 1, the decisions and placements in the buffers come from the last
    /// frame.
    pub is_next: u32,
    /// Seconds since the view's last frame.
    pub seconds: f32,
    /// Padding, not read.
    pub unused_a: u32,
    /// Padding, not read.
    pub unused_b: u32,
    /// Rows x, y and w of the transform to clip space, scaled to units of half the picture's height. Input positions are
    /// relative to the corner of the view's cell.
    pub clip_rows: [glam::Vec4; 3],
    /// Rows x, y and w of the last frame's transform to clip space, scaled like `clip_rows`. They apply to placements of that
    /// frame.
    pub last_clip_rows: [glam::Vec4; 3],
}

/// Largest number of cameras in a view that decide levels of detail.
pub const VIEW_CAMERAS: u32 = 4;
}
}
/// Of `render/`.
pub mod render {
/// Of `render/output_levels.wgsl`.
pub mod output_levels {
/// Linear colours of levels 0 to 7, from red over yellow and green to blue and violet.
pub const LEVEL_COLORS: [[f32; 3]; 8] = [[0.76, 0.05, 0.05], [0.85, 0.27, 0.02], [0.8, 0.62, 0.03], [0.22, 0.58, 0.06], [0.03, 0.48, 0.4], [0.04, 0.27, 0.7], [0.17, 0.09, 0.62], [0.5, 0.08, 0.55]];
}
/// Of `render/scene_fade.wgsl`.
pub mod scene_fade {
/// Fade method: an instance is blended, with its weight as alpha.
pub const FADE_BLEND: u32 = 2;

/// Fade method: an instance is drawn in a pattern of pixels.
pub const FADE_DITHER: u32 = 1;

/// Fade method: an instance is drawn if its weight is more than half of `FADE_STEPS`.
pub const FADE_HEAVIER: u32 = 3;

/// Fade method of lists in which no instance fades.
pub const FADE_NONE: u32 = 0;

/// Fade method for depth: surfaces are pushed away from the eye. The pushed depth hides the interior of both levels of a
/// cross-fade, but does not hide their outer surfaces.
pub const FADE_PUSHED: u32 = 4;

/// The 1 bits of a scene_word word from bit 31 on.
pub const fn scene_word_counter_clockwise(word: u32) -> u32 {
    word >> 31
}

/// The 8 bits of a scene_word word from bit 20 on.
pub const fn scene_word_fade(word: u32) -> u32 {
    (word >> 20) & 255
}

/// The 20 bits of a scene_word word from bit 0 on.
pub const fn scene_word_instance(word: u32) -> u32 {
    word & 1048575
}

/// The 3 bits of a scene_word word from bit 28 on.
pub const fn scene_word_level(word: u32) -> u32 {
    (word >> 28) & 7
}

/// Packs a word: SceneWord: instance 20, fade 8, level 3, counter_clockwise 1 bits, the lowest first.
pub const fn scene_word_word(instance: u32, fade: u32, level: u32, counter_clockwise: u32) -> u32 {
    assert!(instance <= 0xfffff && fade <= 0xff && level <= 0x7 && counter_clockwise <= 0x1, "a value exceeds its bits: SceneWord: instance 20, fade 8, level 3, counter_clockwise 1");
    instance | (fade << 20) | (level << 28) | (counter_clockwise << 31)
}
}
/// Of `render/scene_instances.wgsl`.
pub mod scene_instances {
/// Smallest absolute determinant of a matrix that is inverted.
pub const LEAST_DETERMINANT: f32 = 1e-30;

/// A chunk: instances of an object that are drawn together.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct SceneObject {
    /// Index of the chunk's first instance in the scene.
    pub first_instance: u32,
    /// Number of the object, counted from 1.
    pub number: u32,
    /// Number of the chunk's first instance in the object, counted from 0.
    pub first_slot: u32,
    /// Distance per level by which the fade method `FADE_PUSHED` pushes surfaces away from the eye, in model units.
    pub push: [glam::Vec4; 2],
}
}
/// Of `render/scene_mesh.wgsl`.
pub mod scene_mesh {
/// Alpha cutoff that marks dithered materials. Their alpha is the fraction of pixels that are drawn.
pub const CUTOFF_DITHERED: f32 = -2.0;

/// Alpha cutoff of materials that ignore alpha.
pub const CUTOFF_OPAQUE: f32 = -1.0;

/// Texture layer of materials that have no texture.
pub const NO_LAYER: u32 = 4294967295;

/// A material in the material table of a part, a piece of the mesh with draws of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SceneMaterial {
    /// Linear RGB and alpha, which multiply the texture.
    pub color: [f32; 4],
    /// Alpha cutoff: pixels with a lower alpha are discarded. `CUTOFF_OPAQUE` and `CUTOFF_DITHERED` are special values.
    pub cutoff: f32,
    /// Array layer of the material's texture, or `NO_LAYER`.
    pub layer: u32,
    /// Array layer of the material's normal map, or `NO_LAYER`.
    pub normal_layer: u32,
    /// Factor of the normal map's x and y components.
    pub normal_scale: f32,
}
}
/// Of `render/scene_relief.wgsl`.
pub mod scene_relief {
/// Lower bound of the cosine between the light and the polygon's normal. It limits the length of the light's path in the relief
/// volume.
pub const LEAST_COSINE: f32 = 0.05;

/// Parameters of a relief. The relief's maps have bindings of their own.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct ReliefParams {
    /// Range of uv that the mesh covers: lower end (xy) and upper end (zw).
    pub range: glam::Vec4,
    /// Linear RGB that multiplies the texture.
    pub color: glam::Vec4,
    /// Depth of the relief, in uv units.
    pub scale: f32,
    /// Height of the polygon in the relief, 0 (bottom) to 1 (top).
    pub plane: f32,
    /// Model units per uv unit.
    pub world: f32,
    /// Number of steps of a soft shadow.
    pub shadow_steps: u32,
    /// Softness of a soft shadow: the shadow is full where the surface rises above the light's path by at least this factor
    /// times the distance from the shaded point.
    pub softness: f32,
}
}
/// Of `render/scene_shadow.wgsl`.
pub mod scene_shadow {
/// Width of the margin in which shadows fade out, as a fraction of the distance from the map's middle to its edge.
pub const SHADOW_FADE: f32 = 0.05;

/// Addend to the sine of the angle between normal and light. It accounts for triangles that lean by up to 0.2 radians from the
/// normals interpolated between their vertices.
pub const SHADOW_LEAN: f32 = 0.2;

/// Bound of the filter's reach in texels, in any direction. Along each axis the reach is below 2, so the bound is 2 · √2.
pub const SHADOW_REACH: f32 = 2.828427;

/// Bound of the rounding error of a distance in the map, as a fraction of the distance between the sun's near and far plane.
pub const SHADOW_ROUNDING: f32 = 2e-6;
}
/// Of `render/scene_terrain.wgsl`.
pub mod scene_terrain {
/// Linear colour of the ground between the edges of the wireframe.
pub const DARK_COLOR: [f32; 3] = [0.01, 0.014, 0.02];

/// Index of the view's last frame in `TerrainView`. If the view was not in the last frame, it equals this frame.
pub const LAST_FRAME: u32 = 1;

/// Linear colour of triangle edges in the wireframe.
pub const LINE_COLOR: [f32; 3] = [0.35, 0.75, 0.5];

/// Fraction of its limit at which a vertex begins to move.
pub const MORPH_START: f32 = 0.6;

/// Number of bisections of the last step.
pub const RELIEF_BISECTIONS: u32 = 4;

/// Least cosine between a ray and the normal: a flatter ray is searched as if it were as steep.
pub const RELIEF_COSINE: f32 = 0.15;

/// `RELIEF_MORE_STEPS` of the shader.
pub const RELIEF_MORE_STEPS: f32 = 48.0;

/// Number of steps of the search along a ray that is perpendicular to the ground, and of additional steps along one in the ground.
pub const RELIEF_STEPS: f32 = 16.0;

/// Limit of a border beside a coarser node: its odd vertices lie in even ones.
pub const STITCHED: f32 = -1.0;

/// Index of this frame in `TerrainView`.
pub const THIS_FRAME: u32 = 0;

/// The cameras of a view in a frame, which decide how far vertices of endless terrain may be displaced.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct TerrainFrame {
    /// Cameras that decide levels of detail; the first `camera_count` are valid. Positions are relative to the corner of the view's
    /// cell in this frame.
    pub cameras: [crate::shared::lod::view::LodCamera; 4],
    /// Number of valid cameras; 0 for terrain of one resolution, which does not morph.
    pub camera_count: u32,
    /// Factor of the displacement that the cameras allow: the fraction that levels of detail may use.
    pub fraction: f32,
}

/// How a node of endless terrain is drawn in a view. A limit is an allowed displacement in world units: where the view allows as much,
/// a vertex has moved onto the triangles of the next coarser level.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct TerrainNode {
    /// Limits of the vertices on the west, east, north and south borders; `STITCHED` beside a coarser node.
    pub borders: [f32; 4],
    /// Limit of all other vertices.
    pub inner: f32,
    /// Where an eroded node meets nodes that are not, one bit each: the sides west, east, north, south, then the corners north-west,
    /// north-east, south-west, south-east. Its vertices there are not eroded either.
    pub plain: u32,
    /// Padding, not read.
    pub unused_b: f32,
    /// Padding, not read.
    pub unused_c: f32,
}

/// Parameters that the patches of a terrain share.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct TerrainParams {
    /// Number of samples along an edge of a window, a patch with a margin on every side.
    pub in_width: u32,
    /// Number of samples along an edge of the patch inside a window.
    pub size: u32,
    /// Distance between samples, in world units.
    pub spacing: f32,
    /// Twice the distance between samples, in 1/65536 world units.
    pub run: f32,
    /// Number of texture tiles from one sample to the next.
    pub tiling: f32,
    /// Number of texture tiles per world unit of height.
    pub tiles_per_unit: f32,
    /// Number of zones.
    pub zone_count: u32,
    /// 1 if zone weights are added without normalization, 0 if they are normalized.
    pub additive: u32,
    /// Number of planes from which textures are projected: 1 (from above) or 3 (triplanar).
    pub planes: u32,
    /// Strength of the colour variation, 0 to 1.
    pub variation: f32,
    /// Number of the chunk's first patch in the object.
    pub first_patch: u32,
    /// Number of normals along an edge of a node, twice the resolution of its samples; 0 for terrain without such normals.
    pub normals_width: u32,
    /// Depth of the textures' relief in world units; 0 for flat textures.
    pub relief_depth: f32,
    /// Distance from the eye in world units from which on textures are flat. The relief fades from half of it on.
    pub relief_distance: f32,
    /// Largest distance in world units by which erosion moves heights; 0 for terrain without erosion.
    pub erosion_depth: f32,
    /// Padding, not read.
    pub unused: f32,
}

/// A patch of a terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct TerrainPatch {
    /// Column and row of the patch's first sample, counted from the terrain's origin.
    pub origin: [i32; 2],
    /// Texture coordinates at the patch's first sample, in tiles, modulo `TILES_PERIOD`.
    pub uv: [f32; 2],
    /// Index of the patch's window in `heights`.
    pub window: u32,
    /// Level of the node: its samples are 2^`level` of the terrain's samples apart. 0 except in endless terrain.
    pub level: u32,
    /// 1 + index of the first word of the patch's holes in `holes`; 0 for a patch without holes.
    pub holes: u32,
    /// Index of the window with the eroded heights; `window` for a patch without.
    pub eroded: u32,
}

/// Placement of a terrain's samples in a view. Positions are relative to a sample near the view, so that they are precise far
/// from the terrain's origin. A sample that several patches share has bit-identical positions in all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct TerrainView {
    /// Column and row of the sample to which positions are relative.
    pub base: glam::IVec2,
    /// Position of the sample `base` at height 0, relative to the corner of the view's cell.
    pub rest: glam::Vec3,
    /// Number of the object, counted from 1.
    pub object: u32,
    /// Cameras of this frame (`THIS_FRAME`) and of the view's last one (`LAST_FRAME`).
    pub frames: [crate::shared::render::scene_terrain::TerrainFrame; 2],
}
}
/// Of `render/scene_vertex.wgsl`.
pub mod scene_vertex {
/// Location of a mesh's vertex data in the buffers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct MeshParams {
    /// Number of clusters of the mesh if each instance has vertices of its own, in pages. 0 if all instances share the mesh's
    /// vertices.
    pub clusters: u32,
    /// Index in `vertices` of the last frame's positions: two pairs of floats per vertex in pages. 0 if vertices do not move.
    pub last: u32,
    /// Index of the first partner word in `material_of`; 0 if the mesh has no partners.
    pub partners: u32,
}

/// The 24 bits of a partner word from bit 0 on.
pub const fn partner_index(word: u32) -> u32 {
    word & 16777215
}

/// The 8 bits of a partner word from bit 24 on.
pub const fn partner_level(word: u32) -> u32 {
    word >> 24
}

/// Packs a word: Partner: index 24, level 8 bits, the lowest first.
pub const fn partner_word(index: u32, level: u32) -> u32 {
    assert!(index <= 0xffffff && level <= 0xff, "a value exceeds its bits: Partner: index 24, level 8");
    index | (level << 24)
}
}
/// Of `render/scene_view.wgsl`.
pub mod scene_view {
/// A view, as the shaders of a scene read it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct SceneView {
    /// Transform from positions relative to the corner of the view's cell to clip space, with depth 0 to 1.
    pub clip_from_world: glam::Mat4,
    /// Transform from last-frame positions, relative to the corner of this frame's cell, to the last frame's clip space.
    pub last_clip_from_world: glam::Mat4,
    /// Position of the eye relative to the corner of the view's cell (w = 1). In a parallel view, the direction towards the eye
    /// (w = 0).
    pub eye: glam::Vec4,
    /// Unit vector towards the light (xyz). w is the ambient light, 0 to 1: the fraction that surfaces facing away still
    /// receive.
    pub light: glam::Vec4,
    /// Linear RGB colour of the light.
    pub light_color: glam::Vec3,
    /// −1 if the view mirrors, else 1.
    pub side: f32,
    /// Cell of the view: all positions are relative to this cell's corner.
    pub cell: glam::IVec3,
    /// Edge length of a shadow map texel, in world units.
    pub shadow_texel: f32,
    /// Rows for u, v and depth of the transform to the shadow map, from positions relative to the corner of the view's cell. All
    /// rows are 0 in a view without a shadow.
    pub shadow_rows: [glam::Vec4; 3],
    /// Offset of dither patterns, in pixels.
    pub dither_offset: glam::UVec2,
}
}
}
/// Of `skinning/`.
pub mod skinning {
/// Of `skinning/cluster.wgsl`.
pub mod cluster {
/// Number of vertices in a cluster. A column of influences has the same number of words, one per vertex.
pub const CLUSTER: u32 = 64;

/// Cluster state: skinned for the first time, or again after it was invisible. Its last positions equal the current ones.
pub const CLUSTER_FRESH: u32 = 2;

/// Cluster state: skinned in this frame. Its last positions come from the last frame.
pub const CLUSTER_MOVED: u32 = 1;

/// Cluster state: not skinned in this frame, so its last positions equal the current ones. States exist only if last positions
/// are kept.
pub const CLUSTER_STILL: u32 = 0;
}
/// Of `skinning/instance_lod.wgsl`.
pub mod instance_lod {
/// Level of detail of one instance in skinning: the influences per vertex, and the mesh level.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct InstanceLod {
    /// Fraction by which weak bone influences are faded out: 0 is full quality, 1 is rigid (one bone per vertex). Also called λ;
    /// see `fade`.
    pub influence_fade: f32,
    /// Largest number of influences per vertex, at least 1. Also called k; see `truncate`. 0 means that the instance is
    /// invisible and is not skinned.
    pub max_influences: u32,
    /// Level of detail of the character's meshes. At level 0, the meshes themselves are drawn. At level n, each mesh uses the
    /// coarsest of its `Mesh::levels` whose error is at most the n-th of `level_errors`. Larger values than the last level count
    /// as the last level.
    pub mesh_lod: u32,
    /// Tier of the skeleton that vertices follow; 0 is the whole skeleton.
    pub tier: u32,
}

/// Largest number of levels of detail of a mesh, the mesh itself included.
pub const MAX_LEVELS: u32 = 16;
}
/// Of `skinning/morph.wgsl`.
pub mod morph {
/// Number of words of an `InstanceLod`.
pub const LOD_WORDS: u32 = 4;

/// Parameters of the kernel `skinning/morph`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct MorphParams {
    /// Number of vertices of the mesh.
    pub vertices: u32,
    /// Number of morph targets.
    pub targets: u32,
    /// Number of instances.
    pub instances: u32,
    /// Number of clusters times number of instances.
    pub pairs: u32,
    /// Number of clusters of the mesh at each level of detail.
    pub levels: [glam::UVec4; 4],
}
}
/// Of `skinning/morph_weights.wgsl`.
pub mod morph_weights {
/// Parameters of the kernel `skinning/morph_weights`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct MorphWeightsParams {
    /// Number of morph targets.
    pub targets: u32,
    /// Number of targets times number of instances.
    pub pairs: u32,
    /// Elapsed time in seconds, the same for all instances. At elapsed time 0, the clip time of an instance is its `start`.
    pub elapsed: f32,
}

/// Location of a clip's morph weights in a set of clips.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct WeightEntry {
    /// The clip's duration in seconds.
    pub duration: f32,
    /// Index of the clip's first key time.
    pub first_time: u32,
    /// Number of keys, at least 1.
    pub keys: u32,
    /// Index of the clip's first value.
    pub first_value: u32,
    /// INTERPOLATION_STEP, INTERPOLATION_LINEAR or INTERPOLATION_SPLINE. A spline key has in-tangents, values and out-tangents.
    pub interpolation: u32,
}
}
/// Of `skinning/page.wgsl`.
pub mod page {
/// Page index of a cluster that has no page.
pub const NO_PAGE: u32 = 4294967295;
}
/// Of `skinning/pages.wgsl`.
pub mod pages {
/// Number of threads of the workgroup.
pub const LANES: u32 = 64;

/// Parameters of the kernel `skinning/pages`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct PageParams {
    /// Number of instances.
    pub instances: u32,
    /// Number of clusters of the mesh, and of table entries per instance.
    pub clusters: u32,
    /// Number of clusters of the mesh at each level of detail.
    pub levels: [glam::UVec4; 4],
}

/// State of the page assignment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct PageState {
    /// Number of free pages, whose indices are at the bottom of the stack.
    pub free: u32,
    /// Number of instances that lacked a page in the last frame. The number is 0, because the host provides enough pages.
    pub short: u32,
}
}
/// Of `skinning/palette.wgsl`.
pub mod palette {
/// Parameters of the kernel `skinning/palette`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct PaletteParams {
    /// Number of bones of the skin.
    pub bones: u32,
    /// Number of bones of the skeleton.
    pub all_bones: u32,
    /// Number of bones of the skin times number of instances.
    pub pairs: u32,
}

/// The 24 bits of a skin_bone word from bit 0 on.
pub const fn skin_bone_index(word: u32) -> u32 {
    word & 16777215
}

/// The 8 bits of a skin_bone word from bit 24 on.
pub const fn skin_bone_tier(word: u32) -> u32 {
    word >> 24
}

/// Packs a word: SkinBone: index 24, tier 8 bits, the lowest first.
pub const fn skin_bone_word(index: u32, tier: u32) -> u32 {
    assert!(index <= 0xffffff && tier <= 0xff, "a value exceeds its bits: SkinBone: index 24, tier 8");
    index | (tier << 24)
}
}
/// Of `skinning/rows.wgsl`.
pub mod rows {
/// A vector has no direction if all its components are smaller than this. Devices may flush smaller values to zero.
pub const LEAST_LENGTH: f32 = 1e-30;
}
/// Of `skinning/select.wgsl`.
pub mod select {
/// Arguments of the skinning dispatch, with the number of pairs and a counter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Dispatched {
    /// Number of workgroups along x.
    pub x: u32,
    /// Number of workgroups along y.
    pub y: u32,
    /// Number of workgroups along z.
    pub z: u32,
    /// Number of pairs to be skinned.
    pub pairs: u32,
    /// Number of pairs found so far.
    pub count: u32,
}

/// Number of words per instance in `skinned` before the instance's weights.
pub const SKINNED_WORDS: u32 = 5;

/// Parameters of the kernel `skinning/select`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct SelectParams {
    /// Number of instances.
    pub instances: u32,
    /// Number of clusters of the mesh.
    pub clusters: u32,
    /// Number of words of a bone set, with one bit per bone.
    pub words: u32,
    /// Largest number of workgroups along x.
    pub most: u32,
    /// Number of vertices of the mesh.
    pub vertices: u32,
    /// Number of morph targets.
    pub targets: u32,
    /// Number of clusters of the mesh at each level of detail.
    pub levels: [glam::UVec4; 4],
}
}
/// Of `skinning/skin.wgsl`.
pub mod skin {
/// Parameters of the kernel `skinning/skin`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct SkinParams {
    /// Number of vertices of the mesh.
    pub vertices: u32,
    /// Number of clusters of the mesh times number of instances.
    pub pairs: u32,
    /// Number of bones of the skin.
    pub bones: u32,
    /// Number of instances.
    pub instances: u32,
    /// Index in `skinned` of the last positions, two pairs per vertex; used with KEEP.
    pub last: u32,
    /// Number of clusters of the mesh at each level of detail.
    pub levels: [glam::UVec4; 4],
}
}
}
/// Of `surface/`.
pub mod surface {
/// Of `surface/cone_map.wgsl`.
pub mod cone_map {
/// Parameters of the kernel `surface/cone_map`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct ConeParams {
    /// Number of texels of a map along x and y.
    pub size: glam::UVec2,
    /// Number of cells of a map along x and y.
    pub cells: glam::UVec2,
    /// Number of nodes per row of one map's pyramid.
    pub pitch: u32,
    /// Number of rows of one map's pyramid.
    pub rows: u32,
    /// Number of cones per row of the output.
    pub cone_pitch: u32,
    /// Address mode: SURFACE_WRAP or SURFACE_CLAMP.
    pub address: u32,
}

/// Smallest rise by which a distance is divided.
pub const LEAST_RISE: f32 = 1e-9;

/// Largest number of nodes that a search visits; no search reaches it.
pub const MAX_VISITS: u32 = 65536;

/// Safety factor of radii, below 1. It reduces a radius by more than rounding can increase it.
pub const NARROWING: f32 = 0.999999;

/// Ratio of distance to size at and above which a node of the pyramid is treated as a whole. Larger values give wider cones and
/// a slower computation. With 4, a march saves one load in 25, and the computation of the map takes 1.5 times as long.
pub const OPENING: f32 = 2.0;

/// Radius of a cone that nothing narrows, in cells at height 1 above its corner.
pub const WIDEST: f32 = 1000000000.0;
}
/// Of `surface/grid.wgsl`.
pub mod grid {
/// A distance in cells that is longer than any ray's path.
pub const SURFACE_FAR: i32 = 1073741824;

/// If a ray travels fewer cells than this along an axis, it never leaves a cell along that axis.
pub const SURFACE_LEAST_TRAVEL: f32 = 1e-6;

/// Largest number of cells that a ray is assumed to cross.
pub const SURFACE_MAX_CROSSED: f32 = 16384.0;

/// A ray parameter that no ray reaches.
pub const SURFACE_NEVER: f32 = 2.0;
}
/// Of `surface/height.wgsl`.
pub mod height {
/// Number of texel loads for one bilinear height.
pub const SURFACE_BILINEAR: u32 = 4;
}
/// Of `surface/height_pyramid.wgsl`.
pub mod height_pyramid {
/// Parameters of the kernel `surface/height_pyramid`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct PyramidParams {
    /// Number of texels of a map along x and y.
    pub size: glam::UVec2,
    /// Number of cells of a map along x and y.
    pub cells: glam::UVec2,
    /// Number of nodes per row of one map's pyramid.
    pub pitch: u32,
    /// Number of rows of one map's pyramid.
    pub rows: u32,
    /// Address mode: SURFACE_WRAP or SURFACE_CLAMP.
    pub address: u32,
    /// Level that is written; level 0 has the leaves.
    pub level: u32,
}
}
/// Of `surface/linear.wgsl`.
pub mod linear {
/// Smallest divisor in `surface_occlusion`. The divisor is the sum of the ray's distances above and below the surface.
pub const SURFACE_LEAST_SPAN: f32 = 1e-12;

/// Largest number of binary steps in a march.
pub const SURFACE_MAX_BINARY: u32 = 24;

/// Largest number of linear steps in a march.
pub const SURFACE_MAX_STEPS: u32 = 1024;
}
/// Of `surface/ray.wgsl`.
pub mod ray {
/// Address mode: beyond the tile, the texels at its edge continue.
pub const SURFACE_CLAMP: u32 = 1;

/// Outcome: the method ran out of steps. The result is the last point that it reached.
pub const SURFACE_EXHAUSTED: u32 = 2;

/// Outcome: the ray met the surface.
pub const SURFACE_HIT: u32 = 1;

/// Smallest cosine of a marched ray (89.55° from the normal). Flatter rays are marched with this cosine, so that no step divides
/// by a value close to 0.
pub const SURFACE_LEAST_COSINE: f32 = 0.0078125;

/// Outcome: the ray comes from behind the polygon.
pub const SURFACE_MISS: u32 = 0;

/// Address mode: the tile repeats.
pub const SURFACE_WRAP: u32 = 0;

/// Result of tracing a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SurfaceHit {
    /// Displaced texture coordinates. They lie outside the tile if the ray left the tile.
    pub uv: [f32; 2],
    /// Height of the surface at the hit, 0 (bottom) to 1 (top).
    pub height: f32,
    /// Parameter of the ray at the hit; it determines the depth.
    pub parameter: f32,
    /// Number of texels loaded, from the height map and the acceleration map.
    pub samples: u32,
    /// Outcome: SURFACE_MISS, SURFACE_HIT or SURFACE_EXHAUSTED.
    pub outcome_code: u32,
}

/// Parameters of a ray march through a relief.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct SurfaceMarch {
    /// Address mode: SURFACE_WRAP or SURFACE_CLAMP.
    pub address: u32,
    /// Number of linear steps for a ray straight down, 1..=1024.
    pub min_steps: u32,
    /// Number of linear steps for a ray at the horizon, 1..=1024.
    pub max_steps: u32,
    /// Number of binary steps after the linear ones.
    pub binary_steps: u32,
    /// Mip level of the height map, chosen once per fragment. Acceleration maps always use level 0.
    pub mip: u32,
}

/// A ray through the relief volume, in tangent space. At parameter t, the ray is at uv origin + t · slope and at height 1 − t.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct SurfaceRay {
    /// uv coordinates where the ray enters the volume, at height 1.
    pub origin: [f32; 2],
    /// Change of uv while the ray falls from height 1 to height 0.
    pub slope: [f32; 2],
    /// Cosine of the angle between the direction to the eye and the normal. A ray with a cosine of 0 or less is a miss.
    pub cosine: f32,
    /// Parameter at which the ray meets the polygon. It is 0 if the polygon is the top of the volume.
    pub polygon: f32,
}
}
/// Of `surface/shade.wgsl`.
pub mod shade {
/// Shading of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Shade {
    /// 1 if the light's ray reaches the point, else 0.
    pub hard: f32,
    /// Light under soft shadow, 0 (full shadow) to 1 (full light).
    pub soft: f32,
    /// Depth of the relief at the point, 0 (near) to 1 (far).
    pub depth: f32,
}

/// A point of a relief, where a ray from the eye met the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct ShadePoint {
    /// Unit vector towards the light, in tangent space.
    pub light: [f32; 3],
    /// Depth of the relief in uv units.
    pub scale: f32,
    /// Point where the eye's ray meets the polygon, in world space.
    pub position: [f32; 3],
    /// Number of world units per uv unit.
    pub world: f32,
    /// Ray from the eye.
    pub ray: crate::shared::surface::ray::SurfaceRay,
    /// Hit of the eye's ray.
    pub hit: crate::shared::surface::ray::SurfaceHit,
}

/// View and shadow parameters that all points of a list share.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct ShadeView {
    /// Matrix from world space to clip space, with depth 0 to 1.
    pub clip_from_world: glam::Mat4,
    /// Position of the eye in world space (w = 1). In a parallel projection, the direction towards the eye (w = 0).
    pub eye: glam::Vec4,
    /// Number of heights that a soft shadow samples on the path to the light, 1 to `MAX_STEPS`.
    pub shadow_steps: u32,
    /// Softness of a soft shadow, 0.001 to 1000: the shadow is full where the surface rises above the light's path by at least
    /// this factor times the distance from the shaded point.
    pub softness: f32,
}
}
/// Of `surface/shadow.wgsl`.
pub mod shadow {
/// Addend to the distance of an occluder, as a fraction of the relief's depth, so that no occluder is at distance 0.
pub const SURFACE_LEAST_OCCLUSION: f32 = 0.001;

/// Height difference below which a point does not shade itself, as a fraction of the relief's depth.
pub const SURFACE_SHADOW_BIAS: f32 = 0.005;
}
/// Of `surface/sunlit.wgsl`.
pub mod sunlit {
/// Kind of self-shadow: full light or none. A ray from the light is traced like the eye's ray.
pub const SURFACE_SHADOW_HARD: u32 = 1;

/// Kind of self-shadow: none.
pub const SURFACE_SHADOW_NONE: u32 = 0;

/// Kind of self-shadow: soft, with penumbras.
pub const SURFACE_SHADOW_SOFT: u32 = 2;
}
/// Of `surface/tangent.wgsl`.
pub mod tangent {
/// A triangle contributes nothing if its area, its tangent or its area in uv is no larger than this. Before the measurement, the
/// triangle is scaled to a box of edge 1, and its uv coordinates to a square of edge 1, u and v separately. Rounding errors are
/// at most a sixteenth of this value. They rotate a tangent of this length by less than four degrees.
pub const DEGENERATE: f32 = 6.1035156e-5;

/// Bits of the f32 2^100. A normal with a larger component counts as a vector without direction.
pub const LARGEST_BITS: u32 = 1904214016;

/// Length below which a vector has no direction: 2^-100.
pub const LEAST: f32 = 7.888609e-31;

/// Bits of the f32 `LEAST`.
pub const LEAST_BITS: u32 = 226492416;

/// Parameters of the kernel `surface/tangent`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct TangentParams {
    /// Number of vertices.
    pub vertices: u32,
}

/// Threshold of two sums at a vertex, as a fraction of the sum of weights. A sum of tangents counts as 0 if its component
/// orthogonal to the normal is no longer than the threshold. The handedness is -1 if the sum of handedness values is below the
/// negative threshold.
pub const VANISHING: f32 = 0.015625;
}
/// Of `surface/trace.wgsl`.
pub mod trace {
/// Method: cone stepping.
pub const SURFACE_CONE: u32 = 5;

/// Method: parallax occlusion mapping, a linear search followed by the intersection with a segment.
pub const SURFACE_OCCLUSION: u32 = 4;

/// Method: Kaneko's parallax mapping.
pub const SURFACE_PARALLAX: u32 = 1;

/// Method: parallax mapping with Welsh's offset limiting.
pub const SURFACE_PARALLAX_LIMITED: u32 = 2;

/// Method: plain texturing, without displacement.
pub const SURFACE_PLAIN: u32 = 0;

/// Method: max-mip traversal (quadtree).
pub const SURFACE_QUADTREE: u32 = 6;

/// Method: relief mapping, a linear search followed by a binary search.
pub const SURFACE_RELIEF: u32 = 3;
}
}
/// Of `terrain/`.
pub mod terrain {
/// Of `terrain/blend.wgsl`.
pub mod blend {
/// Parameters of the kernel `terrain/blend`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct MapParams {
    /// Light of the hill-shading.
    pub light: crate::shared::terrain::light::Light,
    /// Number of samples along an edge of a window.
    pub width: u32,
    /// Twice the distance between samples, in 1/65536 world units.
    pub run: f32,
    /// Number of zones.
    pub zone_count: u32,
    /// 1 if zone weights are added without normalization, 0 if they are normalized.
    pub additive: u32,
    /// Number of planes from which textures are projected: 1 (from above) or 3 (triplanar).
    pub planes: u32,
    /// Number of texture tiles per sample, in 2^-22 tiles.
    pub tiles_per_sample: u32,
    /// Number of texture tiles per world unit of height, in 2^-22 tiles.
    pub tiles_per_unit: u32,
    /// Strength of the colour variation, 0 to 1.
    pub variation: f32,
}
}
/// Of `terrain/border.wgsl`.
pub mod border {
/// Parameters of the kernel `terrain/border`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct BorderParams {
    /// Number of samples along an edge of a patch.
    pub size: u32,
    /// Width of the transition area, in samples.
    pub width: u32,
    /// Index of this dispatch's first entry in `order` and `neighbours`.
    pub start: u32,
}

/// Index of a neighbour that does not exist.
pub const NONE: u32 = 4294967295;
}
/// Of `terrain/despike.wgsl`.
pub mod despike {
/// Parameters of the kernel `terrain/despike`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct DespikeParams {
    /// Feature grids of the windows, which mark injected points.
    pub features: crate::shared::terrain::features::FeatureGrid,
    /// Number of samples along an edge of a window.
    pub width: u32,
    /// Largest difference that is not a spike, in 1/65536 units.
    pub threshold: i32,
}
}
/// Of `terrain/features.wgsl`.
pub mod features {
/// Feature mode: a feature's height is added to the computed height.
pub const FEATURES_ADDITIVE: u32 = 2;

/// Feature mode: a feature's height replaces the computed height.
pub const FEATURES_KEEP: u32 = 1;

/// Feature mode: no features.
pub const FEATURES_NONE: u32 = 0;

/// Size and location of the feature grids of a batch of windows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct FeatureGrid {
    /// Number of points along an edge of the window.
    pub width: u32,
    /// Number of 32-bit words per row of a grid.
    pub words_per_row: u32,
    /// Number of words in the grid of one window.
    pub words_per_window: u32,
    /// Index of the word at which the grid of the first window starts.
    pub start: u32,
}

/// 32 points of a feature grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct FeatureWord {
    /// One bit per point: 1 if the point has a feature.
    pub mask: u32,
    /// Index in `feature_heights` of the height of the word's first feature.
    pub first_value: u32,
}
}
/// Of `terrain/fixed.wgsl`.
pub mod fixed {
/// Largest absolute height, in 1/65536 units.
pub const HEIGHT_LIMIT: i32 = 1073741823;

/// One world unit of height, in 1/65536 units.
pub const HEIGHT_ONE: i32 = 65536;
}
/// Of `terrain/hydraulic.wgsl`.
pub mod hydraulic {
/// Parameters of the kernel `terrain/hydraulic`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct HydraulicParams {
    /// Number of samples along an edge of a window.
    pub in_width: u32,
    /// 0 in the first cycle, which starts without water; else 1.
    pub wet: i32,
    /// 1 in the last cycle, at whose end all sediment settles; else 0.
    pub settles: i32,
    /// Rain: water that falls on each sample in a cycle, in 1/65536 height units.
    pub rain: i32,
    /// Fraction of the water that evaporates in a cycle, in 1/32768.
    pub evaporation: i32,
    /// Erosion rate, in 1/32768 per cycle. While the water carries less sediment than its capacity, this fraction of the
    /// difference is taken from the ground.
    pub erosion: i32,
    /// Fraction of the sediment above the water's capacity that is deposited in a cycle, in 1/32768.
    pub deposition: i32,
    /// Sediment capacity per unit of discharge at a slope of 1, in 1/256.
    pub capacity: i32,
    /// Threshold of two effects, in 1/65536 height units. A discharge up to the threshold carries no sediment. The water that
    /// spreads to each neighbour is at most the threshold.
    pub threshold: i32,
    /// Height difference to the next sample at a slope of 1, in 1/65536 height units. Larger differences are clamped to this
    /// one.
    pub steepest: i32,
    /// Shift in the conversion from a fall (height difference) to a slope. The slope, in 1/4096, is
    /// ((fall >> slope_shift) * slope_factor) >> 15.
    pub slope_shift: u32,
    /// Factor in the conversion from a fall to a slope, see `slope_shift`.
    pub slope_factor: i32,
    /// Largest stable height difference between two neighbours, in 1/65536 height units.
    pub talus: i32,
    /// Fraction of each height difference that creeps downhill in a cycle, in 1/32768, at most 1/16.
    pub creep: i32,
}

/// Largest amount of sediment in the water of a sample, in 1/65536 height units.
pub const SEDIMENT_LIMIT: i32 = 67108864;

/// Largest amount of water on a sample, in 1/65536 height units.
pub const WATER_LIMIT: i32 = 67108864;
}
/// Of `terrain/level.wgsl`.
pub mod level {
/// Parameters of a level of subdivision.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct Level {
    /// Key of the random words.
    pub key: glam::UVec2,
    /// Number of points along an edge of a window at the fine level.
    pub fine_width: u32,
    /// Number of points along an edge of a window at the coarse level.
    pub coarse_width: u32,
    /// Difference of world coordinates between neighbouring fine points.
    pub spacing: u32,
    /// Range of the random offsets, in 1/65536 units. With smooth interpolation, this range applies to the centers of cells.
    pub range: u32,
    /// Range of the random offsets of points on edges, with smooth interpolation, in 1/65536 units.
    pub edge_range: u32,
    /// Feature grids of the windows.
    #[cfg_attr(feature = "gpu", shader(align(16)))]
    pub features: crate::shared::terrain::features::FeatureGrid,
}
}
/// Of `terrain/light.wgsl`.
pub mod light {
/// The sun: a light with one direction for all of the terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct Light {
    /// Unit vector towards the light.
    pub direction: glam::Vec3,
    /// Fraction of the light that a surface facing away still receives, 0 to 1.
    pub ambient: f32,
}
}
/// Of `terrain/limit.wgsl`.
pub mod limit {
/// Parameters of the kernel `terrain/limit`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct LimitParams {
    /// Number of heights along an edge of a region.
    pub width: u32,
    /// Number of heights in a row of the eroded ones.
    pub eroded_width: u32,
    /// Largest distance, in 1/65536 units.
    pub most: i32,
}
}
/// Of `terrain/morph.wgsl`.
pub mod morph {
/// Parameters of the kernel `terrain/morph`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct MorphParams {
    /// Number of vectors of four heights.
    pub vectors: u32,
    /// Time of the blend: 0 (start heights) to 65536 (target heights).
    pub time: u32,
}
}
/// Of `terrain/node.wgsl`.
pub mod node {
/// Stage: the deviation beside stitched borders.
pub const BORDERS: u32 = 1;

/// Stage: tiles, and all facts but that of stitched borders.
pub const INSIDE: u32 = 0;

/// Number of words that a node's facts take.
pub const NODE_FACTS: u32 = 5;

/// Width in samples of the margin around a node in its tile.
pub const NODE_MARGIN: u32 = 2;

/// Parameters of the kernel `terrain/node`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct NodeParams {
    /// Number of samples along an edge of a region: (`size` − 1 + 2 · `NODE_MARGIN`) · 2^`finer` + 1.
    pub width: u32,
    /// Number of regions.
    pub count: u32,
    /// Number of samples along an edge of a node, without its margin.
    pub size: u32,
    /// Number of levels by which the regions are finer than the nodes.
    pub finer: u32,
}

/// Number of finer samples for each thread of the first stage.
pub const ROWS: u32 = 8;

/// Added to a height, it makes the order of heights that of unsigned words.
pub const SIGN: u32 = 2147483648;
}
/// Of `terrain/node_normals.wgsl`.
pub mod node_normals {
/// Parameters of the kernel `terrain/node_normals`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct NodeNormalsParams {
    /// Number of samples along an edge of a region.
    pub width: u32,
    /// Number of normals along an edge of a node.
    pub size: u32,
    /// Column and row of the first normal in a region.
    pub first: u32,
    /// Number of samples of the region from one normal to the next.
    pub step: u32,
    /// Twice the distance between normals, in 1/65536 world units.
    pub run: f32,
}
}
/// Of `terrain/noise.wgsl`.
pub mod noise {
/// 2^32 divided by the golden ratio.
pub const GOLDEN: u32 = 2654435769;

/// Generator: fractional Brownian motion over gradient noise.
pub const NOISE_FBM: u32 = 0;

/// Generator: ridged multifractal over gradient noise with random values.
pub const NOISE_RIDGED: u32 = 1;

/// Generator: fractional Brownian motion over simplex noise.
pub const NOISE_SIMPLEX: u32 = 2;

/// Parameters of the kernel `terrain/noise`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct NoiseParams {
    /// Key of the random words.
    pub key: glam::UVec2,
    /// Number of samples along an edge of a region.
    pub width: u32,
    /// Difference of world coordinates between neighbouring samples.
    pub spacing: u32,
    /// Binary logarithm of the base lattice's spacing in world coordinates, 12 to 20.
    pub base_log2: u32,
    /// Number of octaves, at most 20.
    pub octaves: u32,
    /// Ranges of the octaves, in 1/65536 units.
    #[cfg_attr(feature = "gpu", shader(align(16)))]
    pub ranges: [glam::UVec4; 5],
}

/// Multiplier of the vertical positions of triangular lattices.
pub const SHIFT_Y: u32 = 2246822507;
}
/// Of `terrain/normals.wgsl`.
pub mod normals {
/// Parameters of the kernel `terrain/normals`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct NormalsParams {
    /// Number of samples along an edge of a window.
    pub width: u32,
    /// Twice the distance between samples, in 1/65536 world units.
    pub run: f32,
}
}
/// Of `terrain/offset.wgsl`.
pub mod offset {
/// Distribution of offsets: nearly Gaussian in ±range.
pub const OFFSET_GAUSSIAN: u32 = 2;

/// Distribution of offsets: uniform in 0 to range.
pub const OFFSET_POSITIVE: u32 = 1;

/// Distribution of offsets: uniform in ±range.
pub const OFFSET_SIGNED: u32 = 0;
}
/// Of `terrain/pad.wgsl`.
pub mod pad {
/// Index of a patch that lies in another buffer.
pub const ELSEWHERE: u32 = 4294967294;

/// Index of a patch that does not exist.
pub const NONE: u32 = 4294967295;

/// Parameters of the kernel `terrain/pad`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct PadParams {
    /// Number of samples along an edge of a patch.
    pub size: u32,
    /// Number of samples by which a window extends beyond its patch on every side.
    pub apron: u32,
}
}
/// Of `terrain/replace.wgsl`.
pub mod replace {
/// A height that is not given.
pub const NOT_GIVEN: i32 = -2147483647;

/// Parameters of the kernel `terrain/replace`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct ReplaceParams {
    /// Number of heights along an edge of a region.
    pub width: u32,
}
}
/// Of `terrain/smooth.wgsl`.
pub mod smooth {
/// Stage: a thread computes the centers of coarse cells.
pub const CENTERS: u32 = 0;

/// Stage: a thread writes the fine points that belong to coarse points, four for each.
pub const EDGES: u32 = 1;

/// Number of coarse cells or points of a thread, one below the other: one for each component of a vector.
pub const ROWS: u32 = 4;
}
/// Of `terrain/texturing.wgsl`.
pub mod texturing {
/// Period of texture coordinates in tiles. The host subtracts whole multiples of this period.
pub const TILES_PERIOD: u32 = 1024;

/// Number of projection planes of triplanar mapping.
pub const TRIPLANAR_PLANES: u32 = 3;
}
/// Of `terrain/thermal.wgsl`.
pub mod thermal {
/// Parameters of the kernel `terrain/thermal`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(encase::ShaderType))]
pub struct ThermalParams {
    /// Number of samples along an edge of a window.
    pub width: u32,
    /// Largest stable height difference between neighbours, in 1/65536 units.
    pub threshold: i32,
}
}
/// Of `terrain/tiles.wgsl`.
pub mod tiles {
/// A zone of the ground and its texture, for colour maps.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct MapZone {
    /// The zone.
    pub zone: crate::shared::terrain::zones::Zone,
    /// Index of the first texel of the zone's texture.
    pub first: u32,
    /// Binary logarithm of the number of texels along an edge of the zone's texture.
    pub edge_log2: u32,
}

/// Number of fractional bits of a position in tiles. The integer part has 10 bits, enough for TILES_PERIOD.
pub const TILE_BITS: u32 = 22;
}
/// Of `terrain/zones.wgsl`.
pub mod zones {
/// A kind of ground: the heights and slopes where it lies, and how its texture is blended with other textures.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Zone {
    /// Lower end of the zone's range of heights, in height units.
    pub min: f32,
    /// Upper end of the zone's range of heights, in height units. The weight is greatest there.
    pub max: f32,
    /// Weight that grows with steepness: rise.x * steepness + rise.y, clamped to 0 to 1. The pair (0, 1) gives weight 1 on all
    /// slopes.
    pub rise: [f32; 2],
    /// Weight that falls with steepness: fall.x * steepness + fall.y, clamped to 0 to 1. It is multiplied by the weight of
    /// `rise`.
    pub fall: [f32; 2],
    /// Influence of the texture's height map where zones meet, 0 to 1.
    pub height_blend: f32,
    /// Number of times that the texture repeats in a texture tile: a whole number, 1 to 16.
    pub repeats: f32,
}
}
}
