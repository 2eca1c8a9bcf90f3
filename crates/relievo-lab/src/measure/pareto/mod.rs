//! Measures error against cost for every gate, on the CPU.

pub use comparison::{AtCost, AtError, Comparisons};
use rayon::prelude::*;
use relievo::Error;
use relievo::ops::animation::Gate;
use relievo::ops::animation::lod::OMEGA_ONE;
use relievo::ops::animation::priority::Weights;
use serde::Serialize;

use crate::measure::cpu::Cpu;
use crate::measure::errors::{Errors, Jump};
use crate::measure::gates::{GateMode, GateName};
use crate::measure::options::{ParetoOptions, Subject};
use crate::measure::placement::Placements;
use crate::measure::play::play;
use crate::measure::progress::{Listener, Steps};
use crate::measure::stage::{Stage, animated_bones};

mod comparison;

/// The gates in the order of the report.
const GATES: [GateName; 5] =
    [GateName::Bounded, GateName::Budget, GateName::Uniform, GateName::Random, GateName::SkipPeriod];

/// The cost and error of a gate at one setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParetoPoint {
    /// The gate.
    pub gate: GateName,
    /// The setting: pixels for bounded; for budget, the share of the animated bones that it may sample; Ω for
    /// the others.
    pub parameter: f64,
    /// The share of the animated bones that were interpolated, over all frames but the first, 0 to 1.
    pub cost: f64,
    /// The share of all bones whose matrices were computed, 0 to 1.
    pub concatenated_fraction: f64,
    /// Errors of the points that lie one bone length from each bone's origin along its axes.
    #[serde(flatten)]
    pub error: Errors,
    /// The largest change of these errors from one frame to the next.
    pub jump: Jump,
}

/// The errors and costs of every gate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParetoReport {
    /// The model's name.
    pub model: String,
    /// The clip's name.
    pub clip: String,
    /// Number of instances.
    pub instances: usize,
    /// Number of bones of an instance.
    pub bones: usize,
    /// Number of bones of an instance that the clip moves.
    pub animated_bones: usize,
    /// Number of frames that were measured.
    pub frames: u32,
    /// Frames per second.
    pub rate: f64,
    /// Period of [`GateMode::SkipPeriod`], in seconds.
    pub period: f64,
    /// Weights of the priorities of [`GateMode::SkipPeriod`].
    pub weights: Weights,
    /// Size on screen of the model's largest extent, in pixels.
    pub tall_pixels: f32,
    /// The measurements, gate by gate.
    pub points: Vec<ParetoPoint>,
    /// How the gates compare.
    pub comparisons: Comparisons,
}

/// Plays instances at one place, each turned by another angle, under every gate at many settings, and beside
/// them the same instances in full. Everything runs on the CPU, by the references; the camera does not move.
///
/// # Errors
/// [`InputError`](relievo::InputError) for options out of their ranges, a clip that the model lacks, and a
/// model whose bones all lie in one point at rest.
pub fn pareto(
    subject: Subject<'_>,
    options: &ParetoOptions,
    listener: Listener<'_>,
) -> Result<ParetoReport, Error> {
    options.validate()?;
    let stage = Stage::new(subject, &options.crowd, false)?;
    let off = stage.gate(&GateMode::Off)?;
    let animated_bones = animated_bones(&off);
    let points = points(&stage, options, &off, listener)?;
    let ParetoOptions { crowd, period, weights, tall_pixels } = options;
    Ok(ParetoReport {
        model: subject.name.to_owned(),
        clip: stage.clip.name().to_owned(),
        instances: crowd.instances,
        bones: stage.set.bones(),
        animated_bones,
        frames: crowd.frames,
        rate: crowd.rate,
        period: *period,
        weights: *weights,
        tall_pixels: *tall_pixels,
        comparisons: Comparisons::new(&points),
        points,
    })
}

