//! The pixels that each part of level of detail may take, as a scene takes them: their sum, and fractions of it.

use relievo::InputError;
use relievo::scene::{BoneGate, DistanceRange, ErrorBudget, InfluenceLod, Quality, SkeletonTier};

use crate::measure::gates::GateMode;
use crate::measure::options::{Detail, DrawnOptions};

/// Pixels for bones that keep an old pose, for influences that are left out, and for coarser meshes; and the gate.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Parts {
    pub bones: f32,
    pub influences: f32,
    pub mesh: f32,
    pub gate: GateMode,
    pub skinning: Detail,
    /// Reduced skeletons.
    pub tiers: Vec<SkeletonTier>,
}

impl Parts {
    /// Full detail.
    pub const NONE: Self = Self {
        bones: 0.0,
        influences: 0.0,
        mesh: 0.0,
        gate: GateMode::Off,
        skinning: Detail::Full,
        tiers: Vec::new(),
    };

    /// Those of a gate and of how the crowd is drawn.
    pub fn new(gate: &GateMode, drawn: &DrawnOptions) -> Result<Self, InputError> {
        let bones = match gate {
            GateMode::Off | GateMode::Uniform | GateMode::SkipPeriod { .. } | GateMode::Budget { .. } => 0.0,
            GateMode::Bounded { pixels } => *pixels,
            GateMode::Random => {
                let bound = "must be another gate where a crowd is drawn: a scene has no random gate";
                return Err(InputError::new("gate", gate.name().as_str(), bound));
            }
        };
        let [influences, mesh] = [drawn.skinning, drawn.mesh].map(Detail::pixels);
        let DrawnOptions { skinning, ref tiers, .. } = *drawn;
        Ok(Self { bones, influences, mesh, gate: *gate, skinning, tiers: tiers.clone() })
    }

    /// The influences of a scene's character. `range` has the distances in world units over which they fade.
    pub fn influence_lod(&self, range: DistanceRange) -> InfluenceLod {
        match self.skinning {
            Detail::Full | Detail::Bounded { .. } | Detail::Geomorph { .. } => InfluenceLod::Bounded,
            Detail::Truncated { most } => InfluenceLod::Truncated(most),
            Detail::Faded => InfluenceLod::Faded(range),
        }
    }

    /// The gate of a scene's character. `range` has the distances in world units over which Ω falls.
    pub fn bone_gate(&self, range: DistanceRange) -> BoneGate {
        match self.gate {
            GateMode::Off | GateMode::Random => BoneGate::Off,
            GateMode::Bounded { .. } => BoneGate::Bounded,
            GateMode::Uniform => BoneGate::Uniform(range),
            GateMode::SkipPeriod { period, weights } => {
                BoneGate::SkipPeriod { range, period: period as f32, weights: Some(weights) }
            }
            GateMode::Budget { bones } => BoneGate::Budget { bones },
        }
    }

    /// The quality of a view, and the shares of its scene.
    pub fn quality(&self) -> (Quality, ErrorBudget) {
        let Self { bones, influences, mesh, .. } = *self;
        let pixels = bones + influences + mesh;
        let share = |part: f32| if pixels > 0.0 { part / pixels } else { 0.0 };
        let budget = ErrorBudget { mesh: share(mesh), bones: share(bones), influences: share(influences) };
        (Quality::pixels(pixels), budget)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_in_proportion_and_add_up() {
        let (quality, budget) = Parts { bones: 0.5, influences: 0.25, mesh: 0.25, ..Parts::NONE }.quality();
        assert_eq!((quality.pixels, budget.bones, budget.influences, budget.mesh), (1.0, 0.5, 0.25, 0.25));
        let (quality, budget) = Parts { mesh: 3.0, ..Parts::NONE }.quality();
        assert_eq!((quality.pixels, budget.bones, budget.influences, budget.mesh), (3.0, 0.0, 0.0, 1.0));
        let (quality, budget) = Parts::NONE.quality();
        assert_eq!((quality.pixels, budget.bones + budget.influences + budget.mesh), (0.0, 0.0));
        // Whatever is rounded, a scene takes them.
        for part in [1e-30, 1e-3, 1.0 / 3.0, 0.1, 7.7, 1e6] {
            let parts = Parts { bones: part, influences: 1.0 / 3.0, mesh: 0.7, ..Parts::NONE };
            parts.quality().1.validate().expect("in range");
        }
    }

    #[test]
    fn a_scene_has_no_random_gate() {
        let refused = Parts::new(&GateMode::Random, &DrawnOptions::default()).expect_err("refused");
        assert_eq!((refused.path.as_str(), refused.value.as_str()), ("gate", "random"));
        let gate = GateMode::Bounded { pixels: 2.0 };
        let bounded = Parts::new(&gate, &DrawnOptions::default());
        let skinning = Detail::Bounded { pixels: 0.5 };
        assert_eq!(
            bounded,
            Ok(Parts { bones: 2.0, influences: 0.5, mesh: 0.5, gate, skinning, tiers: Vec::new() })
        );
        let uniform = Parts::new(&GateMode::Uniform, &DrawnOptions::default()).expect("a scene has it");
        let range = DistanceRange { min: 1.0, max: 2.0 };
        assert_eq!((uniform.bones, uniform.bone_gate(range)), (0.0, BoneGate::Uniform(range)));
        let faded = Parts { skinning: Detail::Faded, ..Parts::NONE };
        assert_eq!(faded.influence_lod(range), InfluenceLod::Faded(range));
        assert_eq!(Parts::NONE.influence_lod(range), InfluenceLod::Bounded);
    }
}
