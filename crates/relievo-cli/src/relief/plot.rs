//! The plot of `relievo relief --compare`.

use image::RgbaImage;
use relievo::InputError;
use relievo::ops::surface::ReliefMethod;
use relievo_lab::measure::relief::Comparison;
use relievo_lab::measure::relief::Measured;
use relievo_lab::plot::{Chart, Series, grid};

/// Draws one panel per angle.
pub fn plot(comparison: &Comparison) -> Result<RgbaImage, InputError> {
    let chart = |angle: f64| {
        let series = ReliefMethod::ALL.into_iter().map(|method| {
            let all = comparison.entries.iter();
            let here = all.filter(move |entry| entry.angle == angle && entry.method == method);
            let point = |measured: Measured| (measured.mean_samples, measured.mean_error_texels);
            Series {
                name: method.name().to_owned(),
                points: here.clone().map(|entry| point(entry.measured)).collect(),
                labels: here.filter_map(|entry| entry.steps.map(|steps| steps.to_string())).collect(),
            }
        });
        Chart {
            title: format!("{angle}°"),
            x_label: "texel loads a pixel".to_owned(),
            y_label: "mean error in texels".to_owned(),
            log_x: true,
            log_y: true,
            series: series.collect(),
        }
    };
    let title = "Error against cost, by angle from the normal (labels: linear steps)";
    grid(title, &Comparison::ANGLES.map(chart), 2, [1200, 900])
}
