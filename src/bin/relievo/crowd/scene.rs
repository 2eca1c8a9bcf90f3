//! The whole frame against distance: without level of detail, with it in animation, in skinning, in both, and in these
//! and the meshes.

use std::fmt::Write as _;
use std::path::Path;

use relievo::Error;
use relievo::files::Staged;
use relievo::gpu::Gpu;
use serde::Serialize;

use super::drawn::{By, Drawing, Way, fade, level_begins};
use super::play::gate_of;
use super::report::{GateReport, clock, file_name, picture};
use super::skinning::FULL;
use super::stage::{Stage, mean_omega};
use super::triangles::{LevelReport, Triangles};
use super::vertices::Figures;
use super::{Layout, SCENE_FILES, plan::Plan};
use crate::Context;
use crate::output::say;
use crate::plot::{Chart, Series};
use crate::progress::bar;

/// What is compared, as reports and plots call it; the last where meshes have levels.
const NAMES: [&str; 5] = ["off", "animation", "skinning", "both", "all"];

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
    mesh: String,
    /// Of each mesh.
    levels: Vec<Vec<LevelReport>>,
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
    #[serde(skip_serializing_if = "Option::is_none")]
    all: Option<Figures>,
    cheaper: Cheaper,
    #[serde(skip_serializing_if = "Option::is_none")]
    all_cheaper: Option<Cheaper>,
}

/// Times of `off` divided by those of a way.
#[derive(Serialize)]
struct Cheaper {
    frame: f64,
    compute: f64,
}

impl Cheaper {
    fn new(off: &Figures, way: &Figures) -> Self {
        Self {
            frame: off.frame_nanoseconds / way.frame_nanoseconds,
            compute: off.compute_nanoseconds / way.compute_nanoseconds,
        }
    }
}

impl Row {
    /// In the order of [`NAMES`].
    fn ways(&self) -> impl Iterator<Item = &Figures> {
        [&self.off, &self.animation, &self.skinning, &self.both].into_iter().chain(&self.all)
    }
}

/// Plays the scene, and writes what it found.
pub fn run(plan: &Plan, context: &Context, out: &Path) -> Result<(), Error> {
    let gpu = context.gpu()?;
    let mut staged = Staged::new(out)?;
    let stage = Stage::new(plan)?;
    let (mode, budget) = gate_of(plan);
    let gate = stage.gate(mode, budget)?;
    let ways = ways(plan);
    let progress = bar(plan.distances.len() as u64 * u64::from(plan.frames + 1), "scene");
    let mut rows = Vec::with_capacity(plan.distances.len());
    for distance in &plan.distances {
        let scene = stage.scene(*distance);
        let lods = stage.lods(&scene, &gate, plan.pixels);
        let mut drawing = Drawing::new(&gpu, &stage, &scene, (&gate, &lods), &ways)?;
        let figures = drawing.run(|| progress.inc(1))?;
        staged.write_png(file_name(*distance), &drawing.picture(ways.len() - 1)?)?;
        rows.push(row(&stage, *distance, mean_omega(&lods), &figures));
    }
    progress.finish_and_clear();
    let report = report(&stage, &gpu, rows)?;
    let [figures, chart] = SCENE_FILES;
    staged.write_json(figures, &report)?;
    staged.write_png(chart, &picture(curves(&report))?)?;
    staged.remove_stale(super::report::is_ours);
    staged.publish()?;
    say(lines(&report).trim_end())
}

/// In the order of [`NAMES`].
fn ways(plan: &Plan) -> Vec<Way> {
    let way = |by, skinning, triangles| Way { by, skinning, triangles };
    let mut ways = vec![
        way(By::All, FULL, Triangles::All),
        way(By::Gate, FULL, Triangles::All),
        way(By::All, plan.skinning, Triangles::All),
        way(By::Gate, plan.skinning, Triangles::All),
    ];
    if plan.triangles != Triangles::All {
        ways.push(way(By::Gate, plan.skinning, plan.triangles));
    }
    ways
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
        mesh: plan.triangles.to_string(),
        levels: (stage.model(plan.triangles).meshes.iter().enumerate())
            .map(|(at, mesh)| {
                let begins = level_begins(stage, plan.triangles, at);
                let own = stage.levelled.as_ref().map_or(&[][..], |levelled| &levelled.own[at]);
                LevelReport::of_mesh(mesh, own, &begins, stage.metres_a_unit)
            })
            .collect(),
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
        focal_pixels: stage.projection.focal_pixels,
        distances,
    })
}

