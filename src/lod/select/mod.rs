//! Selection: which instances of a scene a view sees, the metric of each, and its allowed displacement.
//!
//! A view sees an instance if all of these hold:
//! - the instance exists and its object is shown;
//! - its visibility mask shares a bit with the view's;
//! - it casts shadows, if the view asks for casters only;
//! - its bounding sphere reaches into the view volume.
//!
//! Each of the view's cameras allows a displacement ([`LodCamera::allows`](super::LodCamera::allows)). The smallest one, divided
//! by the instance's largest scale, is the allowed displacement in model units. Its minimum over the views of a frame limits
//! gates and skinning ([`assign`](super::assign)), because all views share one pose.
//!
//! Each camera also gives a metric, by the object's [`Criterion`](super::criterion::Criterion). The smallest metric, scaled by
//! the object's factor, decides the level ([`decide`](super::decide)).

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{SelectBuffers, SelectPass};

use super::{LodCamera, SelectView, VIEW_CAMERAS};
use crate::InputError;
pub use crate::shared::lod::allowed::{Allowed, UNSEEN_ALLOWED};

impl SelectView {
    /// Checks that the camera count, the mask and the planes are valid.
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

    /// The cameras in use: the first `camera_count`.
    pub fn cameras(&self) -> &[LodCamera] {
        &self.cameras[..(self.camera_count.clamp(1, VIEW_CAMERAS)) as usize]
    }
}
