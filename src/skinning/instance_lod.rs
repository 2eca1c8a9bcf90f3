//! Level of detail of a skinned instance: how many bones each vertex follows, and which vertices are skinned (thesis A section
//! 8.4).

use crate::InputError;
use crate::asset::influences::MAX_INFLUENCES;
use crate::asset::mesh::MAX_LEVELS;
use crate::shared::skinning::instance_lod as shared;
pub use crate::shared::skinning::instance_lod::InstanceLod;

// `relievo-asset` repeats the constant of the shaders.
const _: () = assert!(MAX_LEVELS == shared::MAX_LEVELS as usize);

/// Two projected distances in world units. Between them, the influences of all but the strongest bone fade out.
///
/// The projected distance of a point is z²/d, where z is its depth and d its distance from the eye; in a parallel view
/// it is d. A small displacement of the point moves it on the screen by at most focal · displacement · d/z² pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FadeRange {
    /// Up to this distance, all influences have their full weight.
    pub start: f32,
    /// From this distance on, each vertex follows one bone only. Must be above `start`.
    pub end: f32,
}

impl FadeRange {
    /// Checks that both distances are finite and that `start` is below `end`.
    ///
    /// # Errors
    /// [`InputError`] for a distance that is not finite, and for a start that is not below the end.
    pub fn validate(&self) -> Result<(), InputError> {
        let Self { start, end } = *self;
        InputError::check_finite("fade_range.start", start)?;
        InputError::check_finite("fade_range.end", end)?;
        if start >= end {
            let bound = format!("must be below {end}, where vertices are rigid");
            return Err(InputError::new("fade_range.start", start, bound));
        }
        Ok(())
    }
}

impl InstanceLod {
    /// Full quality: all influences of all vertices.
    pub const FULL: Self =
        Self { influence_fade: 0.0, max_influences: MAX_INFLUENCES as u32, mesh_lod: 0, tier: 0 };

    /// No skinning, for an instance that is not visible.
    pub const UNSEEN: Self = Self { influence_fade: 0.0, max_influences: 0, mesh_lod: 0, tier: 0 };

    /// Full quality, except that each vertex follows at most `most` bones: those with the largest weights.
    ///
    /// # Errors
    /// [`InputError`] unless `most` is in 1 to [`MAX_INFLUENCES`].
    pub fn truncate(most: u32) -> Result<Self, InputError> {
        let instance_lod = Self { max_influences: most, ..Self::FULL };
        instance_lod.validate().map(|()| instance_lod)
    }

    /// Weaker influences faded by `fade`: 0 is full quality, 1 is rigid (one bone per vertex).
    ///
    /// # Errors
    /// [`InputError`] unless `fade` is in 0 to 1.
    pub fn fade(fade: f32) -> Result<Self, InputError> {
        let instance_lod = Self { influence_fade: fade, ..Self::FULL };
        instance_lod.validate().map(|()| instance_lod)
    }

    /// All influences, for the vertices of this level of detail of the mesh.
    ///
    /// # Errors
    /// [`InputError`] unless `level` is below [`MAX_LEVELS`].
    pub fn level(level: u32) -> Result<Self, InputError> {
        let instance_lod = Self { mesh_lod: level, ..Self::FULL };
        instance_lod.validate().map(|()| instance_lod)
    }

    /// Influences faded by distance: full quality up to the range's start, rigid from its end on, and linear in between.
    ///
    /// # Errors
    /// [`InputError`] for a distance that is not finite, and for a range that [`FadeRange::validate`] refuses.
    pub fn at_distance(distance: f32, fade_range: FadeRange) -> Result<Self, InputError> {
        InputError::check_finite("distance", distance)?;
        fade_range.validate()?;
        let FadeRange { start, end } = fade_range;
        Self::fade(((distance - start) / (end - start)).clamp(0.0, 1.0))
    }

    /// Checks the fields of a visible instance against their ranges.
    ///
    /// # Errors
    /// [`InputError`] that names the first field out of range.
    pub fn validate(&self) -> Result<(), InputError> {
        InputError::check_within("influence_fade", self.influence_fade, 0.0..=1.0)?;
        InputError::check_within("max_influences", self.max_influences, 1..=MAX_INFLUENCES as u32)?;
        InputError::check_below("mesh_lod", self.mesh_lod, MAX_LEVELS)
    }
}