fn row(stage: &Stage<'_>, distance: f32, mean_omega: f64, figures: &[Figures]) -> Row {
    let [off, animation, skinning, both] = std::array::from_fn(|look| figures[look]);
    let all = figures.get(4).copied();
    Row {
        distance,
        tall_pixels: stage.plan.size * stage.projection.focal_pixels / distance,
        mean_omega,
        off,
        animation,
        skinning,
        both,
        all,
        cheaper: Cheaper::new(&off, &both),
        all_cheaper: all.map(|all| Cheaper::new(&off, &all)),
    }
}

fn lines(report: &Report<'_>) -> String {
    let mut text = format!(
        "{} × {} bones and {} vertices in {:?}; gate {}, skinning {}, mesh {}; {}; {} frames at {} Hz; times by {}.\n\n\
         | distance | tall px | Ω | LOD | frame ms | computed ms | drawn ms | skinning ns/vertex | skinned | triangles | \
         error rms, max px |\n|---:|---:|---:|---|---:|---:|---:|---:|---:|---:|---:|\n",
        report.instances,
        report.bones,
        report.vertices,
        report.clip,
        report.gate.mode(),
        report.skinning,
        report.mesh,
        report.adapter,
        report.frames,
        report.rate,
        report.timed_by,
    );
    for row in &report.distances {
        for (name, look) in NAMES.iter().zip(row.ways()) {
            writeln!(
                text,
                "| {} | {:.0} | {:.3} | {name} | {:.2} | {:.2} | {:.2} | {:.3} | {:.1} % | {:.1} % | {:.3}, {:.3} |",
                row.distance,
                row.tall_pixels,
                row.mean_omega,
                look.frame_nanoseconds / 1e6,
                look.compute_nanoseconds / 1e6,
                look.draw_nanoseconds / 1e6,
                look.nanoseconds_per_vertex,
                100.0 * look.skinned_fraction,
                100.0 * look.triangle_fraction,
                look.vertex_error.rms_pixels,
                look.vertex_error.max_pixels,
            )
            .expect("a string");
        }
    }
    text += "\nCheaper than off by:\n\n| distance | LOD | whole frame | what is computed |\n|---:|---|---:|---:|\n";
    for Row { distance, cheaper, all_cheaper, .. } in &report.distances {
        for (name, Cheaper { frame, compute }) in
            NAMES[3..].iter().zip(std::iter::once(cheaper).chain(all_cheaper))
        {
            writeln!(text, "| {distance} | {name} | {frame:.2} | {compute:.2} |").expect("a string");
        }
    }
    text
}

fn curves(report: &Report<'_>) -> Chart {
    let series = |(index, name): (usize, &&str)| {
        let point =
            |row: &Row| Some((f64::from(row.distance), row.ways().nth(index)?.frame_nanoseconds / 1e6));
        let points: Vec<_> = report.distances.iter().filter_map(point).collect();
        (!points.is_empty()).then(|| Series { name: (*name).to_owned(), points, labels: Vec::new() })
    };
    Chart {
        title: format!(
            "Whole frame, {} × {:?}, gate {}, skinning {}, mesh {}",
            report.instances,
            report.clip,
            report.gate.mode(),
            report.skinning,
            report.mesh
        ),
        x_label: "distance in units".to_owned(),
        y_label: "milliseconds".to_owned(),
        log_x: false,
        log_y: false,
        series: NAMES.iter().enumerate().filter_map(series).collect(),
    }
}
