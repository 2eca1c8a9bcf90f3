//! A crowd at several distances: report, table and plots.

use std::fmt::Write as _;
use std::path::Path;

use relievo::files::Staged;
use relievo::{Error, InputError};
use serde::Serialize;

use super::errors::{Errors, Jump};
use super::gates::Mode;
use super::plan::Plan;
use super::play::{Found, Stages, gate_of, run as play};
use super::reference::References;
use super::stage::{Stage, mean_omega, moving_bones};
use super::{Layout, pareto};
use crate::Context;
use crate::output::say;
use crate::plot::{Chart, Series, grid};
use crate::progress::bar;
use crate::terrain::Backend;

/// Pixels of a plot.
const SIZE: (u32, u32) = (800, 500);

/// The gate and its parameters.
#[derive(Serialize)]
pub struct GateReport {
    mode: Mode,
    #[serde(skip_serializing_if = "Option::is_none")]
    period: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    weights: Option<[f64; 6]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    budget: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pixels: Option<f32>,
}

impl GateReport {
    pub fn new(plan: &Plan) -> Self {
        let (mode, _) = gate_of(plan);
        let is_periodic = mode == Mode::SkipPeriod;
        Self {
            mode,
            period: is_periodic.then_some(plan.period),
            weights: is_periodic.then_some(plan.weights.0),
            budget: plan.budget.filter(|_| mode == Mode::Budget),
            pixels: (mode == Mode::Bounded).then_some(plan.pixels),
        }
    }

    /// The gate's name.
    #[cfg(feature = "gpu")]
    pub fn mode(&self) -> &'static str {
        self.mode.name()
    }
}

/// What the times are taken by.
#[cfg(feature = "gpu")]
pub fn clock(timed_by: relievo::gpu::TimedBy) -> &'static str {
    match timed_by {
        relievo::gpu::TimedBy::Timestamp => "timestamp",
        relievo::gpu::TimedBy::Wall => "wall",
    }
}

#[derive(Serialize)]
struct Report<'a> {
    adapter: Option<String>,
    driver: Option<String>,
    backend: Backend,
    timed_by: &'static str,
    model: &'a str,
    clip: &'a str,
    gate: GateReport,
    instances: usize,
    layout: Layout,
    seed: u32,
    bones: usize,
    moving_bones: usize,
    size: f32,
    metres_a_unit: f32,
    spacing: f32,
    range: [f32; 2],
    frames: u32,
    rate: f64,
    focal_pixels: f32,
    #[serde(skip_serializing_if = "Option::is_none")]
    skinning: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<String>,
    distances: Vec<Row>,
    /// By the names of their files.
    #[cfg(feature = "gpu")]
    #[serde(skip)]
    pictures: Vec<(String, image::RgbaImage)>,
}

#[derive(Serialize)]
struct Row {
    distance: f32,
    mean_omega: f64,
    interpolated: u64,
    skipped: u64,
    fraction: f64,
    concatenated: u64,
    concatenated_fraction: f64,
    nanoseconds_per_bone: Stages,
    full_nanoseconds_per_bone: Stages,
    error: Errors,
    jump: Jump,
    #[cfg(feature = "gpu")]
    #[serde(flatten)]
    drawn: Option<DrawnRow>,
}

/// What `--image` adds.
#[cfg(feature = "gpu")]
#[derive(Serialize)]
struct DrawnRow {
    drawn_timed_by: &'static str,
    #[serde(flatten)]
    gated: super::vertices::Figures,
    full_nanoseconds_per_vertex: f64,
    full_frame_nanoseconds: f64,
    full_compute_nanoseconds: f64,
    full_draw_nanoseconds: f64,
}

/// What plays.
enum On {
    #[cfg(feature = "gpu")]
    Device(relievo::gpu::Gpu),
    Cpu,
}

