//! Measures what level of detail saves and what error it causes, for the caller's own models: times and
//! errors against full evaluation of the same crowd. The library's own figures are made with these functions
//! (`relievo crowd`). [`relief`] measures surface mapping on the caller's own maps.
//!
//! | call | what is compared | where |
//! |---|---|---|
//! | [`animation()`] | a gated crowd with the same crowd in full, at several distances (A section 13): bones that were interpolated and concatenated, nanoseconds by stage, errors of points around each bone | GPU or CPU |
//! | [`drawn`] | the same, and the crowd as a scene draws it, within some pixels and in full detail: whole frames, displacements | GPU |
//! | [`scene()`] | whole frames of a scene without level of detail; with it in animation, in skinning (A section 8.4), and in both; and in the meshes too | GPU |
//! | [`pareto()`] | every gate at many settings: errors against the number of bones interpolated, and the gates' curves with each other | CPU |
//! | [`distance_sweep()`] | the test of A section 13 by scenes: frame rates, interpolations and errors of four modes while the camera moves away | GPU; also compiles for browsers |
//! | [`reduction::reduction`] | a model with its levels of detail by some reducer: distances between their surfaces, both ways | CPU |
//! | [`reduction::ReducerComparison`] | all reducers beside each other | CPU |
//!
//! [`DisplacementMeter`] measures frames of the caller's own [`Scene`](relievo::scene::Scene): how many pixels what a view
//! draws is off, with the caller's camera, however it moves. [`ScenePlay`] draws the frames of a scene file, counts what is
//! drawn, and compares each with the same frame at full detail: cost, displacement, and [`mean_flip`] of the pictures.
//! [`CharacterDump`] writes where every bone was drawn, for anybody who wants to check that with a player of their own.
//!
//! # What stays the same
//!
//! Every instance plays the same clip in a loop, from its own start time, which is drawn from a seed. The camera
//! does not move: it looks at the crowd's center at half its height, so that instances keep their distances, and
//! a gate's levels of detail do not change during a run. The picture has 1080 lines and a vertical field of view
//! of 60 degrees.
//!
//! # Units
//!
//! Distances are in *units*: the largest extent of the model at rest is [`CrowdOptions::size`] units long. Models
//! of all sizes can thus be compared, and the distances 200 to 1700 of A apply. Metres stand for the model's own
//! unit; pixels are those of the picture; times are in nanoseconds. Times are medians and depend on the machine;
//! all other values are the same in every run on one machine.
//!
//! # An example
//!
//! ```
//! use relievo_lab::measure::{CrowdOptions, GateMode, LodOptions, Subject, animation};
//!
//! let model = relievo_samples::creature()?; // or Model::from_file("fox.glb")?
//! let options = LodOptions {
//!     crowd: CrowdOptions { instances: 2, frames: 10, ..CrowdOptions::default() },
//!     gate: GateMode::Bounded { pixels: 2.0 },
//!     distances: vec![900.0],
//! };
//! let subject = Subject { name: "creature", model: &model, clip: 0 };
//! let report = animation(None, subject, &options, &|_| ())?;
//! let row = &report.distances[0];
//! assert!(row.error.max_pixels <= 2.0 && row.interpolated > 0);
//! # Ok::<(), relievo::Error>(())
//! ```

pub use distance_sweep::{
    Clock, DistanceSweepOptions, DistanceSweepReport, GroupLayout, SWEEP_MODES, SweepError, SweepLayout,
    SweepRow, distance_sweep,
};
pub use gates::{GateMode, GateName};
pub use options::{CrowdOptions, Detail, DrawnOptions, Layout, LodOptions, ParetoOptions, Subject};
pub use progress::{Listener, Progress};

#[cfg(not(target_arch = "wasm32"))]
pub use animation::{AnimationReport, AnimationRow, DrawnRow, animation, drawn};
#[cfg(not(target_arch = "wasm32"))]
pub use displacement::{Displacement, DisplacementMeter};
#[cfg(not(target_arch = "wasm32"))]
pub use drawing::FrameCost;
#[cfg(not(target_arch = "wasm32"))]
pub use dump::CharacterDump;
#[cfg(not(target_arch = "wasm32"))]
pub use errors::{Errors, Jump};
#[cfg(not(target_arch = "wasm32"))]
pub use flip::mean_flip;
#[cfg(not(target_arch = "wasm32"))]
pub use frames::{
    Compared, DrawnLevel, FrameReport, FrameSummary, NodeCounts, ObjectFrame, ObjectReport, ScenePlay,
};
#[cfg(not(target_arch = "wasm32"))]
pub use levels::LevelReport;
#[cfg(not(target_arch = "wasm32"))]
pub use pareto::{AtCost, AtError, Comparisons, ParetoPoint, ParetoReport, pareto};
#[cfg(not(target_arch = "wasm32"))]
pub use play::StageTimes;
#[cfg(not(target_arch = "wasm32"))]
pub use player::{FrameTimes, Player, Rendering, SurfacePixel};
#[cfg(not(target_arch = "wasm32"))]
pub use scene::{Cheaper, SceneReport, SceneRow, scene};
#[cfg(not(target_arch = "wasm32"))]
pub use setting::Setting;

mod bounds;
pub mod distance_sweep;
mod extent;
mod gates;
mod options;
mod placement;
mod progress;
mod tally;

#[cfg(not(target_arch = "wasm32"))]
mod animation;
#[cfg(not(target_arch = "wasm32"))]
mod cpu;
#[cfg(not(target_arch = "wasm32"))]
mod device;
#[cfg(not(target_arch = "wasm32"))]
mod displacement;
#[cfg(not(target_arch = "wasm32"))]
mod drawing;
#[cfg(not(target_arch = "wasm32"))]
mod dump;
#[cfg(not(target_arch = "wasm32"))]
mod errors;
#[cfg(not(target_arch = "wasm32"))]
mod flip;
#[cfg(not(target_arch = "wasm32"))]
mod frames;
#[cfg(not(target_arch = "wasm32"))]
mod levels;
#[cfg(not(target_arch = "wasm32"))]
mod pareto;
#[cfg(not(target_arch = "wasm32"))]
mod play;
#[cfg(not(target_arch = "wasm32"))]
mod player;
#[cfg(not(target_arch = "wasm32"))]
pub mod reduction;
#[cfg(not(target_arch = "wasm32"))]
pub mod relief;
#[cfg(not(target_arch = "wasm32"))]
mod scene;
#[cfg(not(target_arch = "wasm32"))]
mod setting;
#[cfg(not(target_arch = "wasm32"))]
mod stage;
