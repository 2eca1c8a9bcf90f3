//! Converts and checks the arguments of `relievo crowd` before a model is read.

use relievo::asset::Model;
use relievo::ops::animation::priority::Weights;
use relievo::ops::animation::{Range, Wrap};
use relievo::scene::SkeletonTier;
use relievo::{Error, InputError};
use relievo_lab::measure::{
    CrowdOptions, Detail, DrawnOptions, GateMode, GateName, LodOptions, ParetoOptions, Subject,
};

use super::Crowd;
use crate::arguments::Backend;
use crate::priorities;

/// The checked arguments.
pub struct Plan {
    name: String,
    model: Model,
    clip: usize,
    pub backend: Backend,
    pub lod: LodOptions,
    pub drawn: DrawnOptions,
    pub pareto: ParetoOptions,
}

impl Plan {
    pub fn new(a: &Crowd) -> Result<Self, Error> {
        let [min, max] = a.range;
        let range = Range { min, max };
        range.validate()?;
        let crowd = CrowdOptions {
            instances: a.instances.unwrap_or(if a.pareto { 25 } else { 100 }),
            layout: a.layout,
            seed: a.seed,
            size: a.size,
            spacing: a.spacing,
            range,
            frames: a.frames,
            rate: a.rate,
            priorities: a.priority.iter().cloned().collect(),
        };
        let distances = if a.distance.is_empty() { crowd.sweep() } else { a.distance.clone() };
        let mut lod = LodOptions { distances, crowd: crowd.clone(), gate: gate(a)? };
        lod.validate()?;
        GateMode::Bounded { pixels: a.pixels }.validate()?;
        let weights = Weights::default();
        let mut pareto = ParetoOptions { crowd, period: a.period, weights, tall_pixels: a.tall };
        pareto.validate()?;
        let drawn = drawn(a)?;
        let model = if a.is_drawn() { a.model.open()? } else { a.model.open_bare()? };
        let clip = a.model.clip(&model, &a.clip)?;
        pareto.weights =
            priorities::weights(a.weights.as_deref(), &model.skeleton, &model.clips[clip], Wrap::Loop)?;
        if let GateMode::SkipPeriod { weights, .. } = &mut lod.gate {
            *weights = pareto.weights;
        }
        Ok(Self { name: a.model.name(), model, clip, backend: a.backend, lod, drawn, pareto })
    }

    /// The model and the clip to measure.
    pub fn subject(&self) -> Subject<'_> {
        Subject { name: &self.name, model: &self.model, clip: self.clip }
    }
}

/// The gate that the arguments name. Weights of `analyze` are derived later, from the model.
fn gate(a: &Crowd) -> Result<GateMode, InputError> {
    let gate = a.gate.unwrap_or(GateName::Off);
    if let Some(budget) = a.budget.filter(|_| gate != GateName::Budget) {
        return Err(InputError::new("budget", budget, "must come with --gate budget"));
    }
    Ok(match gate {
        GateName::Off => GateMode::Off,
        GateName::SkipPeriod => GateMode::SkipPeriod { period: a.period, weights: Weights::default() },
        GateName::Uniform => GateMode::Uniform,
        GateName::Random => GateMode::Random,
        GateName::Bounded => GateMode::Bounded { pixels: a.pixels },
        GateName::Budget => {
            let bound = "must be the most bones to interpolate in a frame";
            let missing = || InputError::new("budget", "not given", bound);
            GateMode::Budget { bones: a.budget.ok_or_else(missing)? }
        }
    })
}

fn drawn(a: &Crowd) -> Result<DrawnOptions, InputError> {
    if a.is_drawn() {
        if let Some(gate) = a.gate.filter(|gate| *gate == GateName::Random) {
            let bound = "must be another gate with --image and --scene, which draw a scene; leave them out to measure it";
            return Err(InputError::new("gate", gate.as_str(), bound));
        }
        if a.backend == Backend::Cpu {
            return Err(InputError::new("backend", "cpu", "must be gpu, as the crowd is drawn"));
        }
    } else {
        let (skinning, mesh, tiers) = (a.skinning.is_some(), a.mesh.is_some(), !a.tiers.is_empty());
        let given =
            [("skinning", skinning), ("mesh", mesh), ("tiers", tiers)].into_iter().find(|(_, given)| *given);
        if let Some((field, _)) = given {
            let bound = "must come with --image or --scene, which draw the crowd";
            return Err(InputError::new(field, "given", bound));
        }
    }
    SkeletonTier::check_all(&a.tiers)?;
    let usual = if a.scene { "bounded:0.5" } else { "full" };
    let [skinning, mesh] = [("skinning", &a.skinning), ("mesh", &a.mesh)]
        .map(|(field, given)| detail(field, given.as_deref().unwrap_or(usual)));
    Ok(DrawnOptions { skinning: skinning?, mesh: mesh?, tiers: a.tiers.clone() })
}

