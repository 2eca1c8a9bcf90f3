//! Draws charts by plotters.

use std::error::Error;
use std::f64::consts::TAU;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::plot::axis::Axis;
use crate::plot::letters::{register, style};
use crate::plot::{Chart, FINER};

const INK: RGBColor = RGBColor(40, 40, 40);
const GRID: RGBColor = RGBColor(205, 205, 205);
const FAINT: RGBColor = RGBColor(236, 236, 236);

/// Colours that people with colour vision deficiencies can distinguish (Okabe and Ito 2008), without the
/// yellow.
pub const COLORS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(60, 60, 60),
    RGBColor(150, 40, 40),
];

/// Regular polygons: number of corners, and the direction of the first corner in degrees clockwise from the
/// right.
const SHAPES: [(u32, f64); 8] =
    [(24, 0.0), (4, 45.0), (3, -90.0), (4, 0.0), (3, 90.0), (6, 0.0), (5, -90.0), (3, 0.0)];

/// For each entry the index of its name and its horizontal position.
type LegendLine = Vec<(usize, i32)>;

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn Error>>;

/// The drawing state that all panels share.
pub struct Picture<'a> {
    charts: &'a [Chart],
    names: Vec<&'a str>,
    axes: [Axis; 2],
    /// Size of ordinary text in fine pixels; all other sizes are derived from it.
    text: i32,
}

impl<'a> Picture<'a> {
    pub fn new(charts: &'a [Chart], size: [u32; 2]) -> Self {
        register();
        let mut names: Vec<&str> = Vec::new();
        for series in charts.iter().flat_map(|chart| &chart.series) {
            if !names.contains(&series.name.as_str()) {
                names.push(&series.name);
            }
        }
        let text = (size[0].min(size[1]) / 60).clamp(12, 22) * FINER;
        Self { charts, names, axes: Chart::axes(charts), text: text as i32 }
    }

    pub fn draw(&self, title: &str, rows: usize, columns: usize, backend: BitMapBackend<'_>) -> Drawn {
        let area = backend.into_drawing_area();
        let (width, height) = area.dim_in_pixel();
        let top = if title.is_empty() { 0 } else { 2 * self.text };
        let middle = (width as i32 / 2, self.text * 5 / 4);
        area.draw(&Text::new(title, middle, self.style(1.3, HPos::Center, INK)))?;
        let legend = self.legend(&area, width as i32)?;
        let (upper, lower) = area.split_vertically(height as i32 - 2 * self.text * legend.len() as i32);
        let (_, middle) = upper.split_vertically(top);
        for (chart, panel) in self.charts.iter().zip(middle.split_evenly((rows, columns))) {
            self.panel(chart, &panel, &area)?;
        }
        for (line, entries) in legend.iter().enumerate() {
            for (index, left) in entries {
                self.entry(*index, *left, 2 * self.text * line as i32 + self.text * 3 / 4, &lower)?;
            }
        }
        Ok(area.present()?)
    }

