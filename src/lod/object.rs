//! Checks of a scene's objects.

use super::{BLOCK, LodObject, OBJECT_LEVELS};
use crate::InputError;
use crate::shared::lod::object::{NO_RANK, object_flags_transition};
use crate::shared::lod::transition::TRANSITION_GEOMORPH;

/// Checks the number of an object's levels and their thresholds. With `begins_at_0`, the threshold of level 0 must be 0.
fn check_levels(path: &str, object: &LodObject, begins_at_0: bool) -> Result<(), InputError> {
    let levels = object.levels;
    if !(1..=OBJECT_LEVELS).contains(&levels) {
        return Err(InputError::new(
            format!("{path}.levels"),
            levels,
            format!("must be in 1..={OBJECT_LEVELS}"),
        ));
    }
    let mut least = 0.0;
    for (level, threshold) in object.thresholds.as_flattened().iter().enumerate().take(levels as usize) {
        if !(least..f32::INFINITY).contains(threshold) || begins_at_0 && level == 0 && *threshold > 0.0 {
            let bound = "must be finite, ascending, and 0 at level 0";
            return Err(InputError::new(format!("{path}.thresholds[{level}]"), threshold, bound));
        }
        least = *threshold;
    }
    Ok(())
}

/// Checks that a fraction is in 0 to 1.
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
        metric_scale: 1.0,
        flags: 0,
        thresholds: [[0.0; 4]; 2],
        finer: 1.0,
        coarser: 1.0,
        rate: 0.0,
        motion: 0.0,
        point: [0.0; 3],
        periphery: 0.0,
        half_size: [0.0; 3],
        rank: NO_RANK,
        fade_begin: 0.0,
        fade_end: 0.0,
        metric_floor: 0.0,
        unused: 0,
        triangles: [[0; 4]; 2],
    };

    /// Checks that all fields are in their ranges. `path` is the object's path in error messages.
    ///
    /// # Errors
    /// [`InputError`] that names the field:
    /// - `first` or `instances` that is not a multiple of [`BLOCK`];
    /// - `levels` outside of 1 to [`OBJECT_LEVELS`];
    /// - thresholds that are not finite or descend;
    /// - `metric_scale` that is not above 0;
    /// - `finer` outside of 0 to 1, or `coarser` below `finer`.
    pub fn validate(&self, path: &str) -> Result<(), InputError> {
        for (field, value) in [("first", self.first), ("instances", self.instances)] {
            if !value.is_multiple_of(BLOCK) {
                let bound = format!("must be a multiple of {BLOCK}");
                return Err(InputError::new(format!("{path}.{field}"), value, bound));
            }
        }
        check_levels(path, self, object_flags_transition(self.flags) != TRANSITION_GEOMORPH)?;
        let is_above_0 = |value: f32| value > 0.0 && value.is_finite();
        let checked = [
            ("metric_scale", self.metric_scale, is_above_0(self.metric_scale), "must be finite, and above 0"),
            ("finer", self.finer, (0.0..=1.0).contains(&self.finer), "must be in 0..=1"),
            ("coarser", self.coarser, self.coarser >= self.finer, "must be at least finer"),
        ];
        match checked.into_iter().find(|(_, _, is_right, _)| !is_right) {
            Some((field, value, _, bound)) => Err(InputError::new(format!("{path}.{field}"), value, bound)),
            None => Ok(()),
        }
    }
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
            thresholds: [[0.0, 0.1, 0.1, f32::NAN], [0.0; 4]],
            ..LodObject::NONE
        };
        assert_eq!(right.validate("objects[3]"), Ok(()));
        let refused = |object: LodObject| object.validate("objects[3]").expect_err("refused").path;
        assert_eq!(refused(LodObject { first: 32, ..right }), "objects[3].first");
        assert_eq!(refused(LodObject { instances: 65, ..right }), "objects[3].instances");
        assert_eq!(refused(LodObject { levels: 0, ..right }), "objects[3].levels");
        assert_eq!(refused(LodObject { levels: 9, ..right }), "objects[3].levels");
        assert_eq!(refused(LodObject { levels: 4, ..right }), "objects[3].thresholds[3]");
        let first = |threshold| [[threshold, 0.1, 0.1, 0.2], [0.0; 4]];
        assert_eq!(refused(LodObject { thresholds: first(0.1), ..right }), "objects[3].thresholds[0]");
        let flags = object_flags_word(1, 0, 0, TRANSITION_GEOMORPH, 0);
        let morphs = LodObject { flags, thresholds: first(0.05), ..right };
        assert_eq!(morphs.validate("objects[3]"), Ok(()));
        assert_eq!(refused(LodObject { thresholds: first(-0.1), ..right }), "objects[3].thresholds[0]");
        assert_eq!(
            refused(LodObject { levels: 5, thresholds: first(0.0), ..right }),
            "objects[3].thresholds[4]"
        );
        assert_eq!(refused(LodObject { metric_scale: 0.0, ..right }), "objects[3].metric_scale");
        assert_eq!(refused(LodObject { finer: 1.1, ..right }), "objects[3].finer");
        assert_eq!(refused(LodObject { coarser: 0.9, ..right }), "objects[3].coarser");
    }
}
