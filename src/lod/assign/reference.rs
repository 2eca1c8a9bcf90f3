//! Assignment of allowed displacements: the CPU reference of `kernels/lod/assign.wgsl`.

use super::AssignParams;
use crate::animation::{BoneSampling, Lod};
use crate::shared::lod::assign::{FADE_STEPS, MAX_UNITS};
use crate::skinning::instance_lod::InstanceLod;

/// An instance whose level of detail is assigned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AssignInstance {
    /// The displacement that the frame's views allow, in the model's units; negative if no view sees it.
    pub allowed: f32,
    /// The finest level that is drawn.
    pub finest: u32,
    /// Whether it carries a mesh: then no bone may be off.
    pub carries: bool,
}

/// The gate's and the skinning's level of detail for an instance.
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

/// The allowed displacement of bones, in units of the gate's table.
pub fn units(params: &AssignParams, allowed: f32) -> f32 {
    params.bone_fraction * allowed / params.unit
}

/// The allowed fade of influences, in steps.
pub fn fade_steps(params: &AssignParams, allowed: f32) -> f32 {
    if params.stray <= 0.0 {
        return FADE_STEPS;
    }
    FADE_STEPS * (params.influence_fraction * allowed / params.stray).min(1.0)
}