    fn style(&self, fraction: f64, side: HPos, color: RGBColor) -> TextStyle<'static> {
        style(fraction * f64::from(self.text), side, color)
    }

    /// The lines of the legend.
    fn legend(&self, area: &Area<'_>, width: i32) -> Result<Vec<LegendLine>, Box<dyn Error>> {
        let mut lines: Vec<LegendLine> = Vec::new();
        let mut left = width;
        for (index, name) in self.names.iter().enumerate() {
            let (own, _) = area.estimate_text_size(name, &self.style(1.0, HPos::Left, INK))?;
            let room = 5 * self.text + own as i32;
            if left + room > width {
                lines.push(Vec::new());
                left = self.text;
            }
            if let Some(line) = lines.last_mut() {
                line.push((index, left));
            }
            left += room;
        }
        Ok(lines)
    }

    fn entry(&self, index: usize, x: i32, y: i32, area: &Area<'_>) -> Drawn {
        let middle = x + self.text;
        area.draw(&PathElement::new([(x, y), (middle + self.text, y)], stroke(index)))?;
        self.mark(index, true, middle, y, area)?;
        let position = (middle + self.text * 3 / 2, y);
        Ok(area.draw(&Text::new(self.names[index], position, self.style(1.0, HPos::Left, INK)))?)
    }

    fn panel(&self, chart: &Chart, area: &Area<'_>, whole: &Area<'_>) -> Drawn {
        let [x, y] = &self.axes;
        let mut panel = ChartBuilder::on(area);
        panel.margin_top(self.text / 2).margin_right(self.text * 3 / 2).margin_left(self.text / 2);
        panel.x_label_area_size(self.text * 7 / 2).y_label_area_size(self.text * 5);
        if !chart.title.is_empty() {
            panel.caption(&chart.title, self.style(1.1, HPos::Center, INK));
        }
        let mut panel = panel.build_cartesian_2d(x.clone(), y.clone())?;
        let mut mesh = panel.configure_mesh();
        mesh.bold_line_style(GRID.stroke_width(FINER)).light_line_style(FAINT.stroke_width(1));
        mesh.axis_style(INK.stroke_width(FINER)).set_all_tick_mark_size(self.text / 4);
        mesh.label_style(self.style(0.85, HPos::Center, INK)).axis_desc_style(self.style(
            0.95,
            HPos::Center,
            INK,
        ));
        mesh.x_desc(&chart.x_label).y_desc(&chart.y_label).draw()?;
        let plane = panel.plotting_area();
        let pixel = |(a, b): (f64, f64)| Some(plane.map_coordinate(&(x.position(a)?, y.position(b)?)));
        for series in &chart.series {
            let points: Vec<_> = series.points.iter().filter_map(|point| pixel(*point)).collect();
            whole.draw(&PathElement::new(points, stroke(self.index(&series.name))))?;
        }
        for series in &chart.series {
            for point in &series.points {
                let filled = !x.is_zero(point.0) && !y.is_zero(point.1);
                if let Some((x, y)) = pixel(*point) {
                    self.mark(self.index(&series.name), filled, x, y, whole)?;
                }
            }
        }
        // The labels of marks come after all marks, so that no mark covers one.
        for series in &chart.series {
            let style = self.style(0.75, HPos::Left, color(self.index(&series.name)));
            for (point, label) in series.points.iter().zip(&series.labels) {
                if let Some((x, y)) = pixel(*point) {
                    let beside = (x + self.text * 2 / 5, y - self.text * 3 / 5);
                    whole.draw(&Text::new(label.as_str(), beside, style.clone()))?;
                }
            }
        }
        Ok(())
    }

    fn index(&self, name: &str) -> usize {
        self.names.iter().position(|other| *other == name).unwrap_or(0)
    }

    /// Draws the mark of a series around a pixel; each series has its own shape and colour. Hollow marks are
    /// white inside.
    fn mark(&self, index: usize, filled: bool, x: i32, y: i32, area: &Area<'_>) -> Drawn {
        let (sides, turn) = SHAPES[index % SHAPES.len()];
        // Triangles are smaller than other shapes in the same circle.
        let radius = f64::from(self.text) * if sides == 3 { 0.58 } else { 0.46 };
        let polygon = |radius: f64, color: RGBColor| {
            let corner = |side: u32| {
                let (sin, cos) = (turn.to_radians() + TAU * f64::from(side) / f64::from(sides)).sin_cos();
                (x + (radius * cos).round() as i32, y + (radius * sin).round() as i32)
            };
            Polygon::new((0..sides).map(corner).collect::<Vec<_>>(), color.filled())
        };
        area.draw(&polygon(radius, color(index)))?;
        if !filled {
            area.draw(&polygon(0.55 * radius, WHITE))?;
        }
        Ok(())
    }
}

fn stroke(index: usize) -> ShapeStyle {
    color(index).stroke_width(2 * FINER)
}

fn color(index: usize) -> RGBColor {
    COLORS[index % COLORS.len()]
}