impl On {
    #[cfg_attr(not(feature = "gpu"), allow(unused_variables, reason = "the device is the context's"))]
    fn new(plan: &Plan, context: &Context) -> Result<Self, Error> {
        Ok(match plan.backend {
            #[cfg(feature = "gpu")]
            Backend::Gpu => Self::Device(context.gpu()?),
            #[cfg(not(feature = "gpu"))]
            Backend::Gpu => {
                return Err(InputError::new("backend", "gpu", "must be cpu: built without gpu").into());
            }
            Backend::Cpu => Self::Cpu,
        })
    }

    fn timed_by(&self) -> Result<&'static str, Error> {
        Ok(match self {
            #[cfg(feature = "gpu")]
            Self::Device(gpu) => clock(super::device::Device::timed_by(gpu)?),
            Self::Cpu => "wall",
        })
    }

    /// Adapter and driver.
    fn names(&self) -> [Option<String>; 2] {
        match self {
            #[cfg(feature = "gpu")]
            Self::Device(gpu) => [&gpu.adapter().name, &gpu.adapter().driver].map(|name| Some(name.clone())),
            Self::Cpu => [None, None],
        }
    }
}

pub fn run(plan: &Plan, context: &Context, out: &Path) -> Result<(), Error> {
    let mut staged = Staged::new(out)?;
    let report = measured(plan, context)?;
    staged.write_json("report.json", &report)?;
    for (name, chart) in charts(&report) {
        staged.write_png(name, &picture(chart)?)?;
    }
    #[cfg(feature = "gpu")]
    for (name, picture) in &report.pictures {
        staged.write_png(name, picture)?;
    }
    staged.remove_stale(is_ours);
    staged.publish()?;
    say(table(&report).trim_end())
}

/// The picture of the first distance alone, for the demonstration.
#[cfg(feature = "gpu")]
pub fn first_picture(plan: &Plan, context: &Context) -> Result<image::RgbaImage, Error> {
    let pictures = measured(plan, context)?.pictures;
    let (_, picture) =
        pictures.into_iter().next().ok_or(relievo::InputError::new("image", "no", "must be given"))?;
    Ok(picture)
}

fn measured<'a>(plan: &'a Plan, context: &Context) -> Result<Report<'a>, Error> {
    let stage = Stage::new(plan)?;
    let on = On::new(plan, context)?;
    let (mode, budget) = gate_of(plan);
    let (gate, off) = (stage.gate(mode, budget)?, stage.gate(Mode::Off, 0)?);
    let progress = bar(plan.distances.len() as u64 * u64::from(plan.frames + 1), mode.name());
    let mut rows = Vec::with_capacity(plan.distances.len());
    for distance in &plan.distances {
        let scene = stage.scene(*distance);
        let lods = stage.lods(&scene, &gate, plan.pixels);
        let omega = mean_omega(&lods);
        let step = || progress.inc(1);
        let found = match &on {
            #[cfg(feature = "gpu")]
            On::Device(gpu) => {
                let mut device = super::device::Device::new(gpu, &stage, &gate, &lods)?;
                play(&mut device, &stage, &scene, true, step)?
            }
            On::Cpu => {
                let mut references = References::new(&stage, &gate, &off, lods)?;
                play(&mut references, &stage, &scene, true, step)?
            }
        };
        rows.push(row(&stage, *distance, omega, moving_bones(&off), &found));
    }
    progress.finish_and_clear();
    #[cfg(feature = "gpu")]
    let pictures = match &on {
        On::Device(gpu) if plan.drawn.is_some() => draw(gpu, &stage, &gate, &mut rows)?,
        _ => Vec::new(),
    };
    let [adapter, driver] = on.names();
    Ok(Report {
        adapter,
        driver,
        backend: plan.backend,
        timed_by: on.timed_by()?,
        model: &plan.name,
        clip: plan.clip.name(),
        gate: GateReport::new(plan),
        instances: plan.instances,
        layout: plan.layout,
        seed: plan.seed,
        bones: stage.set.bones(),
        moving_bones: moving_bones(&off),
        size: plan.size,
        metres_a_unit: stage.metres_a_unit,
        spacing: plan.spacing,
        range: [plan.range.min, plan.range.max],
        frames: plan.frames,
        rate: plan.rate,
        focal_pixels: stage.projection.focal_pixels,
        skinning: plan.drawn.map(|_| plan.skinning.to_string()),
        mesh: plan.drawn.map(|_| plan.triangles.to_string()),
        distances: rows,
        #[cfg(feature = "gpu")]
        pictures,
    })
}

