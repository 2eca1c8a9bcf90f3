//! `--pareto`: error against cost for every gate.

use std::fmt::Write as _;
use std::path::Path;

use rayon::prelude::*;
use relievo::Error;
use relievo::animation::{Gate, lod::OMEGA_ONE};
use relievo::files::Staged;
use serde::Serialize;

use super::errors::{Errors, Jump};
use super::gates::Mode;
use super::plan::Plan;
use super::play::run as play;
use super::reference::References;
use super::report::{self, picture};
use super::stage::{Scene, Stage, moving_bones};
use super::verdict::{Verdicts, table as verdict_table};
use crate::output::say;
use crate::plot::{Chart, Series};
use crate::progress::bar;

/// Gates in the order of reports.
pub const MODES: [Mode; 5] = [Mode::Bounded, Mode::Budget, Mode::Uniform, Mode::Random, Mode::SkipPeriod];

/// Files of this command with `--pareto`.
pub const FILES: [&str; 3] = ["pareto.json", "pareto_max.png", "pareto_rms.png"];

/// Costs and errors in pixels below which plots show nothing: nobody would see it either.
const LEAST: [f64; 2] = [0.01, 1e-3];

/// A gate at one setting.
#[derive(Debug, Clone, Serialize)]
pub struct Point {
    pub gate: Mode,
    /// Pixels of bounded, the share of moving bones of budget, Ω of the others.
    pub parameter: f64,
    /// Bones interpolated, of all that move.
    pub cost: f64,
    /// Bones whose matrices were computed, of all.
    pub concatenated_fraction: f64,
    #[serde(flatten)]
    pub error: Errors,
    pub jump: Jump,
}

#[derive(Serialize)]
struct Report<'a> {
    model: &'a str,
    clip: &'a str,
    instances: usize,
    bones: usize,
    moving_bones: usize,
    frames: u32,
    rate: f64,
    period: f64,
    weights: [f64; 6],
    tall_pixels: f32,
    points: &'a [Point],
    verdicts: &'a Verdicts,
}

pub fn run(plan: &Plan, out: &Path) -> Result<(), Error> {
    let mut staged = Staged::new(out)?;
    let stage = Stage::new(plan)?;
    let points = points(&stage)?;
    let verdicts = Verdicts::new(&points);
    let report = Report {
        model: &plan.name,
        clip: plan.clip.name(),
        instances: plan.instances,
        bones: stage.set.bones(),
        moving_bones: moving_bones(&stage.gate(Mode::Off, 0)?),
        frames: plan.frames,
        rate: plan.rate,
        period: plan.period,
        weights: plan.weights.0,
        tall_pixels: plan.tall,
        points: &points,
        verdicts: &verdicts,
    };
    let [pareto, largest, rms] = FILES;
    staged.write_json(pareto, &report)?;
    staged.write_png(largest, &picture(chart(plan, &points, "Largest", |error| error.max_pixels))?)?;
    staged.write_png(rms, &picture(chart(plan, &points, "Rms", |error| error.rms_pixels))?)?;
    staged.remove_stale(report::is_ours);
    staged.publish()?;
    say(format_args!("{}\n{}", table(&points), verdict_table(&verdicts).trim_end()))
}

/// The plot of the largest errors alone, for the demonstration.
#[cfg(feature = "gpu")]
pub fn largest_errors(plan: &Plan) -> Result<image::RgbaImage, Error> {
    let points = points(&Stage::new(plan)?)?;
    Ok(picture(chart(plan, &points, "Largest", |error| error.max_pixels))?)
}

/// What every gate tries.
fn parameters(mode: Mode) -> Vec<f64> {
    let shares = || (1..20).map(|twentieth| f64::from(twentieth) / 20.0);
    match mode {
        Mode::Off => vec![1.0],
        Mode::Random | Mode::Budget => shares().collect(),
        // Between whole periods it is as far off as the longer one.
        Mode::Uniform => {
            let mut all: Vec<f64> =
                (2..=16).map(|frames| 1.0 / f64::from(frames)).chain([0.6, 0.75, 0.9]).collect();
            all.sort_by(f64::total_cmp);
            all
        }
        Mode::SkipPeriod => (1..=14).rev().map(|half| 0.5_f64.powf(f64::from(half) / 2.0 - 0.4)).collect(),
        Mode::Bounded => (-40..=32).map(|quarter| 2.0_f64.powf(f64::from(quarter) / 4.0)).collect(),
    }
}

