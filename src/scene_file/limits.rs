//! Bounds that several parts of a scene file share.

use glam::Vec3;

use super::json::At;
use crate::InputError;

/// The largest absolute value of a coordinate, in world units.
pub(super) const COORDINATE: f64 = 1e9;

/// Three scale factors, of which one alone is enough.
pub(super) fn scale(at: &At<'_>) -> Result<Vec3, InputError> {
    let check = |factor: f64| (1e-6..=1e6).contains(&factor.abs());
    let all = match at.value().is_number() {
        true => [at.number(-1e6, 1e6)?; 3],
        false => at.numbers::<3>(-1e6, 1e6)?,
    };
    if !all.into_iter().all(check) {
        return Err(at.error("must be one number or three between 1e-6 and 1e6, negative ones to mirror"));
    }
    Ok(all.map(|factor| factor as f32).into())
}
