//! Keyframe animation of skeletons (thesis A, sections 9 to 14). Crowds of instances on the device have animation layers, gates
//! (animation level of detail) and bounds. Root motion is computed on the host.

pub mod active;
pub mod bounds;
pub mod budget;
pub mod clip_clock;
pub mod clip_set;
pub mod compact;
#[cfg(feature = "gpu")]
pub mod crowd;
pub mod drive;
pub mod frame;
pub mod gate;
#[cfg(feature = "gpu")]
pub mod gate_state;
pub mod gate_table;
pub mod instance;
pub mod keyframe_cursor;
pub mod layers;
pub mod local_to_model;
pub mod lod;
#[cfg(feature = "gpu")]
pub mod model_matrices;
pub mod motion;
pub mod order;
pub mod pose;
pub mod priority;
pub mod root_motion;
pub mod sample;
#[cfg(feature = "gpu")]
pub mod updated_bones;

use crate::asset::Interpolation;
pub use crate::asset::keyframe::RotationPath;
use crate::shared::animation::interpolation;
pub use bounds::MotionBounds;
pub use clip_set::ClipSet;
pub use gate::{Frame, Gate};
#[cfg(feature = "gpu")]
pub use gate_state::GateState;
pub use gate_table::{AnimatedBones, BoundTable, ExpectationTable, PriorityTable};
pub use instance::{Instance, Wrap};
pub use layers::AnimationLayer;
pub use lod::{BoneSampling, Lod, Projection, Range};
#[cfg(feature = "gpu")]
pub use model_matrices::ModelMatrices;
pub use order::Order;
pub use pose::Pose;
pub use priority::{Priorities, Weights};
pub use root_motion::RootMotion;
#[cfg(feature = "gpu")]
pub use updated_bones::UpdatedBones;

// `relievo-asset` repeats the constants of the shaders.
const _: () = assert!(Interpolation::Step as u32 == interpolation::INTERPOLATION_STEP);
const _: () = assert!(Interpolation::Linear as u32 == interpolation::INTERPOLATION_LINEAR);
const _: () = assert!(Interpolation::CubicSpline as u32 == interpolation::INTERPOLATION_SPLINE);
