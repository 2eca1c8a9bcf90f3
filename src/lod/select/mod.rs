//! Which instances of a scene a view sees, with which level of detail, and how far they may be off.
//!
//! An instance is seen if it exists, if its object is shown, if its visibility mask shares a bit with the view's, if it
//! casts shadows where the view asks for that, and if its bounding sphere reaches into the view volume. Each of the view's
//! cameras allows a displacement ([`LodCamera::allows`](super::LodCamera::allows)); the smallest of them, divided by the instance's largest scale,
//! is what the model may be off in its own units. Of the object's levels the view draws the coarsest whose error is within
//! its fraction of that. Merged over the views of a frame, it also limits what gates and skinning may leave out
//! ([`assign`](super::assign)), since poses are the same for all views.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{SelectBuffers, SelectPass};

use super::{LodCamera, SelectView, VIEW_CAMERAS};
use crate::InputError;
pub use crate::shared::lod::select::UNSEEN_ALLOWED;

impl SelectView {
    /// Checks the ranges.
    ///
    /// # Errors
    /// [`InputError`] for no camera or more than [`VIEW_CAMERAS`], for a mask of more than 16 bits, and for planes that are
    /// not finite.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(1..=VIEW_CAMERAS).contains(&self.camera_count) {
            let bound = format!("must be in 1..={VIEW_CAMERAS}");
            return Err(InputError::new("view.camera_count", self.camera_count, bound));
        }
        if self.mask > 0xffff {
            return Err(InputError::new("view.mask", self.mask, "must have 16 bits"));
        }
        match self.planes.iter().position(|plane| !plane.is_finite()) {
            Some(at) => Err(InputError::new(format!("view.planes[{at}]"), self.planes[at], "must be finite")),
            None => Ok(()),
        }
    }

    /// The cameras that count.
    pub fn cameras(&self) -> &[LodCamera] {
        &self.cameras[..(self.camera_count.clamp(1, VIEW_CAMERAS)) as usize]
    }
}
