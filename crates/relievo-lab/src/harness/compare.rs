//! Comparators: exact for integers, with bounds for floats, and in levels per channel for images.
//! `tests/parity.rs` shows that each fails on a planted fault.

use std::fmt::Debug;

use serde::Serialize;

/// The result of a comparison.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    /// Whether every value is within the bound.
    pub holds: bool,
    /// Number of values compared.
    pub values: usize,
    /// The largest error.
    pub error: f64,
    /// The largest error allowed.
    pub bound: f64,
    /// Unit of error and bound.
    pub unit: &'static str,
    /// Statistics of the errors and of uncertain values, where each value has a bound of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<Spread>,
    /// The values that were left out, where that is permitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_out: Option<LeftOut>,
    /// Description of the first value beyond its bound.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fault: Option<String>,
}

/// Statistics of errors of values that each have a bound of their own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Unit of the errors.
    pub unit: &'static str,
    /// The 99th percentile of the errors.
    pub p99: f64,
    /// The largest error.
    pub largest: f64,
    /// Number of values that prove little, because their bound is wide or because they are close to a branch.
    pub touching: usize,
    /// The largest number of such values allowed.
    pub may_touch: usize,
}

/// Values that a comparison leaves out because rounding may decide them either way, such as instances at an
/// edge of the view and bones half a turn apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Number of values left out.
    pub count: usize,
    /// Number of all values.
    pub of: usize,
    /// The largest number that may be left out.
    pub most: usize,
}

impl Comparison {
    /// A comparison that fails whatever the values.
    pub(crate) fn failed(values: usize, fault: String) -> Self {
        let (error, bound, unit) = (f64::INFINITY, 0.0, "none");
        Self { holds: false, values, error, bound, unit, spread: None, left_out: None, fault: Some(fault) }
    }

    /// The comparison with a record of what it left out. It fails if that is more than is allowed.
    #[must_use]
    pub fn leaving_out(self, left_out: LeftOut) -> Self {
        let LeftOut { count, of, most } = left_out;
        let left = |this: Self| Self { left_out: Some(left_out), ..this };
        if count <= most {
            return left(self);
        }
        let fault = format!("{count} of {of} are left out, and at most {most} may be");
        left(Self::failed(self.values, fault))
    }
}

fn compare<T: Copy + Debug>(
    actual: &[T],
    expected: &[T],
    unit: &'static str,
    bound: f64,
    error: impl Fn(T, T) -> f64,
) -> Comparison {
    if actual.len() != expected.len() || expected.is_empty() {
        let fault = format!("{} values instead of {}", actual.len(), expected.len());
        return Comparison::failed(actual.len(), fault);
    }
    let (mut worst, mut first, mut wrong) = (0.0, None, 0);
    for (index, (&actual, &expected)) in actual.iter().zip(expected).enumerate() {
        let error = error(actual, expected);
        worst = f64::max(worst, error);
        // A NaN is never within a bound.
        if error.is_nan() || error > bound {
            worst = if error.is_nan() { f64::INFINITY } else { worst };
            wrong += 1;
            first.get_or_insert((index, actual, expected));
        }
    }
    let values = actual.len();
    let fault = first.map(|(index, actual, expected)| {
        format!("{wrong} of {values} values; first at {index}: {actual:?} instead of {expected:?}")
    });
    Comparison { holds: wrong == 0, values, error: worst, bound, unit, spread: None, left_out: None, fault }
}

/// Compares integers: every bit must be equal.
pub fn exact<T: Copy + Debug + PartialEq>(actual: &[T], expected: &[T]) -> Comparison {
    compare(
        actual,
        expected,
        "wrong values",
        0.0,
        |actual, expected| if actual == expected { 0.0 } else { 1.0 },
    )
}

/// Compares floats with an absolute bound.
pub fn absolute(actual: &[f32], expected: &[f32], bound: f32) -> Comparison {
    compare(actual, expected, "absolute", bound.into(), |actual, expected| {
        (f64::from(actual) - f64::from(expected)).abs()
    })
}

/// Compares floats with a bound relative to the expected value, or absolute where that value is below 1e-6.
pub fn relative(actual: &[f32], expected: &[f32], bound: f32) -> Comparison {
    compare(actual, expected, "relative", bound.into(), |actual, expected| {
        let (actual, expected) = (f64::from(actual), f64::from(expected));
        (actual - expected).abs() / expected.abs().max(1e-6)
    })
}

/// Compares images by the largest difference in any of four 8-bit channels.
pub fn levels(actual: &[u32], expected: &[u32], bound: u8) -> Comparison {
    compare(actual, expected, "levels of 255", bound.into(), |actual, expected| {
        let pairs = actual.to_le_bytes().into_iter().zip(expected.to_le_bytes());
        pairs.map(|(actual, expected)| f64::from(actual.abs_diff(expected))).fold(0.0, f64::max)
    })
}

/// The judgement of one value that has a bound of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judgement {
    /// The error divided by its bound; NaN and infinity fail.
    pub ratio: f64,
    /// The error itself.
    pub error: f64,
    /// Whether the value proves little: its bound is wide, or it is so close to a branch that either side may
    /// be taken.
    pub touches: bool,
}

impl Judgement {
    /// That of a value that is right or not, whatever its error.
    pub(crate) fn exact(is_right: bool, error: f64, touches: bool) -> Self {
        Self { ratio: if is_right { 0.0 } else { f64::INFINITY }, error, touches }
    }
}

/// Compares values that each have a bound of their own: every error must be within its bound, and of all values
/// at most the fraction `may_touch`, but at least one, may prove little. `describe` describes a value by its
/// index.
pub(crate) fn each(
    judgements: &[Judgement],
    unit: &'static str,
    may_touch: f64,
    describe: impl Fn(usize) -> String,
) -> Comparison {
    let values = judgements.len();
    if values == 0 {
        return Comparison::failed(0, "no values".to_owned());
    }
    let is_wrong = |judgement: &Judgement| judgement.ratio.is_nan() || judgement.ratio > 1.0;
    let wrong = judgements.iter().filter(|judgement| is_wrong(judgement)).count();
    let first = judgements.iter().position(is_wrong);
    let no_nan = |value: f64| if value.is_nan() { f64::INFINITY } else { value };
    let error = judgements.iter().map(|judgement| no_nan(judgement.ratio)).fold(0.0, f64::max);
    let mut errors: Vec<f64> = judgements.iter().map(|judgement| no_nan(judgement.error)).collect();
    errors.sort_unstable_by(f64::total_cmp);
    let spread = Spread {
        unit,
        p99: errors[(values * 99).div_ceil(100) - 1],
        largest: errors[values - 1],
        touching: judgements.iter().filter(|judgement| judgement.touches).count(),
        may_touch: ((may_touch * values as f64) as usize).max(1),
    };
    let too_many = spread.touching > spread.may_touch;
    let fault = match first {
        Some(index) => Some(format!("{wrong} of {values} values; first at {index}: {}", describe(index))),
        None if too_many => {
            Some(format!("{} of {values} touch; at most {} may", spread.touching, spread.may_touch))
        }
        None => None,
    };
    let unit = "of each value's own bound";
    Comparison {
        holds: fault.is_none(),
        values,
        error,
        bound: 1.0,
        unit,
        spread: Some(spread),
        left_out: None,
        fault,
    }
}
