//! Which influences count, and which vertices (A section 8.4).

use crate::InputError;
use crate::asset::influences::MOST_INFLUENCES;
use crate::asset::mesh::MOST_LEVELS;
pub use crate::shared::skinning::reduction::Reduction;

impl Reduction {
    /// Every influence of every vertex.
    pub const FULL: Self = Self { fade: 0.0, most: MOST_INFLUENCES as u32, level: 0 };

    /// Of instances that are not seen: nothing is skinned.
    pub const UNSEEN: Self = Self { fade: 0.0, most: 0, level: 0 };

    /// The strongest influences.
    ///
    /// # Errors
    /// [`InputError`] unless `most` is in 1 to [`MOST_INFLUENCES`].
    pub fn truncate(most: u32) -> Result<Self, InputError> {
        let reduction = Self { most, ..Self::FULL };
        reduction.validate().map(|()| reduction)
    }

    /// From full quality at 0 to rigid at 1.
    ///
    /// # Errors
    /// [`InputError`] unless `fade` is in 0 to 1.
    pub fn fade(fade: f32) -> Result<Self, InputError> {
        let reduction = Self { fade, ..Self::FULL };
        reduction.validate().map(|()| reduction)
    }

    /// Every influence of the vertices of a level.
    ///
    /// # Errors
    /// [`InputError`] unless `level` is below [`MOST_LEVELS`].
    pub fn level(level: u32) -> Result<Self, InputError> {
        let reduction = Self { level, ..Self::FULL };
        reduction.validate().map(|()| reduction)
    }

    /// Full quality up to `near`, rigid from `far` on, fading in between.
    ///
    /// # Errors
    /// [`InputError`] for values that are not finite, and unless `near` is below `far`.
    pub fn at_distance(distance: f32, [near, far]: [f32; 2]) -> Result<Self, InputError> {
        for (field, value) in [("distance", distance), ("near", near), ("far", far)] {
            if !value.is_finite() {
                return Err(InputError::new(field, value, "must be finite"));
            }
        }
        if near >= far {
            return Err(InputError::new(
                "near",
                near,
                format!("must be below {far}, where vertices are rigid"),
            ));
        }
        Self::fade(((distance - near) / (far - near)).clamp(0.0, 1.0))
    }

    /// Checks the ranges of an instance that is seen.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(0.0..=1.0).contains(&self.fade) {
            return Err(InputError::new("fade", self.fade, "must be in 0..=1"));
        }
        if !(1..=MOST_INFLUENCES as u32).contains(&self.most) {
            return Err(InputError::new("truncate", self.most, format!("must be in 1..={MOST_INFLUENCES}")));
        }
        if self.level as usize >= MOST_LEVELS {
            return Err(InputError::new("level", self.level, format!("must be below {MOST_LEVELS}")));
        }
        Ok(())
    }
}
