//! Placements of meshes that are attached to bones: in each view, a mesh follows a character's bone in the frame's
//! pose.
//!
//! [`select`](super::select) runs before the bones of a frame are known. It therefore selects an attached instance by
//! its character's placement and by a sphere that holds the mesh for every pose of the bone. This operation then
//! replaces the rows that the selection wrote by the product of the character's placement, the bone's model matrix and
//! the mesh's offset. If no view of the frame sees the character, its bones are not posed, and the mesh becomes a
//! point.
//!
//! If the scene keeps its last frame, the operation also keeps the product of bone and offset for two frames, and
//! writes the mesh's transform in the last frame. If the mesh was attached since, or its character was not seen then,
//! the bone counts as static.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{AttachBuffers, AttachPass};

pub use crate::shared::lod::attach::{AttachParams, Attachment, KeptBone, NO_MESH};

/// Parity bound for an entry of a placement on any device, as a fraction. It is relative to the entry that results if all three
/// transforms are multiplied with the absolute values of their entries.
///
/// Every operation on a device may round to ε = 2⁻²³. An entry of the placement's axes carries 7ε. Each of the two
/// products multiplies (ε), adds twice (2ε), and adds the translation (ε). Their sum is 15ε, and half of it again on
/// the host: 2.7e-6, rounded up.
pub const ATTACH_BOUND: f32 = 3e-6;
