//! Sets the level of detail of each character instance for bone gates and for skinning. Gates may then skip bones, and skinning
//! may leave out influences.
//!
//! [`select`](super::select) gives the allowed displacement, in model units. One fraction of it goes to bones that are not
//! sampled, and one to influences that fade out. The remainder is for levels of detail of the mesh. A reduced skeleton is used
//! where its error is at most a part of the bones' fraction. Ω ([`Range`](crate::animation::lod::Range)) and the fade by distance
//! ([`FadeRange`](crate::skinning::instance_lod::FadeRange)) follow from the distance of the nearest eye. [`decide`](super::decide)
//! gives the finest level that any view draws; this level is skinned. An instance that no view sees is neither sampled nor
//! skinned.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{AssignBuffers, AssignPass};

use super::object::check_fraction;
use crate::InputError;
use crate::asset::influences::MAX_INFLUENCES;
pub use crate::shared::lod::assign::AssignParams;

impl AssignParams {
    /// Checks that all parameters are in their ranges.
    ///
    /// # Errors
    /// [`InputError`] that names the field. If the two fractions add up to more than 1, it names `params.influence_fraction`.
    pub fn validate(&self) -> Result<(), InputError> {
        check_fraction("params.bone_fraction".to_owned(), self.bone_fraction)?;
        check_fraction("params.influence_fraction".to_owned(), self.influence_fraction)?;
        let sum = self.bone_fraction + self.influence_fraction;
        if sum > 1.0 + 1e-6 {
            let bound = format!("must not add up to more than 1 with bone_fraction, and does to {sum}");
            return Err(InputError::new("params.influence_fraction", self.influence_fraction, bound));
        }
        if !(1e-20..f32::INFINITY).contains(&self.unit) {
            return Err(InputError::new("params.unit", self.unit, "must be at least 1e-20 and finite"));
        }
        if !(0.0..f32::INFINITY).contains(&self.stray) {
            return Err(InputError::new("params.stray", self.stray, "must be at least 0 and finite"));
        }
        for (path, value) in [
            ("params.omega_start", self.omega_start),
            ("params.omega_rate", self.omega_rate),
            ("params.fade_start", self.fade_start),
            ("params.fade_rate", self.fade_rate),
        ] {
            if !(0.0..f32::INFINITY).contains(&value) {
                return Err(InputError::new(path, value, "must be at least 0 and finite"));
            }
        }
        if !(f32::MIN_POSITIVE..f32::INFINITY).contains(&self.full_weight_allowed) {
            let bound = "must be above 0 and finite";
            return Err(InputError::new("params.full_weight_allowed", self.full_weight_allowed, bound));
        }
        check_fraction("params.tier_fraction".to_owned(), self.tier_fraction)?;
        let errors = self.tier_errors.to_array();
        if errors[0] != 0.0 || !errors.is_sorted() {
            return Err(InputError::new("params.tier_errors", self.tier_errors, "must ascend from 0"));
        }
        if !(1..=MAX_INFLUENCES as u32).contains(&self.max_influences) {
            let bound = format!("must be in 1..={MAX_INFLUENCES}");
            return Err(InputError::new("params.max_influences", self.max_influences, bound));
        }
        Ok(())
    }
}
