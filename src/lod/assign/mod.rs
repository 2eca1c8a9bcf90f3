//! Divides the allowed displacement of each character instance between bone gates and skinning. Gates may then skip bones, and
//! skinning may leave out influences.
//!
//! [`select`](super::select) gives the allowed displacement, in model units. One fraction of it goes to bones that are not
//! sampled, and one to influences that fade out. The remainder is for levels of detail of the mesh. [`decide`](super::decide)
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
        if !(1..=MAX_INFLUENCES as u32).contains(&self.max_influences) {
            let bound = format!("must be in 1..={MAX_INFLUENCES}");
            return Err(InputError::new("params.max_influences", self.max_influences, bound));
        }
        Ok(())
    }
}
