//! Placements of meshes that are attached to bones: in each view, a mesh follows a character's bone in the frame's
//! pose.
//!
//! [`select`](super::select) runs before the frame's bone poses are known. It therefore tests an attached instance with its
//! character's placement and with a sphere that contains the mesh in every pose of the bone. This operation then overwrites the
//! placement that the selection wrote. The new placement is the product of the character's placement, the bone's model matrix and
//! the mesh's offset. If no view of the frame sees the character, its bones are not posed, and the mesh collapses to a point.
//!
//! In a scene that keeps its last frame, the operation has two more outputs: the product of bone and offset, kept for two frames,
//! and the placement that the mesh had in the last frame. The bone counts as static if the mesh was attached after the last
//! frame, or if no view saw the character in that frame.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{AttachBuffers, AttachPass};

pub use crate::shared::lod::attach::{AttachParams, Attachment, KeptBone, NO_MESH};

/// Bound on the difference between CPU and GPU in an entry of an attached mesh's placement, on any device: 3e-6 times a reference
/// value. The placement is a product of three transforms. To get the reference value, replace all components of these transforms
/// by their absolute values, multiply, and take the entry at the same place.
///
/// Every operation on a device may round by ε = 2⁻²³. An entry of the placement's axes carries an error of 7ε. Each of the two
/// products adds 4ε: multiplication (ε), two additions (2ε), and the addition of the translation (ε). The sum is 15ε. The CPU
/// reference adds half of this sum. The total is 2.7e-6, which is rounded up.
pub const ATTACH_BOUND: f32 = 3e-6;
