//! Range checks of options.

use relievo::InputError;

/// Refuses a value that lies outside the range, and NaN.
pub(crate) fn check(
    field: &str,
    value: f64,
    bounds: std::ops::RangeInclusive<f64>,
) -> Result<(), InputError> {
    if bounds.contains(&value) {
        return Ok(());
    }
    Err(InputError::new(field, value, format!("must be in {}..={}", bounds.start(), bounds.end())))
}
