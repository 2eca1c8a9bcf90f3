//! Animation level of detail: which bones of which instances are sampled in a frame (A sections 10 to 12).
//!
//! A gate decides from integers, so that every device decides alike. It saves work: a bone that is not sampled
//! keeps its last local transform and, unless a bone above it is active, is not concatenated either. Bones that
//! their clip does not move cost nothing under any gate.
//!
//! [`animation::frame`](super::frame) has the steps of a frame before and after the gate.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
pub(crate) mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{GateJob, GatePass};

/// How the bones to be sampled are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Gate {
    /// Every bone that moves is sampled.
    Off,
    /// A's rule (section 12.10): a bone *skips* one update per period of `priority · Ω · period` ticks. It
    /// needs the table [`GateTable::of_priorities`](super::gate_table::GateTable::of_priorities).
    SkipPeriod {
        /// The period in ticks for priority 1 at Ω = 1; A uses one second.
        period: u32,
    },
    /// All bones of an instance together, in a fraction Ω of the frames; engines call this update-rate
    /// optimization.
    Uniform,
    /// A random fraction Ω of all bones, by a hash of frame and bone: on average as many as [`Gate::Uniform`].
    Random,
    /// Bones that may have moved further than the instance permits, parents first. A bone that missed no more
    /// than its fraction of the remaining error budget is not sampled, and passes the rest on to the bones
    /// below it. A bone that missed more is sampled, and passes on all of it. Bones thus take turns, and one
    /// uses what another does not. It needs the table
    /// [`GateTable::of_bounds`](super::gate_table::GateTable::of_bounds). No point, and no vertex under linear
    /// blending, is ever further from its place than [`Lod::allowed`](super::lod::Lod::allowed). Dual
    /// quaternions are not convex combinations, so that the bound does not hold for them; skinning refuses them
    /// under this gate.
    Bounded,
}

impl Gate {
    /// The gate's name on the command line and in reports.
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

/// The time of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Frame {
    /// A monotonic clock in ticks of any length; it wraps at 2³².
    pub ticks: u32,
    /// Ticks since the last frame.
    pub frame_ticks: u32,
    /// Number of frames so far.
    pub frame: u32,
    /// Seconds by which [`Gate::Bounded`] may sample a bone ahead of its time: a bone that is off by as much
    /// before as after can stay twice as long. Use about the length of a frame; 0 disables it.
    pub ahead: f32,
}
