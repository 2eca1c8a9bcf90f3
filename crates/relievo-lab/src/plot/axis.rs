//! The axis of a chart: the positions of values on it, and the values that are labelled.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// Margin below the least and above the largest value, as a share of the axis.
const MARGIN: f64 = 0.04;

/// Distance on a logarithmic axis between the least value above zero and the position of zero, in decades.
const ZERO_GAP: f64 = 0.5;

/// A linear or logarithmic axis. Positions on it are the values, or their decadic logarithms.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    log: bool,
    /// The lowest and the highest position.
    pub range: [f64; 2],
    /// The position at which a logarithmic axis draws zero, if there are such values.
    zero: Option<f64>,
    /// The positions that have a label.
    pub ticks: Vec<f64>,
    /// The positions that have a thin line.
    minor: Vec<f64>,
}

impl Axis {
    /// Makes an axis that shows all finite values of `values`. A logarithmic axis draws values that are not
    /// above zero at its lower end.
    pub fn new(values: impl Iterator<Item = f64> + Clone, log: bool) -> Self {
        let shown = || values.clone().filter(|value| value.is_finite() && (!log || *value > 0.0));
        let least = shown().fold(f64::INFINITY, f64::min);
        let most = shown().fold(f64::NEG_INFINITY, f64::max);
        let [least, most] = if least <= most { [least, most] } else { [1.0, 1.0] };
        if log {
            let zero = values.clone().any(|value| value <= 0.0);
            Self::logarithmic(least.log10(), most.log10(), zero)
        } else {
            Self::linear(least.min(0.0), most.max(0.0))
        }
    }

    fn linear(least: f64, most: f64) -> Self {
        let span = if most > least { most - least } else { 1.0 };
        let step = round_step(span / 6.0);
        let range = [if least < 0.0 { least - MARGIN * span } else { 0.0 }, least + span * (1.0 + MARGIN)];
        let ticks = multiples(step, range);
        Self { log: false, range, zero: None, ticks, minor: Vec::new() }
    }

    fn logarithmic(least: f64, most: f64, zero: bool) -> Self {
        let span = (most - least).max(0.5);
        let bottom = least - MARGIN * span;
        let zero = zero.then_some(bottom - ZERO_GAP * (span / 4.0).clamp(0.25, 1.0));
        let range = [zero.unwrap_or(bottom), least + span * (1.0 + MARGIN)];
        let shown = [bottom, range[1]];
        let digits = |digits: &[f64]| -> Vec<f64> {
            let decades = multiples(1.0, [shown[0] - 1.0, shown[1]]);
            let positions =
                decades.iter().flat_map(|decade| digits.iter().map(move |digit| decade + digit.log10()));
            positions.filter(|position| (shown[0]..=shown[1]).contains(position)).collect()
        };
        let mut ticks = if span < 1.2 {
            digits(&[1.0, 2.0, 3.0, 5.0])
        } else if span < 2.5 {
            digits(&[1.0, 3.0])
        } else {
            multiples((span / 7.0).ceil(), shown)
        };
        ticks.extend(zero);
        let minor = if span < 6.0 {
            digits(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0])
        } else {
            multiples(1.0, shown)
        };
        Self { log: true, range, zero, ticks, minor }
    }

    /// The position of a value; `None` if the value is not finite.
    pub fn position(&self, value: f64) -> Option<f64> {
        match self.log {
            _ if !value.is_finite() => None,
            true if self.is_zero(value) => self.zero,
            true => Some(value.log10()),
            false => Some(value),
        }
    }

    /// Whether a value is drawn at the position of zero because it has no logarithm.
    pub fn is_zero(&self, value: f64) -> bool {
        self.log && value <= 0.0
    }

    /// The label at a position.
    pub fn label(&self, position: f64) -> String {
        if self.zero == Some(position) {
            return "0".to_owned();
        }
        let value = if self.log { 10.0_f64.powf(position) } else { position };
        number(value)
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, position: &f64, (start, end): (i32, i32)) -> i32 {
        let fraction = (position - self.range[0]) / (self.range[1] - self.range[0]);
        start + (fraction * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { self.minor.clone() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.range[0]..self.range[1]
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, position: &f64) -> String {
        self.label(*position)
    }
}

/// Formats a number with at most three significant digits.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    match rounded.abs() {
        size if size < 1e-12 => "0".to_owned(),
        size if (1e-3..1e5).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

/// The least of 1, 2, 5, 10, 20, … that is not below `step`.
fn round_step(step: f64) -> f64 {
    let decade = 10.0_f64.powf(step.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|digit| digit * decade).find(|round| *round >= step).unwrap_or(step)
}

/// The multiples of `step` in a range.
fn multiples(step: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|index| index as f64 * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(values: &[f64], log: bool) -> Vec<String> {
        let axis = Axis::new(values.iter().copied(), log);
        axis.ticks.iter().map(|tick| axis.label(*tick)).collect()
    }

    #[test]
    fn linear_axes_start_at_zero_and_have_round_ticks() {
        assert_eq!(labels(&[3.0, 11.5], false), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(&[0.02, 0.1], false), ["0", "0.02", "0.04", "0.06", "0.08", "0.1"]);
        assert_eq!(labels(&[-1.0, 1.0], false), ["-1", "-0.5", "0", "0.5", "1"]);
    }

    #[test]
    fn logarithmic_axes_have_decades_and_a_position_for_zero() {
        assert_eq!(labels(&[0.004, 30.0], true), ["0.01", "0.1", "1", "10"]);
        assert_eq!(labels(&[0.0, 0.004, 30.0], true), ["0.01", "0.1", "1", "10", "0"]);
        assert_eq!(labels(&[9.0, 60.0], true), ["10", "20", "30", "50"]);
        assert_eq!(
            labels(&[1e-9, 1e6], true),
            ["1e-9", "1e-6", "0.001", "1", "1e3", "1e6"].map(|label| if label == "1e3" {
                "1000"
            } else {
                label
            })
        );
    }

    #[test]
    fn positions_lie_within_the_range_and_ascend() {
        let values = [0.0, 1e-4, 0.3, 1.0, 77.0];
        for log in [false, true] {
            let axis = Axis::new(values.into_iter().chain([f64::NAN, f64::INFINITY]), log);
            let positions = values.map(|value| axis.position(value).expect("a position"));
            assert!(positions.is_sorted_by(|a, b| a < b), "{positions:?}");
            assert!(
                positions
                    .iter()
                    .chain(&axis.ticks)
                    .all(|position| (axis.range[0]..=axis.range[1]).contains(position))
            );
            assert_eq!(axis.position(f64::NAN), None);
            assert_eq!(axis.is_zero(0.0), log);
        }
        assert_eq!(
            Axis::new([0.0, 1.0].into_iter(), true).position(0.0),
            Some(Axis::new([0.0, 1.0].into_iter(), true).range[0])
        );
    }

    #[test]
    fn axes_without_values_or_with_one_are_axes() {
        for values in [&[][..], &[0.0], &[5.0], &[f64::NAN]] {
            for log in [false, true] {
                let axis = Axis::new(values.iter().copied(), log);
                assert!(
                    axis.range[0] < axis.range[1] && axis.range.iter().all(|end| end.is_finite()),
                    "{axis:?}"
                );
                assert!(!axis.ticks.is_empty(), "{axis:?}");
            }
        }
    }
}
