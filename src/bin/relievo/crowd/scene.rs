//! The whole frame against distance: without level of detail, with it in animation, in skinning, and in both.

use std::fmt::Write as _;
use std::path::Path;

use relievo::Error;
use relievo::gpu::Gpu;
use relievo::terrain::export::write_bytes;
use serde::Serialize;

use super::drawn::{By, Drawing, fade};
use super::play::gate_of;
use super::report::{GateReport, clock, file_name, picture};
use super::skinning::FULL;
use super::stage::{Stage, mean_omega};
use super::vertices::Figures;
use super::{Layout, SCENE_FILES, plan::Plan};
use crate::Context;
use crate::output::{Staged, json, say};
use crate::plot::{Chart, Series};
use crate::progress::bar;
use crate::terrain::save;

/// What is compared, as reports and plots call it.
const NAMES: [&str; 4] = ["off", "animation", "skinning", "both"];

#[derive(Serialize)]
struct Report<'a> {
    adapter: &'a str,
    driver: &'a str,
    timed_by: &'static str,
    model: &'a str,
    clip: &'a str,
    gate: GateReport,
    skinning: String,
    /// In units, mesh by mesh.
    fade: Vec<Option<[f32; 2]>>,
    stray_metres: Vec<f32>,
    instances: usize,
    layout: Layout,
    seed: u32,
    bones: usize,
    vertices: usize,
    size: f32,
    metres_a_unit: f32,
    spacing: f32,
    range: [f32; 2],
    frames: u32,
    rate: f64,
    focal_pixels: f32,
    distances: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    distance: f32,
    /// Of the nearest instance.
    tall_pixels: f32,
    mean_omega: f64,
    off: Figures,
    animation: Figures,
    skinning: Figures,
    both: Figures,
    cheaper: Cheaper,
}

/// Times of `off` divided by those of `both`.
#[derive(Serialize)]
struct Cheaper {
    frame: f64,
    compute: f64,
}

impl Row {
    fn all(&self) -> [&Figures; 4] {
        [&self.off, &self.animation, &self.skinning, &self.both]
    }
}

/// Plays the scene, and writes what it found.
pub fn run(plan: &Plan, context: &Context, out: &Path) -> Result<(), Error> {
    let gpu = context.gpu()?;
    let mut staged = Staged::new(out)?;
    let stage = Stage::new(plan)?;
    let (mode, budget) = gate_of(plan);
    let table = stage.table(mode)?;
    let ways = [(By::All, FULL), (By::Gate, FULL), (By::All, plan.skinning), (By::Gate, plan.skinning)];
    let progress = bar(plan.distances.len() as u64 * u64::from(plan.frames + 1), "scene");
    let mut rows = Vec::with_capacity(plan.distances.len());
    for distance in &plan.distances {
        let scene = stage.scene(*distance);
        let lods = stage.lods(&scene, &table, plan.pixels);
        let chosen = (&table, mode.choice(plan.period, budget), &lods[..]);
        let mut drawing = Drawing::new(&gpu, &stage, &scene, chosen, &ways)?;
        let figures = drawing.run(|| progress.inc(1))?;
        save(&staged.path(file_name(*distance)), &drawing.picture(3)?)?;
        rows.push(row(&stage, *distance, mean_omega(&lods), &figures));
    }
    progress.finish_and_clear();
    let report = report(&stage, &gpu, rows)?;
    let [figures, chart] = SCENE_FILES;
    write_bytes(&staged.path(figures), &json(&report)?)?;
    save(&staged.path(chart), &picture(curves(&report))?)?;
    staged.remove_stale(super::report::is_ours);
    staged.publish()?;
    say(lines(&report).trim_end())
}