fn points(stage: &Stage<'_>) -> Result<Vec<Point>, Error> {
    let off = stage.gate(Mode::Off, 0)?;
    let scene = stage.line_up();
    let moving = stage.instances.len() * moving_bones(&off);
    let mut settings = Vec::new();
    for mode in MODES {
        let gate = stage.gate(mode, 0)?;
        settings.extend(parameters(mode).into_iter().map(|parameter| {
            let bones = (parameter * moving as f64).round() as u32;
            (mode, parameter, with_budget(gate.clone(), bones))
        }));
    }
    let progress = bar(settings.len() as u64, "comparing");
    let points = settings.par_iter().map(|(mode, parameter, gate)| {
        let point = point(stage, &scene, *mode, *parameter, gate, &off);
        progress.inc(1);
        point
    });
    let points = points.collect();
    progress.finish_and_clear();
    points
}

/// The same gate; of a budget, one of so many bones.
fn with_budget(gate: Gate, bones: u32) -> Gate {
    match gate {
        Gate::Budget { table, .. } => Gate::Budget { table, bones },
        other => other,
    }
}

fn point(
    stage: &Stage<'_>,
    scene: &Scene,
    mode: Mode,
    parameter: f64,
    gate: &Gate,
    off: &Gate,
) -> Result<Point, Error> {
    let plan = stage.plan;
    let moving = stage.instances.len() * moving_bones(off);
    let pixels = if mode == Mode::Bounded { parameter as f32 } else { 0.0 };
    let mut lods = stage.lods(scene, gate, pixels);
    if matches!(mode, Mode::Uniform | Mode::Random | Mode::SkipPeriod) {
        // Up, so that each whole number of frames is one.
        let omega = (parameter * f64::from(OMEGA_ONE)).ceil() as u32;
        lods.iter_mut().for_each(|lod| lod.omega = omega);
    }
    let found = play(&mut References::new(stage, gate, off, lods)?, stage, scene, false, || {})?;
    let frames = f64::from(plan.frames);
    Ok(Point {
        gate: mode,
        parameter,
        cost: found.interpolated as f64 / (moving.max(1) as f64 * frames),
        concatenated_fraction: found.concatenated as f64 / (stage.pairs() as f64 * frames),
        error: found.errors,
        jump: found.jump,
    })
}

fn chart(plan: &Plan, points: &[Point], what: &str, error: impl Fn(&Errors) -> f64) -> Chart {
    let series = |mode: Mode| {
        let mut points: Vec<(f64, f64)> = (points.iter())
            .filter(|point| point.gate == mode)
            .map(|point| (point.cost, error(&point.error)))
            .filter(|(cost, error)| *cost >= LEAST[0] && *error >= LEAST[1])
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Series { name: mode.name().to_owned(), points, labels: Vec::new() }
    };
    Chart {
        title: format!("{what} error, {} × {:?} at {} pixels", plan.instances, plan.clip.name(), plan.tall),
        x_label: "interpolations, of moving bones".to_owned(),
        y_label: "pixels".to_owned(),
        log_x: true,
        log_y: true,
        series: MODES.map(series).to_vec(),
    }
}

fn table(points: &[Point]) -> String {
    let mut text = "| gate | parameter | cost | rms px | p99 px | max px | jump px | concatenated |\n\
                    |---|---:|---:|---:|---:|---:|---:|---:|\n"
        .to_owned();
    for Point { gate, parameter, cost, concatenated_fraction, error, jump } in points {
        writeln!(
            text,
            "| {} | {parameter:.3} | {cost:.3} | {:.4} | {:.4} | {:.4} | {:.4} | {concatenated_fraction:.3} |",
            gate.name(),
            error.rms_pixels,
            error.p99_pixels,
            error.max_pixels,
            jump.max_pixels,
        )
        .expect("a string");
    }
    text
}
