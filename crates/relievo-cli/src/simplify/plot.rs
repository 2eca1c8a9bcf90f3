//! The plot of `relievo simplify --compare`.

use std::path::Path;

use image::RgbaImage;
use relievo::InputError;
use relievo_lab::measure::reduction::{ReducerComparison, ReducerLevel};
use relievo_lab::plot::{Chart, Series, grid};

/// Draws a panel for the root mean square, and one for the largest distance.
pub fn plot(comparison: &ReducerComparison) -> Result<RgbaImage, InputError> {
    let chart = |title: &str, error: fn(&ReducerLevel) -> f64| Chart {
        title: title.to_owned(),
        x_label: "triangles".to_owned(),
        y_label: "distance in the model's units".to_owned(),
        log_x: true,
        log_y: true,
        series: (comparison.reducers.iter())
            .map(|row| {
                let point = |level: &ReducerLevel| (level.triangles as f64, error(level));
                Series::new(row.reducer, row.levels.iter().map(point).collect())
            })
            .collect(),
    };
    let charts =
        [chart("root mean square", |level| level.error_rms), chart("largest", |level| level.error_max)];
    let model = Path::new(&comparison.model).file_name().unwrap_or_default().to_string_lossy();
    let title = format!("Distance between {model} and its levels, by reducer");
    grid(&title, &charts, 2, [1200, 560])
}
