//! Axis-aligned bounding boxes of animated instances, in model space, for culling.
//!
//! Everything that a bone moves lies in a sphere around the bone's origin. The sphere's *radius* is given in metres, in the
//! bone's own space. The bone's matrix turns the sphere into an ellipsoid. Along an axis, the ellipsoid's extent is the radius
//! times the length of the matrix row of that axis, whatever the scales of the ancestors. (The length of the longest column
//! would be wrong, because uneven scales of a parent shear its children.) The result is the box around the ellipsoids of all
//! bones. It also holds for points that several bones share with weights from 0 to 1: such points lie between their positions
//! under each bone alone.
//!
//! The caller provides one radius per bone: the distance of the farthest vertex that the bone moves, `|inverse_bind · v|`.
//! Without a mesh, use the bones' own lengths ([`bone_radii`]).
//!
//! A box is rounded outward. On every device it contains the exact box of the matrices' `f32` values, as long as values stay
//! below 2⁶³. `docs/rounding-bounds.md` has the derivation.

use crate::InputError;
use crate::asset::skeleton::Skeleton;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::BoundsPass;

/// Largest allowed difference between a side and the reference, on any device, relative to the largest side. The sum is 14ε and
/// 6ε of the extent, 4ε of the center and 2ε of the side, from either: 52ε < 4e-6.
pub const BOUNDS_BOUND: f32 = 4e-6;

/// An axis-aligned box in model space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct MotionBounds {
    /// The smallest x, y, z in metres, and 0.
    pub low: [f32; 4],
    /// The largest x, y, z in metres, and 0.
    pub high: [f32; 4],
}

/// Radius of each bone for a skeleton without a mesh: the bone's length ([`Skeleton::lengths`]).
pub fn bone_radii(skeleton: &Skeleton) -> Vec<f32> {
    // Round up: the conversion to f32 may have made the length smaller.
    let up = |length: f64| {
        if f64::from(length as f32) < length { (length as f32).next_up() } else { length as f32 }
    };
    skeleton.lengths().into_iter().map(up).collect()
}

/// Checks that there are `bones` valid radii.
///
/// # Errors
/// [`InputError`] for a number of radii that is not one per bone, and for radii that are negative or not finite.
pub fn check_bone_radii(bone_radii: &[f32], bones: usize) -> Result<(), InputError> {
    InputError::check_len("bone_radii", bone_radii.len(), bones, "a bone")?;
    let is_good = |radius: &f32| (0.0..f32::INFINITY).contains(radius);
    InputError::check_each("bone_radii", bone_radii, is_good, "must be at least 0 metres")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reaches_are_checked_one_by_one() {
        assert_eq!(check_bone_radii(&[0.0, 2.0], 2), Ok(()));
        assert_eq!(check_bone_radii(&[0.0], 2).expect_err("refused").path, "bone_radii.len");
        for wrong in [-0.5, f32::NAN, f32::INFINITY] {
            assert_eq!(check_bone_radii(&[0.0, wrong], 2).expect_err("refused").path, "bone_radii[1]");
        }
    }

    #[test]
    fn bones_reach_their_farthest_child() {
        let skeleton = crate::samples::creature().expect("valid").skeleton;
        let bone_radii = bone_radii(&skeleton);
        assert!(check_bone_radii(&bone_radii, skeleton.len()).is_ok());
        for bone in skeleton.bones() {
            let Some(parent) = bone.parent else { continue };
            let length = glam::DVec3::from(bone.rest.translation.map(f64::from)).length();
            assert!(f64::from(bone_radii[parent as usize]) >= length, "{}", bone.name);
        }
    }
}
