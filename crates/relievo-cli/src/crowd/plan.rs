//! Converts and checks the arguments of `relievo crowd` before a model is read.

use clap::ValueEnum as _;
use relievo::animation::Range;
use relievo::animation::priority::Weights;
use relievo::asset::Model;
use relievo::{Error, InputError};
use relievo_lab::measure::{CrowdOptions, DrawnOptions, GateMode, LodOptions, ParetoOptions, Subject};

use super::{Crowd, Gate, detail};
use crate::arguments::Backend;
use crate::pose::{find, open, open_bare, place};
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
        let crowd = crowd(a)?;
        let distances = a.distance.as_deref().map(|text| numbers("distance", text)).transpose()?;
        let mut lod = LodOptions {
            distances: distances.unwrap_or_else(|| crowd.sweep()),
            crowd: crowd.clone(),
            gate: gate(a)?,
        };
        lod.validate()?;
        GateMode::Bounded { pixels: a.pixels }.validate()?;
        let weights = Weights::default();
        let mut pareto = ParetoOptions { crowd, period: a.period, weights, tall_pixels: a.tall };
        pareto.validate()?;
        let drawn = drawn(a)?;
        let model = if a.is_drawn() { open(&a.model)? } else { open_bare(&a.model)? };
        let clip = find(&model, &a.model, &a.clip)?;
        pareto.weights = priorities::weights(a.weights.as_deref(), &model.skeleton, clip, true)?;
        if let GateMode::SkipPeriod { weights, .. } = &mut lod.gate {
            *weights = pareto.weights;
        }
        let (name, clip) = (a.model.display().to_string(), place(&model, clip));
        Ok(Self { name, model, clip, backend: a.backend, lod, drawn, pareto })
    }

    /// The model and the clip to measure.
    pub fn subject(&self) -> Subject<'_> {
        Subject { name: &self.name, model: &self.model, clip: self.clip }
    }
}

fn crowd(a: &Crowd) -> Result<CrowdOptions, InputError> {
    let range = numbers("range", &a.range)?;
    let [min, max] = range[..] else {
        return Err(InputError::new("range", &a.range, "must be two distances, such as 200,1700"));
    };
    let range = Range { min, max };
    range.validate()?;
    Ok(CrowdOptions {
        instances: a.instances.unwrap_or(if a.pareto { 25 } else { 100 }),
        layout: a.layout.into(),
        seed: a.seed,
        size: a.size,
        spacing: a.spacing,
        range,
        frames: a.frames,
        rate: a.rate,
    })
}

/// The gate that the arguments name. Weights of `analyze` are derived later, from the model.
fn gate(a: &Crowd) -> Result<GateMode, InputError> {
    if let Some(budget) = a.budget.filter(|_| !matches!(a.gate, Some(Gate::Budget))) {
        return Err(InputError::new("budget", budget, "must come with --gate budget"));
    }
    Ok(match a.gate {
        None | Some(Gate::Off) => GateMode::Off,
        Some(Gate::SkipPeriod) => GateMode::SkipPeriod { period: a.period, weights: Weights::default() },
        Some(Gate::Uniform) => GateMode::Uniform,
        Some(Gate::Random) => GateMode::Random,
        Some(Gate::Bounded) => GateMode::Bounded { pixels: a.pixels },
        Some(Gate::Budget) => {
            let missing =
                || InputError::new("budget", "not given", "must be the most bones to interpolate in a frame");
            GateMode::Budget { bones: a.budget.ok_or_else(missing)? }
        }
    })
}

fn drawn(a: &Crowd) -> Result<DrawnOptions, InputError> {
    match a.gate {
        Some(gate) if a.is_drawn() && !matches!(gate, Gate::Off | Gate::Bounded) => {
            let name = gate.to_possible_value().map_or_else(String::new, |name| name.get_name().to_owned());
            let bound = "must be off or bounded with --image and --scene, which draw a scene; leave them out to measure it";
            return Err(InputError::new("gate", name, bound));
        }
        _ => {}
    }
    if a.is_drawn() && a.backend == Backend::Cpu {
        return Err(InputError::new("backend", "cpu", "must be gpu, as the crowd is drawn"));
    }
    for (field, given) in [("skinning", &a.skinning), ("mesh", &a.mesh)] {
        if !a.is_drawn() && given.is_some() {
            return Err(InputError::new(
                field,
                "given",
                "must come with --image or --scene, which draw the crowd",
            ));
        }
    }
    let usual = if a.scene { "bounded:0.5" } else { "full" };
    Ok(DrawnOptions {
        skinning: detail::skinning(a.skinning.as_deref().unwrap_or(usual))?,
        mesh: detail::mesh(a.mesh.as_deref().unwrap_or(usual))?,
    })
}

fn numbers(field: &str, text: &str) -> Result<Vec<f32>, InputError> {
    let refused = |_| InputError::new(field, text, "must be numbers with commas between them");
    text.split(',').map(|word| word.trim().parse().map_err(refused)).collect()
}
