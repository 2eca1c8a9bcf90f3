//! Draws charts as pictures: series of points against two axes, linear or logarithmic, one chart or a grid of
//! them.

use axis::Axis;
use image::{DynamicImage, RgbImage, RgbaImage};
use picture::Picture;
use plotters::backend::BitMapBackend;
use relievo::InputError;
pub use strip::strip;

mod axis;
mod letters;
mod picture;
mod strip;

/// Number of pixels that are drawn for each pixel of the picture, along each axis: plotters does not
/// antialias polygons.
const FINER: u32 = 3;

/// The least width and height of a panel, in pixels.
const LEAST: [u32; 2] = [240, 180];

/// A series of points, which are joined by lines in their order.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// The name in the legend. Series of one name look alike in every panel.
    pub name: String,
    /// Points (x, y). A point that is not finite is left out; one without a logarithm is drawn hollow at the
    /// axis's low end.
    pub points: Vec<(f64, f64)>,
    /// Texts beside the points, in the order of the points; there may be fewer.
    pub labels: Vec<String>,
}

impl Series {
    /// A series without texts.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points, labels: Vec::new() }
    }
}

/// A chart of several series against two axes.
#[derive(Debug, Clone, Default)]
pub struct Chart {
    /// The title above the chart.
    pub title: String,
    /// The label below the x axis.
    pub x_label: String,
    /// The label beside the y axis.
    pub y_label: String,
    /// Whether the x axis is logarithmic.
    pub log_x: bool,
    /// Whether the y axis is logarithmic.
    pub log_y: bool,
    /// The series that the chart shows.
    pub series: Vec<Series>,
}

impl Chart {
    fn axes(charts: &[Self]) -> [Axis; 2] {
        let points = || charts.iter().flat_map(|chart| &chart.series).flat_map(|series| &series.points);
        let log = |of: fn(&Self) -> bool| charts.first().is_some_and(of);
        [
            Axis::new(points().map(|point| point.0), log(|chart| chart.log_x)),
            Axis::new(points().map(|point| point.1), log(|chart| chart.log_y)),
        ]
    }
}

/// Draws charts in rows of `columns`, under one title and above one legend. All have the same axes, which are
/// logarithmic if those of the first chart are.
///
/// # Errors
/// [`InputError`] for 0 columns, and for a size at which nothing could be read.
pub fn grid(title: &str, charts: &[Chart], columns: usize, size: [u32; 2]) -> Result<RgbaImage, InputError> {
    if columns == 0 {
        return Err(InputError::new("columns", columns, "must be at least 1"));
    }
    let rows = charts.len().div_ceil(columns).max(1);
    let least = [LEAST[0] * columns as u32, LEAST[1] * rows as u32];
    for (field, edge, least) in [("size[0]", size[0], least[0]), ("size[1]", size[1], least[1])] {
        if !(least..=16_384).contains(&edge) {
            return Err(InputError::new(field, edge, format!("must be in {least}..=16384 pixels")));
        }
    }
    let [width, height] = size.map(|edge| edge * FINER);
    let mut pixels = vec![u8::MAX; 3 * width as usize * height as usize];
    let failed = |reason: String| InputError::new("chart", title, reason);
    Picture::new(charts, size)
        .draw(title, rows, columns, BitMapBackend::with_buffer(&mut pixels, (width, height)))
        .map_err(|error| failed(error.to_string()))?;
    let fine = RgbImage::from_raw(width, height, pixels).ok_or_else(|| failed("has no pixels".to_owned()))?;
    let picture = image::imageops::thumbnail(&fine, size[0], size[1]);
    Ok(DynamicImage::ImageRgb8(picture).into_rgba8())
}

#[cfg(test)]
mod tests {
    use plotters::style::RGBColor;

    use super::*;
    use picture::COLORS;

    fn series(name: &str, points: &[(f64, f64)]) -> Series {
        Series::new(name, points.to_vec())
    }

    fn draw(chart: Chart, size: [u32; 2]) -> Result<RgbaImage, InputError> {
        grid("", &[chart], 1, size)
    }

    /// The mean position and the number of the pixels near a colour.
    fn middle(image: &RgbaImage, color: RGBColor, rows: std::ops::Range<u32>) -> (f64, f64, usize) {
        let near = |pixel: &image::Rgba<u8>| {
            [color.0, color.1, color.2].into_iter().zip(pixel.0).all(|(a, b)| a.abs_diff(b) < 12)
        };
        let found: Vec<_> = (image.enumerate_pixels())
            .filter(|(_, y, pixel)| rows.contains(y) && near(pixel))
            .map(|(x, y, _)| (f64::from(x), f64::from(y)))
            .collect();
        let count = found.len().max(1) as f64;
        let sum = found.iter().fold((0.0, 0.0), |sum, at| (sum.0 + at.0, sum.1 + at.1));
        (sum.0 / count, sum.1 / count, found.len())
    }

