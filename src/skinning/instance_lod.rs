//! Level of detail of an instance: which influences count, and which vertices are skinned (A section 8.4).

use crate::InputError;
use crate::asset::influences::MAX_INFLUENCES;
use crate::asset::mesh::MAX_LEVELS;
pub use crate::shared::skinning::instance_lod::InstanceLod;

impl InstanceLod {
    /// All influences of all vertices.
    pub const FULL: Self = Self { influence_fade: 0.0, max_influences: MAX_INFLUENCES as u32, mesh_lod: 0 };

    /// For an instance that is not seen: nothing is skinned.
    pub const UNSEEN: Self = Self { influence_fade: 0.0, max_influences: 0, mesh_lod: 0 };

    /// The `most` strongest influences.
    ///
    /// # Errors
    /// [`InputError`] unless `most` is in 1 to [`MAX_INFLUENCES`].
    pub fn truncate(most: u32) -> Result<Self, InputError> {
        let instance_lod = Self { max_influences: most, ..Self::FULL };
        instance_lod.validate().map(|()| instance_lod)
    }

    /// A fade from full quality at 0 to rigid at 1.
    ///
    /// # Errors
    /// [`InputError`] unless `fade` is in 0 to 1.
    pub fn fade(fade: f32) -> Result<Self, InputError> {
        let instance_lod = Self { influence_fade: fade, ..Self::FULL };
        instance_lod.validate().map(|()| instance_lod)
    }

    /// All influences of the vertices of a level.
    ///
    /// # Errors
    /// [`InputError`] unless `level` is below [`MAX_LEVELS`].
    pub fn level(level: u32) -> Result<Self, InputError> {
        let instance_lod = Self { mesh_lod: level, ..Self::FULL };
        instance_lod.validate().map(|()| instance_lod)
    }

    /// Full quality up to `fade_start`, rigid from `fade_end` on, and a fade in between.
    ///
    /// # Errors
    /// [`InputError`] for values that are not finite, and if `fade_start` is not below `fade_end`.
    pub fn at_distance(distance: f32, [fade_start, fade_end]: [f32; 2]) -> Result<Self, InputError> {
        for (field, value) in [("distance", distance), ("fade_start", fade_start), ("fade_end", fade_end)] {
            if !value.is_finite() {
                return Err(InputError::new(field, value, "must be finite"));
            }
        }
        if fade_start >= fade_end {
            return Err(InputError::new(
                "fade_start",
                fade_start,
                format!("must be below {fade_end}, where vertices are rigid"),
            ));
        }
        Self::fade(((distance - fade_start) / (fade_end - fade_start)).clamp(0.0, 1.0))
    }

    /// Checks the ranges; the instance must be one that is seen.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(0.0..=1.0).contains(&self.influence_fade) {
            return Err(InputError::new("influence_fade", self.influence_fade, "must be in 0..=1"));
        }
        if !(1..=MAX_INFLUENCES as u32).contains(&self.max_influences) {
            return Err(InputError::new(
                "max_influences",
                self.max_influences,
                format!("must be in 1..={MAX_INFLUENCES}"),
            ));
        }
        if self.mesh_lod as usize >= MAX_LEVELS {
            return Err(InputError::new("mesh_lod", self.mesh_lod, format!("must be below {MAX_LEVELS}")));
        }
        Ok(())
    }
}
