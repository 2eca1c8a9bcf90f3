//! Measures a crowd at several distances, and writes the report, a table and plots.

use std::fmt::Write as _;
use std::path::Path;

use image::RgbaImage;
use relievo::{Error, InputError};
use relievo_lab::files::Staged;
use relievo_lab::harness::TimedBy;
use relievo_lab::measure::{AnimationReport, AnimationRow, Errors, animation, drawn};

use super::plan::Plan;
use super::{pareto, scene};
use crate::Context;
use crate::arguments::Backend;
use crate::measuring::shown;
use crate::output::say;
use relievo_lab::plot::{Chart, Series, grid};

/// Width and height of a plot, in pixels.
const SIZE: (u32, u32) = (800, 500);

pub fn run(plan: &Plan, is_drawn: bool, context: &Context, out: &Path) -> Result<(), Error> {
    let mut staged = Staged::new(out)?;
    let (report, pictures) = measured(plan, is_drawn, context)?;
    staged.write_json("report.json", &report)?;
    for (name, chart) in charts(&report) {
        staged.write_png(name, &picture(chart)?)?;
    }
    for (distance, picture) in plan.lod.distances.iter().zip(&pictures) {
        staged.write_png(file_name(*distance), picture)?;
    }
    staged.remove_stale(is_ours);
    staged.publish()?;
    say(table(&report).trim_end())
}

/// Measures the crowd: the report, and one picture per distance if the crowd is drawn.
pub fn measured(
    plan: &Plan,
    is_drawn: bool,
    context: &Context,
) -> Result<(AnimationReport, Vec<RgbaImage>), Error> {
    let gpu = match plan.backend {
        Backend::Gpu => Some(context.gpu()?),
        Backend::Cpu => None,
    };
    let subject = plan.subject();
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
    let mut text = format!(
        "{} × {} bones, {} of them move in {:?}; {}, {}; {} frames at {} Hz; times by {}, of all bones.\n\n\
         | distance | Ω | interpolated | concatenated | gate + sample + local to model, whole frame ns/bone | full | error rms, p99, max \
         px | max m | jump px |\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        report.instances,
        report.bones,
        report.animated_bones,
        report.clip,
        report.gate.name().as_str(),
        report.adapter.as_deref().unwrap_or("CPU"),
        report.setting.frames,
        report.setting.rate,
        clock(report.timed_by),
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

/// The name of each plot's file, and its chart.
fn charts(report: &AnimationReport) -> [(&'static str, Chart); 3] {
    let series = |name: &str, of: &dyn Fn(&AnimationRow) -> Option<f64>| Series {
        name: name.to_owned(),
        points: (report.distances.iter())
            .filter_map(|row| Some((f64::from(row.distance), of(row)?)))
            .collect(),
        labels: Vec::new(),
    };
    let chart = |title: &str, y_label: &str, log_y: bool, series: Vec<Series>| Chart {
        title: format!("{title}, {} × {:?}, {}", report.instances, report.clip, report.gate.name().as_str()),
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
pub fn picture(chart: Chart) -> Result<image::RgbaImage, InputError> {
    Ok(image::DynamicImage::ImageRgb8(grid("", &[chart], 1, SIZE)?).into_rgba8())
}

/// The names of the files that this command writes without `--pareto`.
const FILES: [&str; 4] = ["report.json", "cost.png", "interpolations.png", "error.png"];

/// The file name of the picture at a distance.
pub fn file_name(distance: f32) -> String {
    format!("crowd_{distance}.png")
}

/// Whether this command writes a file of this name.
pub fn is_ours(name: &str) -> bool {
    let is_picture = name.strip_prefix("crowd_").and_then(|name| name.strip_suffix(".png"));
    [&FILES[..], &pareto::FILES, &scene::FILES].concat().contains(&name)
        || is_picture.is_some_and(|distance| distance.parse::<f32>().is_ok())
}