    #[test]
    fn points_land_where_their_values_say() {
        let single = |x: f64, y: f64| {
            let frame = series("", &[(0.0, 0.0), (10.0, 100.0)]);
            let chart =
                Chart { series: vec![frame, series("", &[]), series("p", &[(x, y)])], ..Chart::default() };
            let image = draw(chart, [600, 400]).expect("a chart");
            // The last rows of the picture are left out: the legend's mark is there.
            let (x, y, pixels) = middle(&image, COLORS[1], 0..370);
            assert!(pixels > 20, "no mark at {x}, {y}");
            (x, y)
        };
        let (origin, far, between) = (single(0.0, 0.0), single(10.0, 100.0), single(2.5, 75.0));
        assert!(origin.0 < far.0 && origin.1 > far.1, "{origin:?} {far:?}");
        assert!(
            (between.0 - (origin.0 + 0.25 * (far.0 - origin.0))).abs() < 1.5,
            "{origin:?} {far:?} {between:?}"
        );
        assert!(
            (between.1 - (origin.1 + 0.75 * (far.1 - origin.1))).abs() < 1.5,
            "{origin:?} {far:?} {between:?}"
        );
    }

    #[test]
    fn logarithms_are_evenly_spaced_and_zero_is_hollow_at_the_bottom() {
        let at = |y: f64| {
            let frame = series("f", &[(1.0, 0.0), (1.0, 0.01), (1.0, 1.0)]);
            let chart =
                Chart { log_y: true, series: vec![frame, series("p", &[(2.0, y)])], ..Chart::default() };
            middle(&draw(chart, [1200, 900]).expect("a chart"), COLORS[1], 0..850)
        };
        let [zero, low, tenth, one] = [0.0, 0.01, 0.1, 1.0].map(at);
        assert!((low.1 - tenth.1 - (tenth.1 - one.1)).abs() < 1.5, "{low:?} {tenth:?} {one:?}");
        assert!(zero.1 > low.1 + 10.0, "{zero:?} {low:?}");
        assert!(zero.2 * 3 < low.2 * 2 && zero.2 > 5, "hollow: {} of {} pixels", zero.2, low.2);
    }

    #[test]
    fn every_series_has_a_filled_mark_in_the_legend() {
        let names = ["a", "b", "c", "d", "e", "f", "g", "h"];
        let series = names.map(|name| series(name, &[(1.0, 1.0)])).to_vec();
        let image = draw(Chart { series, ..Chart::default() }, [900, 400]).expect("a chart");
        for (color, name) in COLORS.into_iter().zip(names) {
            let pixels = middle(&image, color, 375..400).2;
            assert!((45..150).contains(&pixels), "{pixels} pixels of series {name}");
        }
    }

    #[test]
    fn panels_share_colors_and_axes() {
        let chart = |names: &[&str]| Chart {
            series: names.iter().map(|name| series(name, &[(1.0, 1.0)])).collect(),
            ..Chart::default()
        };
        let image = grid("title", &[chart(&["a"]), chart(&["b"])], 2, [800, 400]).expect("charts");
        assert_eq!(image.dimensions(), (800, 400));
        let [a, b] = [0, 1].map(|index| middle(&image, COLORS[index], 0..365));
        assert!((a.1 - b.1).abs() < 1.0 && (b.0 - a.0 - 400.0).abs() < 2.0, "{a:?} {b:?}");
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_and_nothing_is_drawn_as_nothing() {
        assert_eq!(draw(Chart::default(), [100, 900]).expect_err("refused").path, "size[0]");
        assert_eq!(draw(Chart::default(), [1200, 1 << 20]).expect_err("refused").path, "size[1]");
        assert_eq!(grid("", &[], 0, [800, 600]).expect_err("refused").path, "columns");
        let odd = series("odd", &[(f64::NAN, 1.0), (1.0, f64::INFINITY), (-1.0, 2.0)]);
        for series in [vec![], vec![odd]] {
            let chart = Chart { log_x: true, series, ..Chart::default() };
            assert!(draw(chart, [300, 200]).is_ok());
        }
    }

    /// `RELIEVO_CHART=FILE cargo test a_sample` writes it.
    #[test]
    fn a_sample() {
        let methods: [(&str, f64, f64); 6] = [
            ("plain", 0.0, 9.0),
            ("parallax", 0.0, 5.0),
            ("relief", 1.0, 4.0),
            ("occlusion", 1.4, 3.0),
            ("cone", 2.2, 1.5),
            ("quadtree", f64::INFINITY, 0.0),
        ];
        let panel = |angle: f64| {
            let curve = |(name, falls, error): (&str, f64, f64)| {
                let steps = if falls == 0.0 { 1..2 } else { 2..8 };
                let points = steps.map(|step| {
                    let cost = f64::from(1 << step) * (1.0 + angle / 60.0) + 4.0;
                    let error = error * (0.1 + angle / 40.0) * f64::from(step).powf(-2.0 * falls);
                    (cost, if falls.is_finite() { error } else { 0.0 })
                });
                let points: Vec<_> =
                    if falls.is_finite() { points.collect() } else { points.take(1).collect() };
                let labels = (2..8).map(|step| (1 << step).to_string()).take(points.len());
                Series { name: name.to_owned(), labels: labels.collect(), points }
            };
            Chart {
                title: format!("{angle}°"),
                x_label: "texel loads per pixel".to_owned(),
                y_label: "mean error in texels".to_owned(),
                log_x: true,
                log_y: true,
                series: methods.map(curve).to_vec(),
            }
        };
        let charts = [0.0, 30.0, 60.0, 80.0].map(panel);
        let image = grid("Error against cost, by angle from the normal", &charts, 2, [1200, 900]);
        let image = image.expect("charts");
        for color in COLORS.into_iter().take(methods.len()) {
            assert!(middle(&image, color, 0..900).2 > 100, "{color:?} is not there");
        }
        if let Some(file) = std::env::var_os("RELIEVO_CHART") {
            image.save(file).expect("written");
        }
    }
}
