//! The plots of a sweep: one panel per layout, side by side, all against distance.

use image::RgbaImage;
use relievo::InputError;
use relievo_lab::measure::{
    DistanceSweepOptions, DistanceSweepReport, GateName, GroupLayout, SWEEP_MODES, SweepLayout, SweepRow,
};
use relievo_lab::plot::{Chart, Series, grid};

/// The names of the files of all plots.
pub const FILES: [&str; 4] = ["frame_rate.png", "whole_frame_rate.png", "interpolations.png", "error.png"];

/// Width and height of a row of two panels, in pixels.
const ROW: [u32; 2] = [1200, 560];

/// What A section 13 reports, in frames a second: without level of detail, and with it at the largest distance.
const THESIS: [f64; 2] = [12.0, 43.6];

/// The range for which A reports, in units.
const THESIS_RANGE: [f32; 2] = [200.0, 1700.0];

/// The smallest error in pixels that the plot shows. Smaller ones are rounding and count as 0, which is drawn hollow at the
/// bottom.
const LEAST_ERROR: f64 = 1e-3;

/// The name of each plot's file, and the plot.
pub fn pictures(
    options: &DistanceSweepOptions,
    report: &DistanceSweepReport,
) -> Result<Vec<(&'static str, RgbaImage)>, InputError> {
    let DistanceSweepReport { instances, bones, clip, adapter, .. } = report;
    let title = |what: &str| format!("{what}: {instances} models × {bones} bones, {clip:?}, {adapter}");
    let charts = |of: &dyn Fn(&SweepLayout) -> Chart| report.layouts.iter().map(of).collect::<Vec<_>>();
    let [rate, whole, work, error] = FILES;
    let mut pictures = Vec::new();
    let updates = charts(&|layout| updates(options, layout));
    pictures.push((rate, grid(&title("Updates of bones a second"), &updates, 2, ROW)?));
    if report.drawn_frames > 0 {
        let frames = charts(&|layout| Chart {
            log_y: true,
            ..chart(layout, "", "frames a second", modes(layout, &|row| row.frame_rate))
        });
        pictures.push((whole, grid(&title("Whole frames a second"), &frames, 2, ROW)?));
    }
    let interpolations = charts(&|layout| {
        chart(layout, "", "interpolations a frame", modes(layout, &|row| Some(row.interpolated)))
    });
    pictures.push((work, grid(&title("Bones interpolated"), &interpolations, 2, ROW)?));
    let mut panels = charts(&|layout| errors(report, layout, "largest error", |row| row.error.max_pixels));
    panels.extend(charts(&|layout| errors(report, layout, "rms error", |row| row.error.rms_pixels)));
    pictures.push((error, grid(&title("Error on screen"), &panels, 2, [ROW[0], 2 * ROW[1]])?));
    Ok(pictures)
}

/// One panel.
fn chart(layout: &SweepLayout, what: &str, y_label: &str, series: Vec<Series>) -> Chart {
    let name = match layout.layout {
        GroupLayout::Grid => "models in a grid",
        GroupLayout::Cube => "models at random in a cube",
    };
    Chart {
        title: if what.is_empty() { name.to_owned() } else { format!("{what}, {name}") },
        x_label: "distance to the group's centre in units".to_owned(),
        y_label: y_label.to_owned(),
        series,
        ..Chart::default()
    }
}

/// One series per mode.
fn modes(layout: &SweepLayout, of: &dyn Fn(&SweepRow) -> Option<f64>) -> Vec<Series> {
    let series = |mode: GateName| {
        let rows = layout.rows.iter().filter(|row| row.mode == mode);
        Series::new(name(mode), rows.filter_map(|row| Some((row.distance.into(), of(row)?))).collect())
    };
    SWEEP_MODES.into_iter().map(series).collect()
}

fn name(mode: GateName) -> &'static str {
    match mode {
        GateName::Off => "off: all bones",
        GateName::SkipPeriod => "skip-period: the thesis' method",
        other => other.as_str(),
    }
}

/// Updates a second, with what A reports.
fn updates(options: &DistanceSweepOptions, layout: &SweepLayout) -> Chart {
    let mut series = modes(layout, &|row| Some(row.update_rate));
    series.extend(thesis(options, layout.layout));
    Chart { log_y: true, ..chart(layout, "", "updates a second (A: frames)", series) }
}

/// What A reports for a layout: only the stretches for which it gives a number.
fn thesis(options: &DistanceSweepOptions, layout: GroupLayout) -> Vec<Series> {
    let [without, with] = ["thesis A without LOD: 12", "thesis A with LOD: 12, in the end 43.6"];
    let all = || options.distances.iter().copied();
    let [first, last] = [all().fold(f32::INFINITY, f32::min), all().fold(0.0, f32::max)];
    if [options.range.min, options.range.max] != THESIS_RANGE {
        return Vec::new();
    }
    let [full, skipped] = THESIS;
    let stretch = |name: &str, from: f32, to: f32, rate: f64| {
        (from <= to).then(|| Series::new(name, vec![(from.into(), rate), (to.into(), rate)]))
    };
    let near = match layout {
        GroupLayout::Grid => stretch(with, first, options.range.min.min(last), full),
        GroupLayout::Cube => None,
    };
    let far = options.range.max + options.half_depth(layout);
    let parts = [stretch(without, first, last, full), near, stretch(with, far.max(first), last, skipped)];
    parts.into_iter().flatten().collect()
}

/// Errors in pixels, with the bound that `bounded` keeps.
fn errors(
    report: &DistanceSweepReport,
    layout: &SweepLayout,
    what: &str,
    of: impl Fn(&SweepRow) -> f64,
) -> Chart {
    let shown = |row: &SweepRow| Some(of(row)).map(|error| if error >= LEAST_ERROR { error } else { 0.0 });
    let mut series = modes(layout, &shown);
    let ends = [layout.rows.first(), layout.rows.last()];
    let ends = ends.into_iter().flatten().map(|row| (f64::from(row.distance), f64::from(report.pixels)));
    series.push(Series::new(format!("{} px, the bound of bounded", report.pixels), ends.collect()));
    Chart { log_y: true, ..chart(layout, what, "pixels", series) }
}
