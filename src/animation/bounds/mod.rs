//! Axis-aligned bounding boxes of animated instances, in model space, for culling.
//!
//! A sphere around each bone's origin contains everything that the bone moves. The sphere's *radius* is measured in the bone's
//! own space, in metres. The bone's matrix turns the sphere into an ellipsoid. The ellipsoid's extent along an axis is the radius
//! times the length of the matrix row of that axis. This also holds for ancestors with uneven scales. (The length of the longest
//! matrix column would be wrong, because a parent with an uneven scale shears its children.)
//!
//! The result is the box around the ellipsoids of all bones. The box also contains points that several bones share with weights
//! from 0 to 1. Such points lie between the positions that each bone alone would give them.
//!
//! The caller provides one radius per bone: the distance from the bone to the farthest vertex that the bone moves, `|inverse_bind
//! · v|`. Without a mesh, use the bones' own lengths ([`bone_radii`]).
//!
//! Boxes are rounded outward. On every device, a box contains the exact box of the matrices' `f32` values, as long as values stay
//! below 2⁶³. `docs/rounding-bounds.md` has the derivation.

use crate::InputError;
use crate::asset::skeleton::Skeleton;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::BoundsPass;

/// Largest allowed difference between a coordinate of a box and the CPU reference, on any device. It is relative to the box's
/// largest absolute coordinate.
///
/// Let ε = 2⁻²⁴. A coordinate is a bone's center plus or minus the extent of its ellipsoid. Three errors add up: 20ε of the
/// extent, 4ε of the center, and 2ε of the coordinate. None of these values exceeds the box's largest absolute coordinate, so
/// the device is off by at most 26ε of that coordinate. The CPU may be off by another 26ε. The total is 52ε < 4e-6.
pub const BOUNDS_BOUND: f32 = 4e-6;

/// An axis-aligned box in model space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct MotionBounds {
    /// Smallest x, y and z in metres; the fourth component is 0.
    pub low: [f32; 4],
    /// Largest x, y and z in metres; the fourth component is 0.
    pub high: [f32; 4],
}

/// Radius of each bone, in metres, for a skeleton without a mesh: the bone's length ([`Skeleton::lengths`]).
pub fn bone_radii(skeleton: &Skeleton) -> Vec<f32> {
    // Round up: the conversion to f32 may have made the length smaller.
    let up = |length: f64| {
        if f64::from(length as f32) < length { (length as f32).next_up() } else { length as f32 }
    };
    skeleton.lengths().into_iter().map(up).collect()
}

/// Checks that `bone_radii` has `bones` entries, and that each entry is a valid radius.
///
/// # Errors
/// [`InputError`] if the number of radii is not `bones`, or if a radius is negative or not finite.
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
