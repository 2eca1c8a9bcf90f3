//! Assignment of allowed displacements: the CPU reference of `kernels/lod/assign.wgsl`.

use super::AssignParams;
use crate::animation::{BoneSampling, Lod};
use crate::shared::lod::assign::{FADE_STEPS, MAX_UNITS};
use crate::skinning::instance_lod::InstanceLod;

/// The gate's and the skinning's level of detail for an instance. `allowed` is its allowed displacement in the model's
/// units, negative if no view sees it, `finest` the finest level that is drawn. With `carries`, the instance carries a mesh,
/// and no bone may be off.
pub fn assign(params: &AssignParams, allowed: f32, finest: u32, carries: bool) -> (Lod, InstanceLod) {
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
