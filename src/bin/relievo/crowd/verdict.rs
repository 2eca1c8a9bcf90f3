//! Which gate is how much better.

use std::fmt::Write as _;

use serde::Serialize;

use super::gates::Mode;
use super::pareto::Point;

/// What gates are compared with.
const RIVALS: [Mode; 2] = [Mode::Uniform, Mode::Random];

/// Comparisons along curves: the least error that a gate reached at a cost or below it, interpolated between its points
/// (by the error's logarithm); full evaluation, cost 1 and error 0, ends every curve.
#[derive(Debug, Serialize)]
pub struct Verdicts {
    /// The largest error at equal cost.
    pub bounded_max_pixels: Vec<AtCost>,
    /// The rms error at equal cost.
    pub budget_rms_pixels: Vec<AtCost>,
    /// Interpolations at equal largest error, at the errors of uniform updates every 2, 3, … frames.
    pub bounded_cost: Vec<AtError>,
}

#[derive(Debug, PartialEq, Serialize)]
pub struct AtCost {
    pub cost: f64,
    pub gate: f64,
    pub uniform: f64,
    pub random: f64,
    /// The gate's error divided by the lesser of its rivals'; below 1 the gate is better.
    pub ratio: Option<f64>,
}

#[derive(Debug, PartialEq, Serialize)]
pub struct AtError {
    pub max_pixels: f64,
    pub uniform: f64,
    pub bounded: f64,
    pub ratio: f64,
}

impl Verdicts {
    pub fn new(points: &[Point]) -> Self {
        let largest = |point: &Point| point.error.max_pixels;
        Self {
            bounded_max_pixels: at_costs(points, Mode::Bounded, largest),
            budget_rms_pixels: at_costs(points, Mode::Budget, |point| point.error.rms_pixels),
            bounded_cost: at_errors(points),
        }
    }
}

fn at_costs(points: &[Point], mode: Mode, error: fn(&Point) -> f64) -> Vec<AtCost> {
    let curve = |mode: Mode| Curve::of(points, mode, error);
    let own = curve(mode);
    let [uniform, random] = RIVALS.map(curve);
    let at = |tenth: u32| {
        let cost = f64::from(tenth) / 10.0;
        let [gate, uniform, random] = [&own, &uniform, &random].map(|curve| curve.error_at(cost));
        let [gate, uniform, random] = [gate?, uniform?, random?];
        let least = uniform.min(random);
        let ratio = (least > 0.0).then(|| gate / least);
        Some(AtCost { cost, gate, uniform, random, ratio })
    };
    (1..10).filter_map(at).collect()
}

fn at_errors(points: &[Point]) -> Vec<AtError> {
    let bounded = Curve::of(points, Mode::Bounded, |point| point.error.max_pixels);
    let is_whole = |point: &&Point| {
        let frames = point.parameter.recip();
        point.gate == Mode::Uniform && (frames - frames.round()).abs() < 1e-9 && point.error.max_pixels > 0.0
    };
    let at = |point: &Point| {
        let (max_pixels, uniform) = (point.error.max_pixels, point.cost);
        let bounded = bounded.cost_at(max_pixels)?;
        Some(AtError { max_pixels, uniform, bounded, ratio: bounded / uniform })
    };
    points.iter().filter(is_whole).filter_map(at).collect()
}

/// Cost and error: costs ascend, errors fall.
struct Curve(Vec<[f64; 2]>);

impl Curve {
    fn of(points: &[Point], mode: Mode, error: fn(&Point) -> f64) -> Self {
        let own = points.iter().filter(|point| point.gate == mode);
        Self::new(own.map(|point| [point.cost, error(point)]).collect())
    }

    fn new(mut points: Vec<[f64; 2]>) -> Self {
        points.push([1.0, 0.0]);
        points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        let mut least = f64::INFINITY;
        points.retain(|point| {
            let is_less = point[1] < least;
            least = least.min(point[1]);
            is_less
        });
        Self(points)
    }

    /// Nothing below the least cost.
    fn error_at(&self, cost: f64) -> Option<f64> {
        let after = self.0.partition_point(|point| point[0] <= cost);
        let before = self.0.get(after.checked_sub(1)?)?;
        let Some(after) = self.0.get(after) else { return Some(before[1]) };
        Some(between(before[1], after[1], (cost - before[0]) / (after[0] - before[0])))
    }

