//! The part of the reports over distances that says what was measured.

use std::collections::BTreeMap;

use relievo::gpu::Gpu;
use serde::Serialize;

use crate::harness::TimedBy;
use crate::measure::gates::GateMode;
use crate::measure::options::{DrawnOptions, Layout, LodOptions};
use crate::measure::stage::Stage;

/// What was measured, and how.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Setting {
    /// The device's adapter; `None` on the CPU.
    pub adapter: Option<String>,
    /// The device's driver; `None` on the CPU.
    pub driver: Option<String>,
    /// The clock that took the times.
    pub timed_by: TimedBy,
    /// The model's name.
    pub model: String,
    /// The clip's name.
    pub clip: String,
    /// The gate.
    pub gate: GateMode,
    /// The caller's priorities of bones by name or index; other bones have 0.5.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub priorities: BTreeMap<String, f32>,
    /// Number of instances.
    pub instances: usize,
    /// How the instances are placed.
    pub layout: Layout,
    /// The seed of the instances' random positions and start times.
    pub seed: u32,
    /// Number of bones of an instance.
    pub bones: usize,
    /// Number of units in the model's largest extent.
    pub size: f32,
    /// Length of a unit in metres of the model.
    pub metres_a_unit: f32,
    /// The gap between neighbours in a grid, in multiples of the model's size.
    pub spacing: f32,
    /// Distances in units: up to the first Ω is 1, from the second on it is 0.
    pub range: [f32; 2],
    /// Number of frames that were measured, after a first frame in full.
    pub frames: u32,
    /// Frames per second.
    pub rate: f64,
    /// The focal length: the size in pixels of a metre at a distance of one metre (1080 lines, 60 degrees).
    pub focal_pixels: f32,
}

/// A reduced skeleton as it was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TierReport {
    /// The fraction of bones to keep.
    pub bones: f32,
    /// Whether each vertex follows one bone.
    pub rigid: bool,
}

impl TierReport {
    pub(crate) fn of(drawn: &DrawnOptions) -> Vec<Self> {
        let tiers = drawn.tiers.iter();
        tiers.map(|tier| Self { bones: tier.bones, rigid: tier.is_rigid }).collect()
    }
}

impl Setting {
    pub(crate) fn new(gpu: Option<&Gpu>, timed_by: TimedBy, stage: &Stage<'_>, options: &LodOptions) -> Self {
        let (adapter, crowd) = (gpu.map(Gpu::adapter), stage.options);
        Self {
            adapter: adapter.map(|adapter| adapter.name.clone()),
            driver: adapter.map(|adapter| adapter.driver.clone()),
            timed_by,
            model: stage.subject.name.to_owned(),
            clip: stage.clip.name().to_owned(),
            gate: options.gate,
            priorities: crowd.priorities.clone(),
            instances: crowd.instances,
            layout: crowd.layout,
            seed: crowd.seed,
            bones: stage.set.bones(),
            size: crowd.size,
            metres_a_unit: stage.metres_a_unit,
            spacing: crowd.spacing,
            range: [crowd.range.min, crowd.range.max],
            frames: crowd.frames,
            rate: crowd.rate,
            focal_pixels: stage.projection.focal_pixels,
        }
    }
}