/// The settings at which a gate is measured.
fn parameters(gate: GateName) -> Vec<f64> {
    let twentieths = || (1..20).map(|twentieth| f64::from(twentieth) / 20.0);
    match gate {
        GateName::Off => vec![1.0],
        GateName::Random | GateName::Budget => twentieths().collect(),
        // Between two whole periods the largest error is that of the longer period.
        GateName::Uniform => {
            let mut all: Vec<f64> =
                (2..=16).map(|frames| 1.0 / f64::from(frames)).chain([0.6, 0.75, 0.9]).collect();
            all.sort_by(f64::total_cmp);
            all
        }
        GateName::SkipPeriod => {
            (1..=14).rev().map(|half| 0.5_f64.powf(f64::from(half) / 2.0 - 0.4)).collect()
        }
        GateName::Bounded => (-40..=32).map(|quarter| 2.0_f64.powf(f64::from(quarter) / 4.0)).collect(),
    }
}

/// The gate at a setting, for a crowd with `moving` animated bones.
fn mode(gate: GateName, parameter: f64, moving: usize, options: &ParetoOptions) -> GateMode {
    match gate {
        GateName::Off => GateMode::Off,
        GateName::SkipPeriod => GateMode::SkipPeriod { period: options.period, weights: options.weights },
        GateName::Uniform => GateMode::Uniform,
        GateName::Random => GateMode::Random,
        GateName::Budget => GateMode::Budget { bones: (parameter * moving as f64).round() as u32 },
        GateName::Bounded => GateMode::Bounded { pixels: parameter as f32 },
    }
}

fn points(
    stage: &Stage<'_>,
    options: &ParetoOptions,
    off: &Gate,
    listener: Listener<'_>,
) -> Result<Vec<ParetoPoint>, Error> {
    let placements = stage.line_up(options.tall_pixels);
    let moving = stage.instances.len() * animated_bones(off);
    let mut settings = Vec::new();
    for gate in GATES {
        let mode = |parameter| mode(gate, parameter, moving, options);
        // The gate's table is the same at every setting.
        let made = stage.gate(&mode(1.0))?;
        let setting = |parameter| (mode(parameter), parameter, with_budget(made.clone(), &mode(parameter)));
        settings.extend(parameters(gate).into_iter().map(setting));
    }
    let steps = Steps::new(listener, "comparing", settings.len() as u64);
    let points = settings.par_iter().map(|(mode, parameter, gate)| {
        let point = point(stage, &placements, mode, *parameter, [gate, off]);
        steps.step();
        point
    });
    points.collect()
}

/// Sets the gate's budget to that of the mode, if it has one.
fn with_budget(gate: Gate, mode: &GateMode) -> Gate {
    match (gate, mode) {
        (Gate::Budget { table, .. }, GateMode::Budget { bones }) => Gate::Budget { table, bones: *bones },
        (gate, _) => gate,
    }
}

fn point(
    stage: &Stage<'_>,
    placements: &Placements,
    mode: &GateMode,
    parameter: f64,
    [gate, off]: [&Gate; 2],
) -> Result<ParetoPoint, Error> {
    let mut lods = stage.lods(placements, gate, mode.pixels());
    if matches!(mode, GateMode::Uniform | GateMode::Random | GateMode::SkipPeriod { .. }) {
        // Rounded up, so that Ω = 1/n samples exactly every n-th frame.
        let omega = (parameter * f64::from(OMEGA_ONE)).ceil() as u32;
        lods.iter_mut().for_each(|lod| lod.omega = omega);
    }
    let mut crowds = Cpu::new(stage, gate, off, lods)?;
    let found = play(&mut crowds, stage, placements, false, || {})?;
    let frames = f64::from(stage.options.frames);
    let moving = stage.instances.len() * animated_bones(off);
    Ok(ParetoPoint {
        gate: mode.name(),
        parameter,
        cost: found.interpolated as f64 / (moving.max(1) as f64 * frames),
        concatenated_fraction: found.concatenated as f64 / (stage.pairs() as f64 * frames),
        error: found.errors,
        jump: found.jump,
    })
}
