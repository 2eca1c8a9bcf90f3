//! Valid ranges of a scene's objects.

use super::{BLOCK, LodObject, OBJECT_LEVELS};
use crate::InputError;
use crate::shared::lod::object::object_flags_transition;
use crate::shared::lod::transition::TRANSITION_HARD;

/// Checks the number of an object's levels and their errors. With `begins_at_0`, the error of level 0 must be 0.
pub(super) fn check_levels(
    path: &str,
    levels: u32,
    errors: &[f32],
    begins_at_0: bool,
) -> Result<(), InputError> {
    if !(1..=OBJECT_LEVELS).contains(&levels) {
        return Err(InputError::new(
            format!("{path}.levels"),
            levels,
            format!("must be in 1..={OBJECT_LEVELS}"),
        ));
    }
    let mut least = 0.0;
    for (level, error) in errors.iter().enumerate().take(levels as usize) {
        if !(least..f32::INFINITY).contains(error) || begins_at_0 && level == 0 && *error > 0.0 {
            let bound = "must be finite, ascending, and 0 at level 0";
            return Err(InputError::new(format!("{path}.errors[{level}]"), error, bound));
        }
        least = *error;
    }
    Ok(())
}

/// Checks a fraction.
pub(super) fn check_fraction(path: String, fraction: f32) -> Result<(), InputError> {
    if (0.0..=1.0).contains(&fraction) {
        Ok(())
    } else {
        Err(InputError::new(path, fraction, "must be in 0..=1"))
    }
}

impl LodObject {
    /// An object without instances, lists or draws.
    pub const NONE: Self = Self {
        first: 0,
        instances: 0,
        levels: 1,
        first_list: 0,
        first_draw: 0,
        parts: 0,
        mesh_fraction: 0.0,
        flags: 0,
        errors: [[0.0; 4]; 2],
    };

    /// Checks the ranges. `path` is the object's path in error messages.
    ///
    /// # Errors
    /// [`InputError`] for instances that do not take whole blocks, for a number of levels beyond [`OBJECT_LEVELS`], for
    /// errors that are not finite or descend, and for a fraction outside 0 to 1.
    pub fn validate(&self, path: &str) -> Result<(), InputError> {
        for (field, value) in [("first", self.first), ("instances", self.instances)] {
            if !value.is_multiple_of(BLOCK) {
                let bound = format!("must be a multiple of {BLOCK}");
                return Err(InputError::new(format!("{path}.{field}"), value, bound));
            }
        }
        let begins_at_0 = object_flags_transition(self.flags) == TRANSITION_HARD;
        check_levels(path, self.levels, self.errors.as_flattened(), begins_at_0)?;
        check_fraction(format!("{path}.mesh_fraction"), self.mesh_fraction)
    }
}

/// The coarsest level whose error is at most `within`.
pub fn level_within(levels: u32, errors: &[[f32; 4]; 2], within: f32) -> u32 {
    let fits = |level: &u32| errors.as_flattened()[*level as usize] <= within;
    (1..levels.min(OBJECT_LEVELS)).rev().find(fits).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shared::lod::object::object_flags_word;
    use crate::shared::lod::transition::TRANSITION_GEOMORPH;

    #[test]
    fn objects_are_checked_field_by_field() {
        let right = LodObject {
            first: 64,
            instances: 128,
            levels: 3,
            mesh_fraction: 0.5,
            errors: [[0.0, 0.1, 0.1, f32::NAN], [0.0; 4]],
            ..LodObject::NONE
        };
        assert_eq!(right.validate("objects[3]"), Ok(()));
        let refused = |object: LodObject| object.validate("objects[3]").expect_err("refused").path;
        assert_eq!(refused(LodObject { first: 32, ..right }), "objects[3].first");
        assert_eq!(refused(LodObject { instances: 65, ..right }), "objects[3].instances");
        assert_eq!(refused(LodObject { levels: 0, ..right }), "objects[3].levels");
        assert_eq!(refused(LodObject { levels: 9, ..right }), "objects[3].levels");
        assert_eq!(refused(LodObject { levels: 4, ..right }), "objects[3].errors[3]");
        let first = |error| [[error, 0.1, 0.1, 0.2], [0.0; 4]];
        assert_eq!(refused(LodObject { errors: first(0.1), ..right }), "objects[3].errors[0]");
        let flags = object_flags_word(1, TRANSITION_GEOMORPH, 0);
        let morphs = LodObject { flags, errors: first(0.05), ..right };
        assert_eq!(morphs.validate("objects[3]"), Ok(()));
        assert_eq!(refused(LodObject { errors: first(-0.1), ..right }), "objects[3].errors[0]");
        assert_eq!(refused(LodObject { levels: 5, errors: first(0.0), ..right }), "objects[3].errors[4]");
        assert_eq!(refused(LodObject { mesh_fraction: 1.5, ..right }), "objects[3].mesh_fraction");
    }

    #[test]
    fn the_coarsest_level_that_fits_is_taken() {
        let errors = [[0.0, 0.1, 0.1, 0.2], [0.4, 0.8, 1.6, 3.2]];
        let levels = [0.0, 0.09, 0.1, 0.3, 9.0].map(|within| level_within(8, &errors, within));
        assert_eq!(levels, [0, 0, 2, 3, 7]);
        assert_eq!(level_within(2, &errors, 9.0), 1);
    }
}
