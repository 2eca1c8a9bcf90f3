//! What the controls of the panel say, and what that means for a scene.

use relievo::scene::{Criterion, DistanceTo, LevelChoice, LevelOfDetail, Quality, SizeOf, Transition};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// What decides the levels of detail of all objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LevelsBy {
    /// What the scene file says.
    #[default]
    Scene,
    /// The error in pixels.
    Error,
    /// The distance from the eye.
    Distance,
    /// The size on the screen.
    Size,
    /// Pixels per world unit.
    Magnification,
    /// A target number of triangles.
    Ratio,
    /// One level for everything.
    Forced,
}

impl LevelsBy {
    pub(crate) const ALL: [(Self, &str); 7] = [
        (Self::Scene, "as the scene says"),
        (Self::Error, "error in pixels"),
        (Self::Distance, "distance"),
        (Self::Size, "size on the screen"),
        (Self::Magnification, "magnification"),
        (Self::Ratio, "ratio of triangles"),
        (Self::Forced, "one level"),
    ];
}

/// The controls of levels of detail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    pub by: LevelsBy,
    /// Distances in world units where level 1 and the coarsest level begin.
    pub distances: [f32; 2],
    /// The same as fractions of the picture.
    pub sizes: [f32; 2],
    /// The same as pixels per world unit.
    pub magnifications: [f32; 2],
    pub level: u32,
    pub hysteresis: f32,
    pub bias: f32,
    /// Number of the transition in [`Transition::NAMES`]; `None` for the scene's own.
    pub transition: Option<usize>,
}

impl Levels {
    /// The controls of a scene of this extent, in world units.
    pub fn of(extent: f64) -> Self {
        let extent = extent as f32;
        Self {
            by: LevelsBy::Scene,
            distances: [0.5 * extent, 8.0 * extent],
            sizes: [0.2, 0.001],
            magnifications: [400.0 / extent, 4.0 / extent],
            level: 0,
            hysteresis: 0.1,
            bias: 1.0,
            transition: None,
        }
    }

    /// Whether nothing differs from the scene.
    pub fn is_own(&self) -> bool {
        let Self { by, hysteresis, bias, transition, .. } = *self;
        by == LevelsBy::Scene && hysteresis == 0.1 && bias == 1.0 && transition.is_none()
    }

    /// The settings of an object with so many levels, whose settings in the scene are `own`.
    pub fn of_object(&self, own: &LevelOfDetail, levels: usize) -> LevelOfDetail {
        let steps = |[first, last]: [f32; 2]| {
            let count = levels.saturating_sub(1).max(1);
            let ratio = last / first;
            (0..count)
                .map(|at| first * ratio.powf(at as f32 / count.saturating_sub(1).max(1) as f32))
                .collect()
        };
        let by = |criterion| LevelChoice::By(criterion);
        let choice = match self.by {
            LevelsBy::Scene => own.choice.clone(),
            // Of a single level there is nothing to choose.
            _ if levels < 2 => by(Criterion::Error),
            LevelsBy::Error => by(Criterion::Error),
            LevelsBy::Distance => {
                by(Criterion::Distance { to: DistanceTo::Center, from: steps(self.distances) })
            }
            LevelsBy::Size => by(Criterion::Size { of: SizeOf::Sphere, below: steps(self.sizes) }),
            LevelsBy::Magnification => by(Criterion::Magnification { below: steps(self.magnifications) }),
            LevelsBy::Ratio => {
                let [near, far] = self.distances;
                by(Criterion::Ratio { to: DistanceTo::Center, near, far })
            }
            LevelsBy::Forced => LevelChoice::Forced(self.level.min(levels as u32 - 1)),
        };
        let transition = self.transition.map_or(own.transition, |at| Transition::NAMES[at].1);
        LevelOfDetail { choice, transition, hysteresis: self.hysteresis, bias: self.bias, ..own.clone() }
    }

    /// The field `lod` of an object of a scene file.
    pub fn json(&self, of: &LevelOfDetail) -> Value {
        let mut lod = match &of.choice {
            LevelChoice::By(Criterion::Distance { from, .. }) => {
                json!({ "criterion": "distance", "from": from })
            }
            LevelChoice::By(Criterion::Size { below, .. }) => json!({ "criterion": "size", "below": below }),
            LevelChoice::By(Criterion::Magnification { below }) => {
                json!({ "criterion": "magnification", "below": below })
            }
            LevelChoice::By(Criterion::Ratio { near, far, .. }) => {
                json!({ "criterion": "ratio", "near": near, "far": far })
            }
            LevelChoice::Forced(level) => json!({ "level": level }),
            LevelChoice::By(_) => json!({ "criterion": "error" }),
        };
        if let Some(lod) = lod.as_object_mut() {
            lod.insert("hysteresis".to_owned(), json!(of.hysteresis));
            lod.insert("bias".to_owned(), json!(of.bias));
        }
        lod
    }
}

