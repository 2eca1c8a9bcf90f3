//! Which bones of which instances are sampled in a frame: animation level of detail (A sections 10 to 12).
//!
//! A gate decides from whole numbers, so every device decides alike, and it saves work: bones that it leaves out are
//! neither sampled nor, unless a bone above them is active, concatenated. A bone that is left out keeps its last local
//! transform. Bones that their clip does not move cost nothing in any mode.
//!
//! What precedes and follows it in a frame: `animation::frame`.

#[cfg(feature = "verify")]
pub(crate) mod bench;
#[cfg(feature = "gpu")]
pub(crate) mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub(crate) mod verify;

#[cfg(feature = "gpu")]
pub use pass::{GateJob, GatePass};

/// How bones are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Gate {
    /// Every bone that moves.
    Off,
    /// A's rule (section 12.10): a bone *skips* one update each `priority · Ω · period`. Its table is
    /// [`GateTable::of_priorities`](super::gate_table::GateTable::of_priorities).
    SkipPeriod {
        /// Ticks of priority 1 at Ω = 1; A has one second.
        period: u32,
    },
    /// All bones of an instance together, in a share Ω of the frames: what engines call update-rate optimization.
    Uniform,
    /// A share Ω of all bones, by a hash of frame and bone: as many as [`Gate::Uniform`], on average.
    Random,
    /// Bones that may have moved further than the instance allows, parents first: a bone that missed no more than its share
    /// of what is left stays as it is and leaves the rest to the bones below it; one that missed more is sampled, and
    /// leaves them everything. So bones take turns, and what one does not use another does. Its table is
    /// [`GateTable::of_bounds`](super::gate_table::GateTable::of_bounds): no point is ever further from its place than
    /// [`Lod::allowed`](super::lod::Lod::allowed), nor any vertex that bones blend linearly. Dual quaternions are no
    /// convex mean, so the promise does not hold for them: skinning refuses them under this gate.
    Bounded,
}

impl Gate {
    /// The name on command lines and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::SkipPeriod { .. } => "skip-period",
            Self::Uniform => "uniform",
            Self::Random => "random",
            Self::Bounded => "bounded",
        }
    }
}

/// When a frame is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Frame {
    /// A clock that never goes back, in ticks of any length; begins again after 2³².
    pub ticks: u32,
    /// Ticks since the last frame.
    pub frame_ticks: u32,
    /// Frames so far.
    pub frame: u32,
    /// Seconds by which [`Gate::Bounded`] may sample a bone ahead of its time: a bone that is off by as much before as after
    /// stays twice as long. About a frame's length; 0 for never.
    pub ahead: f32,
}
