//! Draws charts by plotters.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::plot::axis::Axis;
use crate::plot::letters::{Align, Drawn, Letters};
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

type Area<'a> = DrawingArea<BitMapBackend<'a>, Shift>;
type Plane<'a> = DrawingArea<BitMapBackend<'a>, Cartesian2d<Axis, Axis>>;

/// The drawing state that all panels share.
pub struct Picture<'a> {
    charts: &'a [Chart],
    names: Vec<&'a str>,
    axes: [Axis; 2],
    letters: Letters,
    /// Size of ordinary text in fine pixels; all other sizes are derived from it.
    text: i32,
}

impl<'a> Picture<'a> {
    pub fn new(charts: &'a [Chart], size: (u32, u32)) -> Self {
        let mut names: Vec<&str> = Vec::new();
        for series in charts.iter().flat_map(|chart| &chart.series) {
            if !names.contains(&series.name.as_str()) {
                names.push(&series.name);
            }
        }
        let text = (size.0.min(size.1) / 60).clamp(12, 22) * FINER;
        Self { charts, names, axes: Chart::axes(charts), letters: Letters::new(), text: text as i32 }
    }

    pub fn draw<'b>(&self, title: &str, panels: (usize, usize), backend: BitMapBackend<'b>) -> Drawn<'b> {
        let area = backend.into_drawing_area();
        let (width, height) = area.dim_in_pixel();
        let top = if title.is_empty() { 0 } else { 2 * self.text };
        self.write(&area, title, (width as i32 / 2, self.text * 5 / 4), (1.3, Align::Center), INK)?;
        let legend = self.legend(width as i32);
        let (upper, lower) = area.split_vertically(height as i32 - 2 * self.text * legend.len() as i32);
        let (_, middle) = upper.split_vertically(top);
        for (chart, panel) in self.charts.iter().zip(middle.split_evenly(panels)) {
            self.panel(chart, &panel, &area)?;
        }
        for (line, entries) in legend.iter().enumerate() {
            for (index, left) in entries {
                self.entry(*index, (*left, 2 * self.text * line as i32 + self.text * 3 / 4), &lower)?;
            }
        }
        area.present()
    }

    fn write<'b>(
        &self,
        area: &Area<'b>,
        text: &str,
        position: (i32, i32),
        (fraction, align): (f64, Align),
        color: RGBColor,
    ) -> Drawn<'b> {
        self.letters.write(area, text, position, (fraction * f64::from(self.text), align, false), color)
    }

    /// The lines of the legend: for each entry the index of its name and its horizontal position.
    fn legend(&self, width: i32) -> Vec<Vec<(usize, i32)>> {
        let mut lines: Vec<Vec<(usize, i32)>> = Vec::new();
        let mut left = width;
        for (index, name) in self.names.iter().enumerate() {
            let room = 5 * self.text + self.letters.width(name, f64::from(self.text));
            if left + room > width {
                lines.push(Vec::new());
                left = self.text;
            }
            if let Some(line) = lines.last_mut() {
                line.push((index, left));
            }
            left += room;
        }
        lines
    }

    fn entry<'b>(&self, index: usize, (x, y): (i32, i32), area: &Area<'b>) -> Drawn<'b> {
        let middle = x + self.text;
        area.draw(&PathElement::new([(x, y), (middle + self.text, y)], self.stroke(index)))?;
        self.mark(index, true, (middle, y), area)?;
        let position = (middle + self.text * 3 / 2, y);
        self.write(area, self.names[index], position, (1.0, Align::Left), INK)
    }

    fn panel<'b>(&self, chart: &Chart, area: &Area<'b>, whole: &Area<'b>) -> Drawn<'b> {
        let [x, y] = &self.axes;
        let mut panel = ChartBuilder::on(area)
            .margin_top(if chart.title.is_empty() { self.text } else { 2 * self.text })
            .margin_right(self.text * 3 / 2)
            .margin_bottom(self.text * 7 / 2)
            .margin_left(self.text * 11 / 2)
            .build_cartesian_2d(x.clone(), y.clone())?;
        let mut mesh = panel.configure_mesh();
        mesh.disable_axes().bold_line_style(GRID.stroke_width(FINER)).light_line_style(FAINT.stroke_width(1));
        mesh.draw()?;
        let plane = panel.plotting_area();
        self.frame(chart, plane, whole)?;
        for series in &chart.series {
            let positions =
                series.points.iter().filter_map(|point| self.position(*point)).collect::<Vec<_>>();
            plane.draw(&PathElement::new(positions, self.stroke(self.index(&series.name))))?;
        }
        self.points(chart, plane, whole)
    }

    /// Draws the axes, their labels and the title.
    fn frame<'b>(&self, chart: &Chart, plane: &Plane<'b>, whole: &Area<'b>) -> Drawn<'b> {
        let [x, y] = &self.axes;
        let (columns, rows) = plane.get_pixel_range();
        let line = INK.stroke_width(FINER);
        let corners = [(columns.start, rows.start), (columns.start, rows.end), (columns.end, rows.end)];
        whole.draw(&PathElement::new(corners, line))?;
        let (gap, tick) = (self.text / 2, self.text / 4);
        for position in &x.ticks {
            let (at, _) = plane.map_coordinate(&(*position, y.range[0]));
            whole.draw(&PathElement::new([(at, rows.end), (at, rows.end + tick)], line))?;
            let below = (at, rows.end + 2 * gap);
            self.write(whole, &x.label(*position), below, (0.85, Align::Center), INK)?;
        }
        for position in &y.ticks {
            let (_, at) = plane.map_coordinate(&(x.range[0], *position));
            whole.draw(&PathElement::new([(columns.start - tick, at), (columns.start, at)], line))?;
            let beside = (columns.start - gap, at);
            self.write(whole, &y.label(*position), beside, (0.85, Align::Right), INK)?;
        }
        let middle = ((columns.start + columns.end) / 2, (rows.start + rows.end) / 2);
        let (above, below) = (rows.start - self.text, rows.end + self.text * 5 / 2);
        self.write(whole, &chart.title, (middle.0, above), (1.1, Align::Center), INK)?;
        self.write(whole, &chart.x_label, (middle.0, below), (0.95, Align::Center), INK)?;
        let size = 0.95 * f64::from(self.text);
        let beside = (columns.start - self.text * 9 / 2, middle.1);
        self.letters.write(whole, &chart.y_label, beside, (size, Align::Center, true), INK)
    }

    /// Draws the marks, and then their labels, so that no mark covers a label.
    fn points<'b>(&self, chart: &Chart, plane: &Plane<'b>, whole: &Area<'b>) -> Drawn<'b> {
        let [x, y] = &self.axes;
        for series in &chart.series {
            for point in &series.points {
                let Some(position) = self.position(*point) else { continue };
                let filled = !x.is_zero(point.0) && !y.is_zero(point.1);
                self.mark(self.index(&series.name), filled, plane.map_coordinate(&position), whole)?;
            }
        }
        for series in &chart.series {
            for (point, label) in series.points.iter().zip(&series.labels) {
                let Some(position) = self.position(*point) else { continue };
                let (x, y) = plane.map_coordinate(&position);
                let beside = (x + self.text * 2 / 5, y - self.text * 3 / 5);
                self.write(whole, label, beside, (0.75, Align::Left), color(self.index(&series.name)))?;
            }
        }
        Ok(())
    }

    fn index(&self, name: &str) -> usize {
        self.names.iter().position(|other| *other == name).unwrap_or(0)
    }

    fn position(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        Some((self.axes[0].position(x)?, self.axes[1].position(y)?))
    }

    fn stroke(&self, index: usize) -> ShapeStyle {
        color(index).stroke_width(2 * FINER)
    }

    /// Draws the mark of a series around a pixel; each series has its own shape and colour. Hollow marks are
    /// white inside.
    fn mark<'b>(&self, index: usize, filled: bool, position: (i32, i32), area: &Area<'b>) -> Drawn<'b> {
        let shape = SHAPES[index % SHAPES.len()];
        // Triangles are smaller than other shapes in the same circle.
        let radius = f64::from(self.text) * if shape.0 == 3 { 0.58 } else { 0.46 };
        fill(area, shape, position, radius, color(index))?;
        if filled { Ok(()) } else { fill(area, shape, position, 0.55 * radius, WHITE) }
    }
}

/// Fills a regular polygon. Plotters would round its corners to whole pixels, which shows in shapes as small
/// as marks.
fn fill<'b>(
    area: &Area<'b>,
    (sides, turn): (u32, f64),
    (x, y): (i32, i32),
    radius: f64,
    color: RGBColor,
) -> Drawn<'b> {
    let half = std::f64::consts::PI / f64::from(sides);
    let edges: Vec<_> = (0..sides)
        .map(|side| (turn.to_radians() + half * f64::from(2 * side + 1)).sin_cos())
        .map(|(sin, cos)| [cos, sin])
        .collect();
    let inside = |dx: i32, dy: i32| {
        edges.iter().all(|edge| edge[0] * f64::from(dx) + edge[1] * f64::from(dy) <= radius * half.cos())
    };
    let reach = radius.ceil() as i32;
    for (dx, dy) in (-reach..=reach).flat_map(|dx| (-reach..=reach).map(move |dy| (dx, dy))) {
        if inside(dx, dy) {
            area.draw_pixel((x + dx, y + dy), &color)?;
        }
    }
    Ok(())
}

fn color(index: usize) -> RGBColor {
    COLORS[index % COLORS.len()]
}
