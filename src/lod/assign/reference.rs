//! Assignment of allowed displacements: the CPU reference of `kernels/lod/assign.wgsl`.

use super::AssignParams;
use crate::animation::lod::{FULL_WEIGHT, OMEGA_ONE};
use crate::animation::{BoneSampling, Lod};
use crate::shared::lod::allowed::Allowed;
use crate::shared::lod::assign::{FADE_STEPS, MAX_TIERS, MAX_UNITS, TIER_HYSTERESIS};
use crate::skinning::instance_lod::InstanceLod;

/// Inputs of an assignment for one instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AssignInstance {
    /// What the frame's views allow, in model units; a negative displacement if no view sees the instance.
    pub allowed: Allowed,
    /// Finest level of detail that any view draws.
    pub finest: u32,
    /// Whether the instance carries an attached mesh. If so, no bone may be displaced.
    pub carries: bool,
    /// Whether the instance needs all bones of its skeleton.
    pub is_whole: bool,
    /// Skeleton tier of the last frame; 0 if no view saw the instance.
    pub last_tier: u32,
}

/// Levels of detail of an instance: one for its bone gate, one for its skinning.
pub fn assign(params: &AssignParams, instance: &AssignInstance) -> (Lod, InstanceLod) {
    let AssignInstance { allowed: Allowed { displacement, distance }, finest, carries, .. } = *instance;
    if displacement < 0.0 {
        return (Lod { sampling: BoneSampling::Hidden, ..Lod::FULL }, InstanceLod::UNSEEN);
    }
    let tier = tier(params, instance);
    let units = if carries { 0.0 } else { units(params, displacement, tier) };
    let falling = |start: f32, rate: f32| ((distance - start) * rate).clamp(0.0, 1.0);
    let omega = falling(params.omega_start, params.omega_rate) * OMEGA_ONE as f32;
    let lod = Lod {
        omega: OMEGA_ONE - omega.round_ties_even() as u32,
        allowed: units.floor().min(MAX_UNITS) as u32,
        weight: weight(params, displacement) as u32,
        tier,
        ..Lod::FULL
    };
    let by_distance = FADE_STEPS * falling(params.fade_start, params.fade_rate);
    let instance_lod = InstanceLod {
        influence_fade: fade_steps(params, displacement).max(by_distance).floor() / FADE_STEPS,
        max_influences: params.max_influences,
        mesh_lod: finest,
        tier,
    };
    (lod, instance_lod)
}

/// Skeleton tier of an instance.
pub fn tier(params: &AssignParams, instance: &AssignInstance) -> u32 {
    if instance.carries || instance.is_whole {
        return 0;
    }
    let limit = params.tier_fraction * (params.bone_fraction * instance.allowed.displacement);
    let errors = params.tier_errors.to_array();
    let within = |limit: f32| (1..MAX_TIERS).rfind(|tier| errors[*tier as usize] <= limit).unwrap_or(0);
    instance.last_tier.clamp(within(TIER_HYSTERESIS * limit), within(limit))
}

/// Part of the allowed displacement that bones of a tier may use, in units of the gate's table.
pub fn units(params: &AssignParams, displacement: f32, tier: u32) -> f32 {
    let error = params.tier_errors.to_array()[tier as usize];
    (params.bone_fraction * displacement - error) / params.unit
}

/// Weight of an instance's motion, 0 to [`FULL_WEIGHT`].
pub fn weight(params: &AssignParams, displacement: f32) -> f32 {
    let full = params.full_weight_allowed;
    FULL_WEIGHT as f32 * (full / displacement.max(full)).min(1.0)
}

/// How far influences may fade, in steps: 0 (all influences) to `FADE_STEPS` (one influence).
pub fn fade_steps(params: &AssignParams, displacement: f32) -> f32 {
    if params.stray <= 0.0 {
        return FADE_STEPS;
    }
    FADE_STEPS * (params.influence_fraction * displacement / params.stray).min(1.0)
}
