//! The sections of plots: the last frames, and the experiment.

use egui::{Ui, Vec2b};
use egui_plot::{AxisHints, Corner, GridInput, GridMark, Legend, Line, Plot, PlotPoints};
use relievo_lab::measure::{DistanceSweepOptions, GateName, SWEEP_MODES, SweepRow};

use super::section;
use crate::history::{History, STAGES, Sample};
use crate::theme::SERIES;
use crate::viewer::{Request, Viewer};

/// Height of a plot in points.
const HEIGHT: f32 = 110.0;

/// The range of distances with room for a legend, in parts of the range that was measured.
const LEGEND: f64 = 1.5;

pub fn show(viewer: &mut Viewer, ui: &mut Ui) {
    section(ui, "Plots", false, |ui| frames(viewer, ui));
    section(ui, "Experiment", false, |ui| experiment(viewer, ui));
}

/// A named series of points.
type Series = (String, Vec<[f64; 2]>);

/// Plots over the last frames.
fn frames(viewer: &Viewer, ui: &mut Ui) {
    let history = &viewer.history;
    let one = |name: &str, value: &dyn Fn(&Sample) -> Option<f64>| (name.to_owned(), history.points(value));
    let time = [
        one("frame", &|sample| (sample.frame > 0.0).then_some(sample.frame)),
        one("device", &|sample| sample.device),
        one("recording", &|sample| Some(sample.record)),
    ];
    plot(ui, "milliseconds a frame", &time);
    let stages = |at: usize| one(STAGES[at], &|sample| Some(sample.stages?[at]));
    let stages: Vec<Series> =
        (0..STAGES.len()).map(stages).filter(|(_, points)| !points.is_empty()).collect();
    if !stages.is_empty() {
        plot(ui, "milliseconds by stage", &stages);
    }
    plot(ui, "triangles", &[one("triangles", &|sample| Some(sample.triangles))]);
    plot(ui, "bones interpolated", &[one("bones", &|sample| Some(sample.bones))]);
    let pixels = [
        one("bound", &|sample| sample.bound),
        one("displacement of the chosen character", &|sample| sample.displacement),
    ];
    plot(ui, "pixels off", &pixels);
    plot(ui, "mean level", &levels(viewer, history));
    plot(ui, "bytes that arrived", &[one("bytes", &|sample| Some(sample.bytes))]);
}

/// The mean level of each object but terrain.
fn levels(viewer: &Viewer, history: &History) -> Vec<Series> {
    let objects = viewer.shown.iter().flat_map(|shown| &shown.stage.world.objects).enumerate();
    let of = |(at, object): (usize, &relievo_scene_file::WorldObject)| {
        object.model.as_ref()?;
        Some((object.name.clone(), history.points(|sample| sample.levels.get(at).copied())))
    };
    objects.filter_map(of).take(SERIES.len()).collect()
}

/// A plot whose lower end is 0.
fn plot(ui: &mut Ui, title: &str, series: &[Series]) {
    ui.label(egui::RichText::new(title).small());
    let plot = Plot::new(title)
        .height(HEIGHT)
        .include_y(0.0)
        .show_x(false)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .show_axes(Vec2b::new(false, true))
        .custom_y_axes(vec![values()])
        .y_grid_spacer(marks);
    let plot = if series.len() > 1 { plot.legend(legend()) } else { plot };
    plot.show(ui, |ui| {
        for ((name, points), color) in series.iter().zip(SERIES) {
            ui.line(Line::new(name.clone(), PlotPoints::from(points.clone())).color(color).width(1.5));
        }
    });
}

/// The axis of values, whose marks all have their number.
fn values() -> AxisHints<'static> {
    let hints = AxisHints::new_y().min_thickness(44.0).label_spacing(egui::Rangef::new(8.0, 12.0));
    hints.formatter(|GridMark { value, step_size }, _| {
        let decimals = (-step_size.log10().floor()).max(0.0) as usize;
        format!("{value:.decimals$}")
    })
}

/// Two to five marks on the axis of values, at multiples of 1, 2 or 5 times a power of ten.
fn marks(GridInput { bounds: (low, high), .. }: GridInput) -> Vec<GridMark> {
    let part = ((high - low) / 3.0).max(1e-9);
    let power = 10_f64.powf(part.log10().floor());
    let step_size = [2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| *step >= part);
    let step_size = step_size.unwrap_or(part);
    let marks = (low / step_size).ceil() as i64..=(high / step_size).floor() as i64;
    marks.map(|mark| GridMark { value: mark as f64 * step_size, step_size }).collect()
}

