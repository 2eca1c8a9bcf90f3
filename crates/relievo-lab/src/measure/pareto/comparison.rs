//! Compares the curves of error against cost of the gates.

use serde::Serialize;

use crate::measure::gates::GateName;
use crate::measure::pareto::ParetoPoint;

/// The gates that the others are compared with.
const RIVALS: [GateName; 2] = [GateName::Uniform, GateName::Random];

/// Comparisons along curves. A curve gives the least error that a gate reached at a cost or below it, and
/// interpolates between its points by the error's logarithm; full evaluation, with cost 1 and error 0, ends
/// every curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparisons {
    /// The largest error of the bounded gate and its rivals at equal cost.
    pub bounded_max_pixels: Vec<AtCost>,
    /// The root-mean-square error of the budget gate and its rivals at equal cost.
    pub budget_rms_pixels: Vec<AtCost>,
    /// The costs of the bounded gate and of uniform updates at equal largest error; the errors are those of
    /// uniform updates every 2, 3, … frames.
    pub bounded_cost: Vec<AtError>,
}

/// Errors in pixels at equal cost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AtCost {
    /// The share of the animated bones that are interpolated, 0 to 1.
    pub cost: f64,
    /// The error of the gate in pixels.
    pub gate: f64,
    /// The error of uniform updates in pixels.
    pub uniform: f64,
    /// The error of random updates in pixels.
    pub random: f64,
    /// The gate's error divided by the lesser of its rivals'; below 1 the gate is better.
    pub ratio: Option<f64>,
}

/// Costs at equal largest error. A cost is the share of the animated bones that are interpolated, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AtError {
    /// The error in pixels.
    pub max_pixels: f64,
    /// The cost of uniform updates.
    pub uniform: f64,
    /// The cost of the bounded gate.
    pub bounded: f64,
    /// The cost of the bounded gate divided by that of uniform updates; below 1 the bounded gate is cheaper.
    pub ratio: f64,
}

impl Comparisons {
    pub(crate) fn new(points: &[ParetoPoint]) -> Self {
        let largest = |point: &ParetoPoint| point.error.max_pixels;
        Self {
            bounded_max_pixels: at_costs(points, GateName::Bounded, largest),
            budget_rms_pixels: at_costs(points, GateName::Budget, |point| point.error.rms_pixels),
            bounded_cost: at_errors(points),
        }
    }
}

fn at_costs(points: &[ParetoPoint], name: GateName, error: fn(&ParetoPoint) -> f64) -> Vec<AtCost> {
    let curve = |name: GateName| Curve::of(points, name, error);
    let own = curve(name);
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

fn at_errors(points: &[ParetoPoint]) -> Vec<AtError> {
    let bounded = Curve::of(points, GateName::Bounded, |point| point.error.max_pixels);
    let is_whole = |point: &&ParetoPoint| {
        let frames = point.parameter.recip();
        point.gate == GateName::Uniform
            && (frames - frames.round()).abs() < 1e-9
            && point.error.max_pixels > 0.0
    };
    let at = |point: &ParetoPoint| {
        let (max_pixels, uniform) = (point.error.max_pixels, point.cost);
        let bounded = bounded.cost_at(max_pixels)?;
        Some(AtError { max_pixels, uniform, bounded, ratio: bounded / uniform })
    };
    points.iter().filter(is_whole).filter_map(at).collect()
}

/// Points of cost and error: costs ascend, errors descend.
struct Curve(Vec<[f64; 2]>);

impl Curve {
    fn of(points: &[ParetoPoint], name: GateName, error: fn(&ParetoPoint) -> f64) -> Self {
        let own = points.iter().filter(|point| point.gate == name);
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

    /// The error at a cost; `None` below the curve's least cost.
    fn error_at(&self, cost: f64) -> Option<f64> {
        let after = self.0.partition_point(|point| point[0] <= cost);
        let before = self.0.get(after.checked_sub(1)?)?;
        let Some(after) = self.0.get(after) else { return Some(before[1]) };
        Some(between(before[1], after[1], (cost - before[0]) / (after[0] - before[0])))
    }

    /// The least cost at which the error is reached; `None` if every point of the curve is better.
    fn cost_at(&self, error: f64) -> Option<f64> {
        let after = self.0.partition_point(|point| point[1] > error);
        let (before, after) = (self.0.get(after.checked_sub(1)?)?, self.0.get(after)?);
        // Bisection finds the cost, as errors descend from one point to the next.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if between(before[1], after[1], middle) > error { low = middle } else { high = middle }
        }
        Some(before[0] + high * (after[0] - before[0]))
    }
}

/// Interpolates between two errors: by their logarithms if both are above 0, else linearly.
fn between(a: f64, b: f64, weight: f64) -> f64 {
    if a > 0.0 && b > 0.0 { a * (b / a).powf(weight) } else { a + (b - a) * weight }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_envelopes_and_interpolated() {
        // The third point has a larger error and a higher cost than the second, so the curve leaves it out.
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
}
