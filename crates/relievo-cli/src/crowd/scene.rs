//! Times the whole frame against distance, with and without level of detail.

use std::path::Path;

use relievo::Error;
use relievo_lab::files::Staged;
use relievo_lab::measure::{Cheaper, SceneReport, SceneRow, Setting, scene};
use relievo_lab::plot::{Chart, Series};

use super::plan::Plan;
use super::report::{clock, picture, publish};
use crate::Context;
use crate::output::say;
use crate::progress::shown;

/// The names of the files that this command writes with `--scene`, besides the pictures.
pub const FILES: [&str; 2] = ["scene.json", "scene.png"];

/// Measures the scene, and writes the report, the plot and the pictures.
pub fn run(plan: &Plan, context: &Context, out: &Path) -> Result<(), Error> {
    let gpu = context.gpu()?;
    let mut staged = Staged::new(out)?;
    let (report, pictures) = shown(|listener| scene(&gpu, plan.subject(), &plan.lod, &plan.drawn, listener))?;
    let [figures, chart] = FILES;
    staged.write_json(figures, &report)?;
    staged.write_png(chart, &picture(curves(&report))?)?;
    publish(staged, plan, &pictures)?;
    say(lines(&report).trim_end())
}

fn lines(report: &SceneReport) -> String {
    let Setting { adapter, instances, bones, clip, gate, frames, rate, timed_by, .. } = &report.setting;
    let mut text = format!(
        "{instances} × {bones} bones and {} vertices in {clip:?}; gate {}, skinning {}, mesh {}; {}; {frames} frames at {rate} \
         Hz; times by {}.\n\n\
         | distance | tall px | LOD | within px | frame ms | computed ms | drawn ms | bones | skinned | triangles | \
         displacement px | jump px |\n|---:|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
        report.vertices,
        gate.name().as_str(),
        report.skinning,
        report.mesh,
        adapter.as_deref().unwrap_or_default(),
        clock(*timed_by),
    );
    for row in &report.distances {
        for (name, look) in SceneRow::NAMES.iter().zip(row.costs()) {
            text += &format!(
                "| {} | {:.0} | {name} | {} | {:.2} | {:.2} | {:.2} | {:.0} | {:.1} % | {:.1} % | {:.3} | {:.3} |\n",
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
            );
        }
    }
    text += "\nCheaper than off by:\n\n| distance | LOD | whole frame | what is computed |\n|---:|---|---:|---:|\n";
    for SceneRow { distance, cheaper, all_cheaper, .. } in &report.distances {
        for (name, Cheaper { frame, compute }) in
            ["both", "all"].iter().zip(std::iter::once(cheaper).chain(all_cheaper))
        {
            text += &format!("| {distance} | {name} | {frame:.2} | {compute:.2} |\n");
        }
    }
    text
}

fn curves(report: &SceneReport) -> Chart {
    let series = |(index, name): (usize, &&str)| {
        let point =
            |row: &SceneRow| Some((f64::from(row.distance), row.costs().nth(index)?.frame_nanoseconds / 1e6));
        Series::new(*name, report.distances.iter().filter_map(point).collect())
    };
    let all = SceneRow::NAMES.iter().enumerate().map(series);
    let Setting { instances, clip, gate, .. } = &report.setting;
    let (gate, SceneReport { skinning, mesh, .. }) = (gate.name().as_str(), report);
    Chart {
        title: format!("Whole frame, {instances} × {clip:?}, gate {gate}, skinning {skinning}, mesh {mesh}"),
        x_label: "distance in units".to_owned(),
        y_label: "milliseconds".to_owned(),
        series: all.filter(|series| !series.points.is_empty()).collect(),
        ..Chart::default()
    }
}
