//! Times the whole frame against distance, with and without level of detail.

use std::fmt::Write as _;
use std::path::Path;

use relievo::Error;
use relievo_lab::files::Staged;
use relievo_lab::measure::{Cheaper, SceneReport, SceneRow, scene};

use super::plan::Plan;
use super::report::{clock, file_name, is_ours, picture};
use crate::Context;
use crate::measuring::shown;
use crate::output::say;
use relievo_lab::plot::{Chart, Series};

/// The names of the files that this command writes with `--scene`, besides the pictures.
pub const FILES: [&str; 2] = ["scene.json", "scene.png"];

/// Measures the scene, and writes the report, the plot and the pictures.
pub fn run(plan: &Plan, context: &Context, out: &Path) -> Result<(), Error> {
    let gpu = context.gpu()?;
    let mut staged = Staged::new(out)?;
    let (report, pictures) = shown(|listener| scene(&gpu, plan.subject(), &plan.lod, &plan.drawn, listener))?;
    for (distance, picture) in plan.lod.distances.iter().zip(&pictures) {
        staged.write_png(file_name(*distance), picture)?;
    }
    let [figures, chart] = FILES;
    staged.write_json(figures, &report)?;
    staged.write_png(chart, &picture(curves(&report))?)?;
    staged.remove_stale(is_ours);
    staged.publish()?;
    say(lines(&report).trim_end())
}

fn lines(report: &SceneReport) -> String {
    let mut text = format!(
        "{} × {} bones and {} vertices in {:?}; gate {}, skinning {}, mesh {}; {}; {} frames at {} Hz; times by {}.\n\n\
         | distance | tall px | LOD | within px | frame ms | computed ms | drawn ms | bones | skinned | triangles | \
         displacement px | jump px |\n|---:|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        report.instances,
        report.bones,
        report.vertices,
        report.clip,
        report.gate.name().as_str(),
        report.skinning,
        report.mesh,
        report.adapter,
        report.setting.frames,
        report.setting.rate,
        clock(report.timed_by),
    );
    for row in &report.distances {
        for (name, look) in SceneRow::NAMES.iter().zip(row.costs()) {
            writeln!(
                text,
                "| {} | {:.0} | {name} | {} | {:.2} | {:.2} | {:.2} | {:.0} | {:.1} % | {:.1} % | {:.3} | {:.3} |",
                row.distance,
                row.tall_pixels,
                look.pixels,
                look.frame_nanoseconds / 1e6,
                look.compute_nanoseconds / 1e6,
                look.draw_nanoseconds / 1e6,
                look.bones,
                100.0 * look.skinned_fraction,
                100.0 * look.triangle_fraction,
                look.displacement.largest,
                look.displacement.jump,
            )
            .expect("a string");
        }
    }
    text += "\nCheaper than off by:\n\n| distance | LOD | whole frame | what is computed |\n|---:|---|---:|---:|\n";
    for SceneRow { distance, cheaper, all_cheaper, .. } in &report.distances {
        for (name, Cheaper { frame, compute }) in
            SceneRow::NAMES[3..].iter().zip(std::iter::once(cheaper).chain(all_cheaper))
        {
            writeln!(text, "| {distance} | {name} | {frame:.2} | {compute:.2} |").expect("a string");
        }
    }
    text
}

fn curves(report: &SceneReport) -> Chart {
    let series = |(index, name): (usize, &&str)| {
        let point =
            |row: &SceneRow| Some((f64::from(row.distance), row.costs().nth(index)?.frame_nanoseconds / 1e6));
        let points: Vec<_> = report.distances.iter().filter_map(point).collect();
        (!points.is_empty()).then(|| Series { name: (*name).to_owned(), points, labels: Vec::new() })
    };
    Chart {
        title: format!(
            "Whole frame, {} × {:?}, gate {}, skinning {}, mesh {}",
            report.instances,
            report.clip,
            report.gate.name().as_str(),
            report.skinning,
            report.mesh
        ),
        x_label: "distance in units".to_owned(),
        y_label: "milliseconds".to_owned(),
        log_x: false,
        log_y: false,
        series: SceneRow::NAMES.iter().enumerate().filter_map(series).collect(),
    }
}