fn row(stage: &Stage<'_>, distance: f32, mean_omega: f64, moving_bones: usize, found: &Found) -> Row {
    let frames = u64::from(stage.plan.frames);
    let moving = (stage.instances.len() * moving_bones) as u64 * frames;
    let pairs = stage.pairs();
    Row {
        distance,
        mean_omega,
        interpolated: found.interpolated,
        skipped: moving.saturating_sub(found.interpolated),
        fraction: found.interpolated as f64 / moving.max(1) as f64,
        concatenated: found.concatenated,
        concatenated_fraction: found.concatenated as f64 / (pairs as u64 * frames) as f64,
        nanoseconds_per_bone: found.gated.a_bone(pairs),
        full_nanoseconds_per_bone: found.full.a_bone(pairs),
        error: found.errors,
        jump: found.jump,
        #[cfg(feature = "gpu")]
        drawn: None,
    }
}

/// The crowd with its skin beside the full one, at each of these distances.
#[cfg(feature = "gpu")]
fn draw(
    gpu: &relievo::gpu::Gpu,
    stage: &Stage<'_>,
    gate: &relievo::animation::Gate,
    rows: &mut [Row],
) -> Result<Vec<(String, image::RgbaImage)>, Error> {
    use super::drawn::{By, Drawing, Way};
    use super::triangles::Triangles;
    let plan = stage.plan;
    let full = Way { by: By::All, skinning: super::skinning::FULL, triangles: Triangles::All };
    let ways = [full, Way { by: By::Gate, skinning: plan.skinning, triangles: plan.triangles }];
    let progress = bar(rows.len() as u64 * u64::from(plan.frames + 1), "drawing");
    let mut pictures = Vec::with_capacity(rows.len());
    for row in rows {
        let scene = stage.scene(row.distance);
        let lods = stage.lods(&scene, gate, plan.pixels);
        let mut drawing = Drawing::new(gpu, stage, &scene, (gate, &lods), &ways)?;
        let figures = drawing.run(|| progress.inc(1))?;
        let (full, gated) = (figures[0], figures[1]);
        row.drawn = Some(DrawnRow {
            drawn_timed_by: clock(Drawing::timed_by(gpu)?),
            gated,
            full_nanoseconds_per_vertex: full.nanoseconds_per_vertex,
            full_frame_nanoseconds: full.frame_nanoseconds,
            full_compute_nanoseconds: full.compute_nanoseconds,
            full_draw_nanoseconds: full.draw_nanoseconds,
        });
        pictures.push((file_name(row.distance), drawing.picture(1)?));
    }
    progress.finish_and_clear();
    Ok(pictures)
}

