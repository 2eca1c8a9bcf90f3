//! Measures a crowd at several distances, and writes the report, a table and plots.

use std::path::Path;

use image::RgbaImage;
use relievo::{Error, InputError};
use relievo_lab::files::Staged;
use relievo_lab::harness::TimedBy;
use relievo_lab::measure::{AnimationReport, AnimationRow, Errors, Setting, animation, drawn};
use relievo_lab::plot::{Chart, Series, grid};

use super::plan::Plan;
use super::{pareto, scene};
use crate::Context;
use crate::output::say;
use crate::progress::shown;

/// Width and height of a plot, in pixels.
const SIZE: [u32; 2] = [800, 500];

pub fn run(plan: &Plan, is_drawn: bool, context: &Context, out: &Path) -> Result<(), Error> {
    let mut staged = Staged::new(out)?;
    let (report, pictures) = measured(plan, is_drawn, context)?;
    staged.write_json("report.json", &report)?;
    for (name, chart) in charts(&report) {
        staged.write_png(name, &picture(chart)?)?;
    }
    publish(staged, plan, &pictures)?;
    say(table(&report).trim_end())
}

/// Writes the picture at each distance, and publishes all files of a run in the place of those of an earlier one.
pub fn publish(mut staged: Staged, plan: &Plan, pictures: &[RgbaImage]) -> Result<(), Error> {
    for (distance, picture) in plan.lod.distances.iter().zip(pictures) {
        staged.write_png(format!("crowd_{distance}.png"), picture)?;
    }
    staged.remove_stale(is_ours);
    staged.publish()
}

/// Measures the crowd: the report, and one picture per distance if the crowd is drawn.
pub fn measured(
    plan: &Plan,
    is_drawn: bool,
    context: &Context,
) -> Result<(AnimationReport, Vec<RgbaImage>), Error> {
    let (gpu, subject) = (plan.backend.gpu(context)?, plan.subject());
    shown(|listener| match &gpu {
        Some(gpu) if is_drawn => drawn(gpu, subject, &plan.lod, &plan.drawn, listener),
        gpu => Ok((animation(gpu.as_ref(), subject, &plan.lod, listener)?, Vec::new())),
    })
}

/// The name of the clock that took the times.
pub fn clock(timed_by: TimedBy) -> &'static str {
    match timed_by {
        TimedBy::Timestamp => "timestamp",
        TimedBy::Wall => "wall",
    }
}

fn table(report: &AnimationReport) -> String {
    let Setting { instances, bones, clip, gate, adapter, frames, rate, timed_by, .. } = &report.setting;
    let mut text = format!(
        "{instances} × {bones} bones, {} of them move in {clip:?}; {}, {}; {frames} frames at {rate} Hz; times by {}, of all \
         bones.\n\n\
         | distance | Ω | interpolated | concatenated | gate + sample + local to model, whole frame ns/bone | full | error rms, p99, max \
         px | max m | jump px |\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        report.animated_bones,
        gate.name().as_str(),
        adapter.as_deref().unwrap_or("CPU"),
        clock(*timed_by),
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
        text += &format!(
            "| {} | {:.3} | {:.1} % | {:.1} % | {parts} | {:.2} | {rms_pixels:.3}, {p99_pixels:.3}, {max_pixels:.3} \
             | {max_metres:.4} | {:.3} |\n",
            row.distance,
            row.mean_omega,
            100.0 * row.fraction,
            100.0 * row.concatenated_fraction,
            row.full_nanoseconds_per_bone.total,
            row.jump.max_pixels,
        );
    }
    text
}

/// The name of each plot's file, and its chart.
fn charts(report: &AnimationReport) -> [(&'static str, Chart); 3] {
    let series = |name: &str, of: &dyn Fn(&AnimationRow) -> Option<f64>| {
        let point = |row: &AnimationRow| Some((f64::from(row.distance), of(row)?));
        Series::new(name, report.distances.iter().filter_map(point).collect())
    };
    let Setting { instances, clip, gate, .. } = &report.setting;
    let chart = |title: &str, y_label: &str, log_y: bool, series: Vec<Series>| Chart {
        title: format!("{title}, {instances} × {clip:?}, {}", gate.name().as_str()),
        x_label: "distance in units".to_owned(),
        y_label: y_label.to_owned(),
        log_y,
        series: series.into_iter().filter(|series| !series.points.is_empty()).collect(),
        ..Chart::default()
    };
    let cost = vec![
        series("without a gate", &|row| Some(row.full_nanoseconds_per_bone.total)),
        series("with the gate", &|row| Some(row.nanoseconds_per_bone.total)),
        series("gate", &|row| row.nanoseconds_per_bone.gate),
        series("sample", &|row| row.nanoseconds_per_bone.sample),
        series("local_to_model", &|row| row.nanoseconds_per_bone.local_to_model),
    ];
    let fraction = vec![
        series("interpolated, of animated bones", &|row| Some(row.fraction)),
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

/// Draws one chart.
pub fn picture(chart: Chart) -> Result<RgbaImage, InputError> {
    grid("", &[chart], 1, SIZE)
}

/// The names of the files that this command writes without `--pareto`.
const FILES: [&str; 4] = ["report.json", "cost.png", "interpolations.png", "error.png"];

/// Whether this command writes a file of this name.
fn is_ours(name: &str) -> bool {
    let is_picture = name.strip_prefix("crowd_").and_then(|name| name.strip_suffix(".png"));
    [&FILES[..], &pareto::FILES, &scene::FILES].concat().contains(&name)
        || is_picture.is_some_and(|distance| distance.parse::<f32>().is_ok())
}