/// The gate: what chooses the bones that are sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GateBy {
    /// What the scene file says.
    #[default]
    Scene,
    /// Keeps the error that the view allows.
    Bounded,
    /// Samples all bones.
    Off,
    /// Samples all bones of an instance, less often with its distance.
    Uniform,
    /// Skips updates of single bones by priority and distance.
    SkipPeriod,
    /// Samples a number of bones in a frame.
    Budget,
}

impl GateBy {
    pub(crate) const ALL: [(Self, &str); 6] = [
        (Self::Scene, "as the scene says"),
        (Self::Bounded, "bounded"),
        (Self::Off, "off"),
        (Self::Uniform, "uniform"),
        (Self::SkipPeriod, "skip-period"),
        (Self::Budget, "budget"),
    ];
}

/// The controls of bones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bones {
    pub gate: GateBy,
    /// Distances in world units between which updates become rarer.
    pub range: [f32; 2],
    /// Seconds between skipped updates.
    pub period: f32,
    /// Weights of the terms of a bone's priority, which need not add up to 1.
    pub weights: [f64; 6],
    /// Whether the weights come from each clip.
    pub analyzed: bool,
    /// Number of bones in a frame.
    pub bones: u32,
}

impl Bones {
    /// The controls of a scene of this extent, in world units.
    pub fn of(extent: f64) -> Self {
        let extent = extent as f32;
        Self {
            gate: GateBy::Scene,
            range: [0.5 * extent, 8.0 * extent],
            period: 1.0,
            weights: [1.0; 6],
            analyzed: false,
            bones: 1000,
        }
    }

    /// The field `gate` of a character in a scene file; `None` for the scene's own.
    pub fn json(&self) -> Option<Value> {
        let Self { range, period, weights, analyzed, bones, .. } = *self;
        Some(match self.gate {
            GateBy::Scene => return None,
            GateBy::Bounded => json!("bounded"),
            GateBy::Off => json!("off"),
            GateBy::Uniform => json!({ "mode": "uniform", "range": range }),
            GateBy::SkipPeriod => {
                let sum: f64 = weights.iter().sum();
                let shares = weights.map(|weight| if sum > 0.0 { weight / sum } else { 1.0 / 6.0 });
                let weights = if analyzed { json!("analyze") } else { json!(shares) };
                json!({ "mode": "skip-period", "range": range, "period": period, "weights": weights })
            }
            GateBy::Budget => json!({ "mode": "budget", "bones": bones }),
        })
    }
}

/// The controls of quality. Limits keep their value while they are off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QualityControls {
    pub pixels: f32,
    pub has_triangles: bool,
    pub triangles: u32,
    pub has_milliseconds: bool,
    pub milliseconds: f32,
}

impl QualityControls {
    /// The controls of a quality.
    pub fn of(quality: Quality) -> Self {
        Self {
            pixels: quality.pixels,
            has_triangles: quality.triangles.is_some(),
            triangles: quality.triangles.unwrap_or(100_000),
            has_milliseconds: quality.milliseconds.is_some(),
            milliseconds: quality.milliseconds.unwrap_or(16.0),
        }
    }

    /// The quality.
    pub fn quality(&self) -> Quality {
        Quality {
            pixels: self.pixels,
            triangles: self.has_triangles.then_some(self.triangles),
            milliseconds: self.has_milliseconds.then_some(self.milliseconds),
        }
    }
}

/// What a drag over the picture moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Drag {
    /// The camera goes around its focus.
    #[default]
    Orbit,
    /// The camera looks around.
    Fly,
    /// The sun.
    Sun,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_are_spread_from_the_first_to_the_last() {
        let levels = Levels { by: LevelsBy::Distance, distances: [10.0, 1000.0], ..Levels::of(10.0) };
        let of = levels.of_object(&LevelOfDetail::default(), 4);
        let LevelChoice::By(Criterion::Distance { from, .. }) = &of.choice else { panic!("{of:?}") };
        assert_eq!(from.iter().map(|from| from.round()).collect::<Vec<_>>(), [10.0, 100.0, 1000.0]);
        for (by, _) in LevelsBy::ALL {
            for count in [1, 2, 8] {
                let levels = Levels { by, level: 9, ..Levels::of(3.0) };
                levels.of_object(&LevelOfDetail::default(), count).validate(count).expect("valid");
            }
        }
    }

    #[test]
    fn gates_and_levels_are_fields_of_a_scene_file() {
        for (gate, _) in GateBy::ALL {
            for (by, _) in LevelsBy::ALL {
                let lod = Levels { by, ..Levels::of(3.0) };
                let lod = lod.json(&lod.of_object(&LevelOfDetail::default(), 5));
                let gate = Bones { gate, weights: [0.0, 1.0, 1.0, 0.0, 0.0, 0.0], ..Bones::of(3.0) }.json();
                let gate = gate.unwrap_or(json!("bounded"));
                let text = json!({
                    "characters": [{ "file": "builtin:creature", "instances": [{ "at": [0, 0, 0] }], "gate": gate, "lod": lod }],
                    "camera": { "at": [0, 1, 4], "look": [0, 0, 0] },
                });
                relievo_scene_file::SceneFile::from_json(&text.to_string()).expect("a scene");
            }
        }
    }
}
