//! `--pareto`: error against cost for every gate.

use std::path::Path;

use relievo::Error;
use relievo_lab::files::Staged;
use relievo_lab::measure::{AtCost, AtError, Comparisons, Errors, ParetoPoint, ParetoReport, pareto};
use relievo_lab::plot::{Chart, Series};

use super::plan::Plan;
use super::report::{picture, publish};
use crate::output::say;
use crate::progress::shown;

/// The names of the files that this command writes with `--pareto`.
pub const FILES: [&str; 3] = ["pareto.json", "pareto_max.png", "pareto_rms.png"];

/// The smallest cost and the smallest error in pixels that plots show; smaller ones would not be visible.
const LEAST: [f64; 2] = [0.01, 1e-3];

pub fn run(plan: &Plan, out: &Path) -> Result<(), Error> {
    let mut staged = Staged::new(out)?;
    let report = measured(plan)?;
    let [figures, largest, rms] = FILES;
    staged.write_json(figures, &report)?;
    staged.write_png(largest, &picture(chart(&report, "Largest", |error| error.max_pixels))?)?;
    staged.write_png(rms, &picture(chart(&report, "Rms", |error| error.rms_pixels))?)?;
    publish(staged, plan, &[])?;
    say(format_args!("{}\n{}", table(&report.points), comparison_table(&report.comparisons).trim_end()))
}

/// The plot of the largest errors only, for `relievo demo`.
pub fn largest_errors(plan: &Plan) -> Result<image::RgbaImage, Error> {
    Ok(picture(chart(&measured(plan)?, "Largest", |error| error.max_pixels))?)
}

fn measured(plan: &Plan) -> Result<ParetoReport, Error> {
    shown(|listener| pareto(plan.subject(), &plan.pareto, listener))
}

fn chart(report: &ParetoReport, what: &str, error: impl Fn(&Errors) -> f64) -> Chart {
    let series = |points: &[ParetoPoint]| {
        let name = points[0].gate.as_str();
        let mut points: Vec<(f64, f64)> = (points.iter())
            .map(|point| (point.cost, error(&point.error)))
            .filter(|(cost, error)| *cost >= LEAST[0] && *error >= LEAST[1])
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Series::new(name, points)
    };
    let ParetoReport { instances, clip, tall_pixels, points, .. } = report;
    Chart {
        title: format!("{what} error, {instances} × {clip:?} at {tall_pixels} pixels"),
        x_label: "interpolations, of animated bones".to_owned(),
        y_label: "pixels".to_owned(),
        log_x: true,
        log_y: true,
        series: points.chunk_by(|a, b| a.gate == b.gate).map(series).collect(),
    }
}

fn table(points: &[ParetoPoint]) -> String {
    let mut text = "| gate | parameter | cost | rms px | p99 px | max px | jump px | concatenated |\n\
                    |---|---:|---:|---:|---:|---:|---:|---:|\n"
        .to_owned();
    for ParetoPoint { gate, parameter, cost, concatenated_fraction, error, jump } in points {
        text += &format!(
            "| {} | {parameter:.3} | {cost:.3} | {:.4} | {:.4} | {:.4} | {:.4} | {concatenated_fraction:.3} |\n",
            gate.as_str(),
            error.rms_pixels,
            error.p99_pixels,
            error.max_pixels,
            jump.max_pixels,
        );
    }
    text
}

fn comparison_table(comparisons: &Comparisons) -> String {
    let mut text = String::new();
    for (name, what, rows) in [
        ("bounded", "largest error in pixels", &comparisons.bounded_max_pixels),
        ("budget", "rms error in pixels", &comparisons.budget_rms_pixels),
    ] {
        text += &format!(
            "At equal cost, {what}:\n\n| cost | {name} | uniform | random | ratio to the better |\n"
        );
        text += "|---:|---:|---:|---:|---:|\n";
        for AtCost { cost, gate, uniform, random, ratio } in rows {
            let ratio = ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"));
            text += &format!("| {cost:.1} | {gate:.4} | {uniform:.4} | {random:.4} | {ratio} |\n");
        }
        text += &format!("\n{}\n\n", sentence(name, rows));
    }
    text += "At equal largest error, interpolations of animated bones:\n\n\
             | largest error px | uniform | bounded | ratio |\n|---:|---:|---:|---:|\n";
    for AtError { max_pixels, uniform, bounded, ratio } in &comparisons.bounded_cost {
        text += &format!("| {max_pixels:.3} | {uniform:.3} | {bounded:.3} | {ratio:.2} |\n");
    }
    let ratios: Vec<f64> = comparisons.bounded_cost.iter().map(|row| row.ratio).collect();
    if let Some([least, most]) = ends(&ratios) {
        text += &format!("\n`bounded` does {least:.2} to {most:.2} times the interpolations of `uniform`.\n");
    }
    text
}

fn sentence(name: &str, rows: &[AtCost]) -> String {
    let ratios: Vec<f64> = rows.iter().filter_map(|row| row.ratio).collect();
    let worse: Vec<_> = (rows.iter())
        .filter(|row| row.ratio.is_some_and(|ratio| ratio >= 1.0))
        .map(|row| format!("{:.1}", row.cost))
        .collect();
    let Some([least, most]) = ends(&ratios) else { return format!("`{name}` has no rival.") };
    let found = match worse.is_empty() {
        true => "better at every one of these costs".to_owned(),
        false => format!("not better at the costs {}", worse.join(", ")),
    };
    format!("`{name}` is {found}: {least:.2} to {most:.2} times the error.")
}

fn ends(values: &[f64]) -> Option<[f64; 2]> {
    let [least, most] = [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| values.iter().copied().reduce(of));
    Some([least?, most?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_admit_defeat() {
        let row = |cost, ratio| AtCost { cost, gate: 1.0, uniform: 1.0, random: 1.0, ratio: Some(ratio) };
        assert!(sentence("x", &[row(0.1, 0.5), row(0.2, 0.9)]).contains("better at every"));
        assert!(sentence("x", &[row(0.1, 0.5), row(0.2, 1.0)]).contains("not better at the costs 0.2"));
    }
}