fn table(report: &Report<'_>) -> String {
    let mut text = format!(
        "{} × {} bones, {} of them move in {:?}; {}, {}; {} frames at {} Hz; times by {}, of all bones.\n\n\
         | distance | Ω | interpolated | concatenated | gate + sample + concat, whole frame ns/bone | full | error rms, p99, max \
         px | max m | jump px |\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        report.instances,
        report.bones,
        report.moving_bones,
        report.clip,
        report.gate.mode.name(),
        report.adapter.as_deref().unwrap_or("CPU"),
        report.frames,
        report.rate,
        report.timed_by,
    );
    for row in &report.distances {
        let times = &row.nanoseconds_per_bone;
        let parts = match (times.gate, times.sample, times.local_to_model) {
            (Some(gate), Some(sample), Some(local_to_model)) => {
                format!("{gate:.2} + {sample:.2} + {local_to_model:.2}, {:.2}", times.total)
            }
            _ => format!("{:.2}", times.total),
        };
        let Errors { rms_pixels, p99_pixels, max_pixels, max_metres, .. } = row.error;
        writeln!(
            text,
            "| {} | {:.3} | {:.1} % | {:.1} % | {parts} | {:.2} | {rms_pixels:.3}, {p99_pixels:.3}, {max_pixels:.3} \
             | {max_metres:.4} | {:.3} |",
            row.distance,
            row.mean_omega,
            100.0 * row.fraction,
            100.0 * row.concatenated_fraction,
            row.full_nanoseconds_per_bone.total,
            row.jump.max_pixels,
        )
        .expect("a string");
    }
    text
}

/// File names and what they show.
fn charts(report: &Report<'_>) -> [(&'static str, Chart); 3] {
    let series = |name: &str, of: &dyn Fn(&Row) -> Option<f64>| Series {
        name: name.to_owned(),
        points: (report.distances.iter())
            .filter_map(|row| Some((f64::from(row.distance), of(row)?)))
            .collect(),
        labels: Vec::new(),
    };
    let chart = |title: &str, y_label: &str, log_y: bool, series: Vec<Series>| Chart {
        title: format!("{title}, {} × {:?}, {}", report.instances, report.clip, report.gate.mode.name()),
        x_label: "distance in units".to_owned(),
        y_label: y_label.to_owned(),
        log_x: false,
        log_y,
        series: series.into_iter().filter(|series| !series.points.is_empty()).collect(),
    };
    let cost = vec![
        series("without a gate", &|row| Some(row.full_nanoseconds_per_bone.total)),
        series("with the gate", &|row| Some(row.nanoseconds_per_bone.total)),
        series("gate", &|row| row.nanoseconds_per_bone.gate),
        series("sample", &|row| row.nanoseconds_per_bone.sample),
        series("local_to_model", &|row| row.nanoseconds_per_bone.local_to_model),
    ];
    let fraction = vec![
        series("interpolated, of moving bones", &|row| Some(row.fraction)),
        series("concatenated, of all bones", &|row| Some(row.concatenated_fraction)),
        series("mean Ω", &|row| Some(row.mean_omega)),
    ];
    let error = vec![
        series("largest", &|row| Some(row.error.max_pixels)),
        series("99 of 100 below", &|row| Some(row.error.p99_pixels)),
        series("rms", &|row| Some(row.error.rms_pixels)),
    ];
    [
        ("cost.png", chart("Cost", "nanoseconds a bone", false, cost)),
        ("interpolations.png", chart("Work", "fraction", false, fraction)),
        ("error.png", chart("Error", "pixels", true, error)),
    ]
}

/// A chart by itself.
pub fn picture(chart: Chart) -> Result<image::RgbaImage, InputError> {
    Ok(image::DynamicImage::ImageRgb8(grid("", &[chart], 1, SIZE)?).into_rgba8())
}

/// Files of this command without `--pareto`.
const FILES: [&str; 4] = ["report.json", "cost.png", "interpolations.png", "error.png"];

/// The picture of a distance.
#[cfg(feature = "gpu")]
pub fn file_name(distance: f32) -> String {
    format!("crowd_{distance}.png")
}

/// Whether this command writes files of this name.
pub fn is_ours(name: &str) -> bool {
    let is_picture = name.strip_prefix("crowd_").and_then(|name| name.strip_suffix(".png"));
    [&FILES[..], &pareto::FILES, &super::SCENE_FILES].concat().contains(&name)
        || is_picture.is_some_and(|distance| distance.parse::<f32>().is_ok())
}
