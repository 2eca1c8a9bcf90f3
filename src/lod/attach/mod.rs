//! Placements of meshes that are attached to bones: in each view, a mesh follows a character's bone in the frame's
//! pose.
//!
//! [`select`](super::select) runs before the frame's bone poses are known. It therefore tests an attached instance with its
//! character's placement and with a sphere that contains the mesh in every pose of the bone. This operation then overwrites the
//! placement that the selection wrote. The new placement is the product of the character's placement, the bone's model matrix and
//! the mesh's offset. If no view of the frame sees the character, its bones are not posed, and the mesh collapses to a point.
//!
//! If the scene keeps its last frame, the operation also keeps the product of bone and offset for two frames, and writes the
//! mesh's transform in the last frame. The bone counts as static if the mesh was attached after the last frame, or if no view saw
//! the character in that frame.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{AttachBuffers, AttachPass};

pub use crate::shared::lod::attach::{AttachParams, Attachment, KeptBone, NO_MESH};

/// Bound on the difference between CPU and GPU for an entry of an attached mesh's placement, on any device: 3e-6. It is relative
/// to a magnitude: what the entry would be if all components of the three multiplied transforms were replaced by their absolute
/// values.
///
/// Every operation on a device may round by ε = 2⁻²³. An entry of the placement's axes carries an error of 7ε. Each of the two
/// products adds 4ε: multiplication (ε), two additions (2ε), and the addition of the translation (ε). The sum is 15ε. The CPU
/// reference adds half of this sum. The total is 2.7e-6, which is rounded up.
pub const ATTACH_BOUND: f32 = 3e-6;
