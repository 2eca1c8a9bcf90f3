//! Axis-aligned bounds of animated instances, in the model's space, for culling.
//!
//! What a bone moves lies in a ball around its origin, as large as its *reach*: metres in the bone's own space. A
//! palette's matrix makes an ellipsoid of it; along an axis that extends as far as the reach times the length of the
//! matrix's row of that axis, whatever the scales above have done (the longest column would not do: scales that differ
//! along a parent's axes shear its children). The bounds are the box around all bones' ellipsoids. Points that several
//! bones share by weights from 0 to 1 lie between where each bone alone would put them, so inside too.
//!
//! Reaches are the caller's: the farthest vertex that a bone moves, `|inverse_bind · v|`; or, where nothing is known of
//! a mesh, the bones' own lengths ([`bone_radii`]).
//!
//! # Outward
//!
//! A box contains the exact one of the palette's `f32` values, on every device. With ε = 2⁻²⁴ (`+ − ×` to either
//! neighbour 2ε, `inverseSqrt` 4ε, division 5ε, `sqrt` after both 9ε): a row's squared length carries 6ε, its length 12ε,
//! times the reach 14ε. [`BOUNDS_GROWTH`] adds 32ε of the extent and [`BOUNDS_OF_CENTRE`] 8ε of the centre, of which
//! multiplying and adding them takes 6ε and 4ε, and subtracting from the centre 2ε of both: at least 10ε and 2ε are left.
//! Rows below 2⁻⁶³, whose squares devices may flush to 0, are covered by 2⁻⁶² of the reach. Values must stay below
//! 2⁶³; who transforms vertices by the palette in `f32` adds rounding of his own, some 8ε of where they lie.

use crate::InputError;
use crate::asset::skeleton::Skeleton;

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::{BoundsPass, Share};

/// By what extents grow.
pub const BOUNDS_GROWTH: f32 = 1.0 + 1.0 / 524_288.0;

/// What extents get of the distance of the centre.
pub const BOUNDS_OF_CENTRE: f32 = 1.0 / 2_097_152.0;

/// What a row is longer than its squares say: 2⁻⁶².
pub const BOUNDS_LEAST: f32 = 2.168_404_3e-19;

/// How far a side may lie from the reference's, on any device, times the largest side: 14ε and 6ε of the extent, 4ε of the
/// centre and 2ε of the side from either: 52ε < 4e-6.
pub const BOUNDS_BOUND: f32 = 4e-6;

/// A box along the axes of the model's space.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Bounds {
    /// The least x, y, z, in metres, and 0.
    pub low: [f32; 4],
    /// The largest, and 0.
    pub high: [f32; 4],
}

/// The reach of each bone where nothing is known of a mesh: its length ([`Skeleton::lengths`]).
pub fn bone_radii(skeleton: &Skeleton) -> Vec<f32> {
    // To the neighbour above, where it was rounded down.
    let up = |length: f64| {
        if f64::from(length as f32) < length { (length as f32).next_up() } else { length as f32 }
    };
    skeleton.lengths().into_iter().map(up).collect()
}

/// Checks the reaches of `bones` bones.
///
/// # Errors
/// [`InputError`] for other than one a bone, and reaches that are negative or not finite.
pub fn check_bone_radii(bone_radii: &[f32], bones: usize) -> Result<(), InputError> {
    if bone_radii.len() != bones {
        return Err(InputError::new(
            "bone_radii.len",
            bone_radii.len(),
            format!("must be {bones}, one a bone"),
        ));
    }
    match bone_radii.iter().position(|bone_radius| !(0.0..f32::INFINITY).contains(bone_radius)) {
        None => Ok(()),
        Some(at) => {
            Err(InputError::new(format!("bone_radii[{at}]"), bone_radii[at], "must be at least 0 metres"))
        }
    }
}

#[cfg(all(test, feature = "samples"))]
mod tests {
    use super::*;

    #[test]
    fn reaches_are_checked_one_by_one() {
        assert_eq!(check_bone_radii(&[0.0, 2.0], 2), Ok(()));
        assert_eq!(check_bone_radii(&[0.0], 2).expect_err("refused").field, "bone_radii.len");
        for wrong in [-0.5, f32::NAN, f32::INFINITY] {
            assert_eq!(check_bone_radii(&[0.0, wrong], 2).expect_err("refused").field, "bone_radii[1]");
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
