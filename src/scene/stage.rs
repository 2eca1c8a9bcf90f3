//! The stages of a frame's compute work.

/// Number of stages of a frame.
pub(super) const STAGES: usize = 5;

/// A stage of a frame's compute work. Each is recorded for everything before the next one begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// What views see and how fine.
    Select,
    /// Which bones are sampled.
    Gate,
    /// Their local transforms, and the weights of morph targets.
    Sample,
    /// Their model matrices.
    LocalToModel,
    /// The vertices.
    Skin,
}

impl Stage {
    /// All stages, in order.
    pub const ALL: [Self; STAGES] = [Self::Select, Self::Gate, Self::Sample, Self::LocalToModel, Self::Skin];

    /// All in one run.
    pub const WHOLE: [&[Self]; 1] = [&Self::ALL];

    /// Each in a run of its own.
    pub const EACH: [&[Self]; STAGES] =
        [&[Self::Select], &[Self::Gate], &[Self::Sample], &[Self::LocalToModel], &[Self::Skin]];

    /// In two runs, between which the caller may write poses.
    pub const HALVES: [&[Self]; 2] =
        [&[Self::Select, Self::Gate, Self::Sample], &[Self::LocalToModel, Self::Skin]];

    /// The label of its compute pass.
    pub fn label(self) -> &'static str {
        match self {
            Self::Select => "scene: select",
            Self::Gate => "scene: gate",
            Self::Sample => "scene: sample",
            Self::LocalToModel => "scene: local to model",
            Self::Skin => "scene: skin",
        }
    }
}