/// Parses one `--priority`.
pub fn priority(text: &str) -> Result<(String, f32), InputError> {
    let (bone, number) = text.rsplit_once('=').unwrap_or((text, ""));
    let within = number.trim().parse().ok().filter(|priority| (0.0..=1.0).contains(priority));
    let refused =
        || InputError::new("priority", text, "must be a bone and a number from 0 to 1, such as hand_left=1");
    Ok((bone.trim().to_owned(), within.ok_or_else(refused)?))
}

/// Parses one of the list `--tiers`.
pub fn tier(text: &str) -> Result<SkeletonTier, InputError> {
    let (is_rigid, number) = match text.trim().strip_prefix("rigid:") {
        Some(number) => (true, number),
        None => (false, text),
    };
    let within = number.trim().parse().ok().filter(|bones| *bones > 0.0 && *bones < 1.0);
    let refused =
        || InputError::new("tiers", text, "must be fractions between 0 and 1, such as 0.5,0.25,rigid:0.1");
    Ok(SkeletonTier { bones: within.ok_or_else(refused)?, is_rigid })
}

/// Parses `--skinning` or `--mesh`.
fn detail(field: &str, text: &str) -> Result<Detail, InputError> {
    let refused = |bound: &str| InputError::new(field, text, bound);
    let pixels = |number: &str| {
        let within = number.parse().ok().filter(|pixels| (0.0..=1e6).contains(pixels));
        within.ok_or_else(|| refused("must have 0 to 1e6 pixels after the colon"))
    };
    let is_mesh = field == "mesh";
    let most = |number: &str| {
        let within = number.parse().ok().filter(|most| (1..=8).contains(most));
        within.ok_or_else(|| refused("must have 1 to 8 influences after the colon"))
    };
    match text.split_once(':') {
        None if text == "full" => Ok(Detail::Full),
        None if text == "fade" && !is_mesh => Ok(Detail::Faded),
        Some(("truncate", number)) if !is_mesh => Ok(Detail::Truncated { most: most(number)? }),
        Some(("bounded", number)) => Ok(Detail::Bounded { pixels: pixels(number)? }),
        Some(("geomorph", number)) if is_mesh => Ok(Detail::Geomorph { pixels: pixels(number)? }),
        _ if is_mesh => Err(refused("must be full, bounded:PIXELS or geomorph:PIXELS")),
        _ => Err(refused("must be full, bounded:PIXELS, truncate:K or fade")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        let [skinning, mesh] = ["skinning", "mesh"].map(|field| move |text: &str| detail(field, text));
        for name in ["full", "bounded:0.25"] {
            assert_eq!(skinning(name).expect("valid").to_string(), name);
            assert_eq!(mesh(name).expect("valid").to_string(), name);
        }
        assert_eq!(mesh("geomorph:2").expect("valid").to_string(), "geomorph:2");
        for name in ["geomorph", "geomorph:", "geomorph:-1", "geomorph:1e7"] {
            assert_eq!(mesh(name).expect_err("refused").path, "mesh", "{name}");
            assert!(skinning(name).is_err(), "{name}");
        }
        for name in ["fade", "truncate:2"] {
            assert_eq!(skinning(name).expect("valid").to_string(), name);
            assert!(mesh(name).is_err(), "{name}");
        }
        for name in ["truncate:x", "truncate:0", "truncate:9", "fade:1"] {
            assert!(skinning(name).is_err(), "{name}");
        }
        for name in ["", "bounded", "bounded:-1", "bounded:NaN", "bounded:x", "half", "full:1"] {
            assert_eq!(skinning(name).expect_err("refused").path, "skinning", "{name}");
            assert_eq!(mesh(name).expect_err("refused").path, "mesh", "{name}");
        }
    }
}