fn legend() -> Legend {
    Legend::default().position(Corner::LeftTop).background_alpha(0.6).text_style(egui::TextStyle::Small)
}

/// The test of thesis A.
fn experiment(viewer: &mut Viewer, ui: &mut Ui) {
    ui.label(
        "A camera moves away from 100 models of 153 bones, once in a grid and once at random in a cube (Chakra 2008, section 13). \
         Each gate of bones takes its turn at each distance.",
    );
    let Viewer { experiment, .. } = viewer;
    if experiment.is_running() {
        let [done, of] = experiment.steps;
        let part = done as f32 / of.max(1) as f32;
        let left = experiment.seconds_left().map(|left| format!(", about {left:.0} s left"));
        ui.add(egui::ProgressBar::new(part).text(format!("{done} of {of}{}", left.unwrap_or_default())));
        if ui.button("Cancel").clicked() {
            experiment.cancel();
        }
    } else {
        ui.horizontal(|ui| {
            for (label, options) in [("Run", quick()), ("Run all distances", DistanceSweepOptions::default())]
            {
                if ui.button(label).clicked() {
                    viewer.start_experiment(options);
                }
            }
        });
    }
    let report = match &viewer.experiment.result {
        None => return,
        Some(Err(why)) => {
            ui.label(why);
            return;
        }
        Some(Ok(report)) => report,
    };
    for layout in &report.layouts {
        let series = |value: &dyn Fn(&SweepRow) -> Option<f64>| -> Vec<Series> {
            let of = |mode: GateName| {
                let rows = layout.rows.iter().filter(|row| row.mode == mode);
                let points = rows.filter_map(|row| Some([f64::from(row.distance), value(row)?]));
                (mode.as_str().to_owned(), points.collect())
            };
            SWEEP_MODES.into_iter().map(of).collect()
        };
        let name = layout.layout.as_str();
        sweep(
            ui,
            &format!("{name}: milliseconds of the bones' update"),
            &series(&|row| Some(row.update_milliseconds)),
        );
        if report.drawn_frames > 0 {
            sweep(ui, &format!("{name}: milliseconds of a frame"), &series(&|row| row.frame_milliseconds));
        }
        sweep(ui, &format!("{name}: bones interpolated a frame"), &series(&|row| Some(row.interpolated)));
        sweep(ui, &format!("{name}: largest error in pixels"), &series(&|row| Some(row.error.max_pixels)));
    }
    let adapter = if report.adapter.is_empty() { String::new() } else { format!("{} · ", report.adapter) };
    ui.small(format!("{adapter}distances in units of 1/{} of the model", report.size));
    if ui.button("Save report").clicked()
        && let Ok(bytes) = serde_json::to_vec_pretty(report)
    {
        viewer.request(Request::Save { name: "sweep.json".to_owned(), bytes });
    }
}

/// A plot against distance.
fn sweep(ui: &mut Ui, title: &str, series: &[Series]) {
    ui.label(egui::RichText::new(title).small());
    let far = series.iter().flat_map(|(_, points)| points).map(|[distance, _]| *distance).fold(0.0, f64::max);
    let plot = Plot::new(title)
        .height(1.4 * HEIGHT)
        .custom_x_axes(vec![
            AxisHints::new_x().label("distance").label_spacing(egui::Rangef::new(20.0, 40.0)),
        ])
        // The legend lies beside the lines.
        .include_x(LEGEND * far)
        .include_y(0.0)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .custom_y_axes(vec![values()])
        .y_grid_spacer(marks)
        .legend(legend().position(Corner::RightTop));
    plot.show(ui, |ui| {
        for ((name, points), color) in series.iter().zip(SERIES) {
            ui.line(Line::new(name.clone(), PlotPoints::from(points.clone())).color(color).width(1.5));
        }
    });
}

/// The options of an experiment that takes little time: some distances with few frames.
fn quick() -> DistanceSweepOptions {
    DistanceSweepOptions {
        distances: vec![0.0, 400.0, 900.0, 1400.0, 1800.0, 2400.0],
        frames: 8,
        error_frames: 3,
        drawn_frames: 2,
        measured: 8,
        ..DistanceSweepOptions::default()
    }
}
