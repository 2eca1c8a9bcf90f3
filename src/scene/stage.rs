//! The stages of a frame's compute work.

/// Number of stages of a frame.
pub(super) const STAGES: usize = 5;

/// A stage of a frame's compute work. Each is recorded for all objects and views before the next one begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stage {
    /// Culling and level selection of all views.
    Select,
    /// Choice of the bones to sample.
    Gate,
    /// Local transforms of sampled bones, and weights of morph targets.
    Sample,
    /// Model matrices of updated bones.
    LocalToModel,
    /// Skinned vertices.
    Skin,
}

impl Stage {
    /// All stages, in order.
    pub const ALL: [Self; STAGES] = [Self::Select, Self::Gate, Self::Sample, Self::LocalToModel, Self::Skin];

    /// All stages, in a single compute pass.
    pub const WHOLE: [&[Self]; 1] = [&Self::ALL];

    /// Each stage in a compute pass of its own.
    pub const EACH: [&[Self]; STAGES] =
        [&[Self::Select], &[Self::Gate], &[Self::Sample], &[Self::LocalToModel], &[Self::Skin]];

    /// Two compute passes. Between them, the caller may write poses.
    pub const HALVES: [&[Self]; 2] =
        [&[Self::Select, Self::Gate, Self::Sample], &[Self::LocalToModel, Self::Skin]];

    /// The label of the stage's compute pass.
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
