//! Assignment of allowed displacements: the CPU reference of `kernels/lod/assign.wgsl`.

use super::AssignParams;
use crate::animation::{BoneSampling, Lod};
use crate::shared::lod::assign::{FADE_STEPS, MAX_UNITS};
use crate::skinning::instance_lod::InstanceLod;

/// Inputs of an assignment for one instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AssignInstance {
    /// Displacement that the frame's views allow, in model units; negative if no view sees the instance.
    pub allowed: f32,
    /// Finest level of detail that any view draws.
    pub finest: u32,
    /// Whether the instance carries an attached mesh. If so, no bone may be displaced.
    pub carries: bool,
}

/// Levels of detail of an instance: one for its bone gate, one for its skinning.
pub fn assign(params: &AssignParams, instance: &AssignInstance) -> (Lod, InstanceLod) {
    let AssignInstance { allowed, finest, carries } = *instance;
    if allowed < 0.0 {
        return (Lod { sampling: BoneSampling::Hidden, ..Lod::FULL }, InstanceLod::UNSEEN);
    }
    let units = if carries { 0.0 } else { units(params, allowed) };
    let lod = Lod { allowed: units.floor().min(MAX_UNITS) as u32, ..Lod::FULL };
    let instance_lod = InstanceLod {
        influence_fade: fade_steps(params, allowed).floor() / FADE_STEPS,
        max_influences: params.max_influences,
        mesh_lod: finest,
    };
    (lod, instance_lod)
}

/// Part of the allowed displacement that bones may use, in units of the gate's table.
pub fn units(params: &AssignParams, allowed: f32) -> f32 {
    params.bone_fraction * allowed / params.unit
}

/// How far influences may fade, in steps: 0 (all influences) to `FADE_STEPS` (one influence).
pub fn fade_steps(params: &AssignParams, allowed: f32) -> f32 {
    if params.stray <= 0.0 {
        return FADE_STEPS;
    }
    FADE_STEPS * (params.influence_fraction * allowed / params.stray).min(1.0)
}