    /// The least cost; nothing where every point is better.
    fn cost_at(&self, error: f64) -> Option<f64> {
        let after = self.0.partition_point(|point| point[1] > error);
        let (before, after) = (self.0.get(after.checked_sub(1)?)?, self.0.get(after)?);
        // Bisection: errors fall between the two.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if between(before[1], after[1], middle) > error { low = middle } else { high = middle }
        }
        Some(before[0] + high * (after[0] - before[0]))
    }
}

/// Between two errors, by their logarithms where they have any.
fn between(a: f64, b: f64, fraction: f64) -> f64 {
    if a > 0.0 && b > 0.0 { a * (b / a).powf(fraction) } else { a + (b - a) * fraction }
}

pub fn table(verdicts: &Verdicts) -> String {
    let mut text = String::new();
    for (name, what, rows) in [
        ("bounded", "largest error in pixels", &verdicts.bounded_max_pixels),
        ("budget", "rms error in pixels", &verdicts.budget_rms_pixels),
    ] {
        write!(
            text,
            "At equal cost, {what}:\n\n| cost | {name} | uniform | random | ratio to the better |\n"
        )
        .expect("a string");
        text += "|---:|---:|---:|---:|---:|\n";
        for AtCost { cost, gate, uniform, random, ratio } in rows {
            let ratio = ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}"));
            writeln!(text, "| {cost:.1} | {gate:.4} | {uniform:.4} | {random:.4} | {ratio} |")
                .expect("a string");
        }
        writeln!(text, "\n{}\n", sentence(name, rows)).expect("a string");
    }
    text += "At equal largest error, interpolations of moving bones:\n\n\
             | largest error px | uniform | bounded | ratio |\n|---:|---:|---:|---:|\n";
    for AtError { max_pixels, uniform, bounded, ratio } in &verdicts.bounded_cost {
        writeln!(text, "| {max_pixels:.3} | {uniform:.3} | {bounded:.3} | {ratio:.2} |").expect("a string");
    }
    let ratios: Vec<f64> = verdicts.bounded_cost.iter().map(|row| row.ratio).collect();
    if let Some([least, most]) = ends(&ratios) {
        writeln!(text, "\n`bounded` does {least:.2} to {most:.2} times the interpolations of `uniform`.")
            .expect("a string");
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
    let verdict = match worse.is_empty() {
        true => "better at every one of these costs".to_owned(),
        false => format!("not better at the costs {}", worse.join(", ")),
    };
    format!("`{name}` is {verdict}: {least:.2} to {most:.2} times the error.")
}

fn ends(values: &[f64]) -> Option<[f64; 2]> {
    let [least, most] = [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| values.iter().copied().reduce(of));
    Some([least?, most?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_envelopes_and_interpolated() {
        // The third point is worse than the second, and dearer.
        let curve = Curve::new(vec![[0.2, 4.0], [0.4, 1.0], [0.6, 2.0], [0.8, 0.25]]);
        assert_eq!(curve.0, [[0.2, 4.0], [0.4, 1.0], [0.8, 0.25], [1.0, 0.0]]);
        let near = |found: Option<f64>, expected: f64| {
            let found = found.expect("on the curve");
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        };
        near(curve.error_at(0.3), 2.0);
        near(curve.error_at(0.6), 0.5);
        near(curve.error_at(0.9), 0.125);
        near(curve.error_at(1.0), 0.0);
        assert_eq!((curve.error_at(0.1), curve.cost_at(5.0)), (None, None));
        near(curve.cost_at(2.0), 0.3);
        near(curve.cost_at(1.0), 0.4);
        near(curve.cost_at(0.5), 0.6);
        near(curve.cost_at(0.0), 1.0);
    }

    #[test]
    fn sentences_admit_defeat() {
        let row = |cost, ratio| AtCost { cost, gate: 1.0, uniform: 1.0, random: 1.0, ratio: Some(ratio) };
        assert!(sentence("x", &[row(0.1, 0.5), row(0.2, 0.9)]).contains("better at every"));
        assert!(sentence("x", &[row(0.1, 0.5), row(0.2, 1.0)]).contains("not better at the costs 0.2"));
    }
}
