//! Keyframed, articulated models: skeletons and clips, their import from glTF, a built-in creature (A sections 9
//! to 14); crowds of them on the device, with layers, bounds, and root motion for the host.

#[cfg(feature = "verify")]
pub mod bench;
pub mod bounds;
pub mod budget;
#[cfg(feature = "gpu")]
pub mod chosen;
pub mod clip_set;
pub mod compact;
pub mod concat;
pub mod crowd;
pub mod decide;
#[cfg(feature = "gpu")]
pub mod frame;
pub mod gate;
pub mod gate_table;
pub mod layers;
pub mod lod;
#[cfg(feature = "gpu")]
pub mod model_matrices;
pub mod motion;
pub mod phase;
pub mod place;
pub mod priority;
pub mod root_motion;
pub mod sample;
#[cfg(feature = "verify")]
pub mod verify;

pub use bounds::Bounds;
pub use clip_set::ClipSet;
pub use concat::Order;
pub use decide::Choice;
pub use gate::{Frame, Gate};
pub use gate_table::GateTable;
pub use layers::Layer;
pub use lod::{Lens, Lod, Range};
pub use model_matrices::ModelMatrices;
pub use place::Instance;
pub use priority::{Priorities, Weights};
pub use root_motion::RootMotion;
pub use sample::{RotationPath, Wrap};