fn report<'a>(stage: &Stage<'a>, gpu: &'a Gpu, distances: Vec<Row>) -> Result<Report<'a>, Error> {
    let plan = stage.plan;
    Ok(Report {
        adapter: &gpu.adapter().name,
        driver: &gpu.adapter().driver,
        timed_by: clock(Drawing::timed_by(gpu)?),
        model: &plan.name,
        clip: plan.clip.name(),
        gate: GateReport::new(plan),
        skinning: plan.skinning.to_string(),
        fade: (0..stage.extents.len())
            .map(|mesh| {
                fade(stage, plan.skinning, mesh).map(|ends| ends.map(|end| end / stage.metres_a_unit))
            })
            .collect(),
        stray_metres: stage.extents.iter().map(|extent| extent.stray).collect(),
        instances: plan.instances,
        layout: plan.layout,
        seed: plan.seed,
        bones: stage.set.bones(),
        vertices: plan.model.meshes.iter().map(|mesh| mesh.positions.len()).sum(),
        size: plan.size,
        metres_a_unit: stage.metres_a_unit,
        spacing: plan.spacing,
        range: [plan.range.min, plan.range.max],
        frames: plan.frames,
        rate: plan.rate,
        focal_pixels: stage.lens.focal_pixels,
        distances,
    })
}

fn row(stage: &Stage<'_>, distance: f32, mean_omega: f64, figures: &[Figures]) -> Row {
    let [off, animation, skinning, both] = std::array::from_fn(|look| figures[look]);
    Row {
        distance,
        tall_pixels: stage.plan.size * stage.lens.focal_pixels / distance,
        mean_omega,
        off,
        animation,
        skinning,
        both,
        cheaper: Cheaper {
            frame: off.frame_nanoseconds / both.frame_nanoseconds,
            compute: off.compute_nanoseconds / both.compute_nanoseconds,
        },
    }
}

fn lines(report: &Report<'_>) -> String {
    let mut text = format!(
        "{} × {} bones and {} vertices in {:?}; gate {}, skinning {}; {}; {} frames at {} Hz; times by {}.\n\n\
         | distance | tall px | Ω | LOD | frame ms | computed ms | drawn ms | skinning ns/vertex | skinned | error rms, \
         max px |\n|---:|---:|---:|---|---:|---:|---:|---:|---:|---:|\n",
        report.instances,
        report.bones,
        report.vertices,
        report.clip,
        report.gate.mode(),
        report.skinning,
        report.adapter,
        report.frames,
        report.rate,
        report.timed_by,
    );
    for row in &report.distances {
        for (name, look) in NAMES.iter().zip(row.all()) {
            writeln!(
                text,
                "| {} | {:.0} | {:.3} | {name} | {:.2} | {:.2} | {:.2} | {:.3} | {:.1} % | {:.3}, {:.3} |",
                row.distance,
                row.tall_pixels,
                row.mean_omega,
                look.frame_nanoseconds / 1e6,
                look.compute_nanoseconds / 1e6,
                look.draw_nanoseconds / 1e6,
                look.nanoseconds_per_vertex,
                100.0 * look.skinned_share,
                look.vertex_error.rms_pixels,
                look.vertex_error.max_pixels,
            )
            .expect("a string");
        }
    }
    text += "\nBoth together are cheaper than off by:\n\n| distance | whole frame | what is computed |\n|---:|---:|---:|\n";
    for Row { distance, cheaper, .. } in &report.distances {
        writeln!(text, "| {distance} | {:.2} | {:.2} |", cheaper.frame, cheaper.compute).expect("a string");
    }
    text
}

fn curves(report: &Report<'_>) -> Chart {
    let series = |(index, name): (usize, &&str)| Series {
        name: (*name).to_owned(),
        points: (report.distances.iter())
            .map(|row| (f64::from(row.distance), row.all()[index].frame_nanoseconds / 1e6))
            .collect(),
        labels: Vec::new(),
    };
    Chart {
        title: format!(
            "Whole frame, {} × {:?}, {} and {}",
            report.instances,
            report.clip,
            report.gate.mode(),
            report.skinning
        ),
        x_label: "distance in units".to_owned(),
        y_label: "milliseconds".to_owned(),
        log_x: false,
        log_y: false,
        series: NAMES.iter().enumerate().map(series).collect(),
    }
}
