//! Placements of meshes that are attached to bones: in each view, a mesh follows the bone of a character as the frame posed it.
//!
//! [`select`](super::select) runs before the bones of a frame are known. An attached instance is therefore selected by its
//! character's placement and a sphere that holds the mesh wherever the bone may be, and this operation replaces the rows that the
//! selection wrote by the product of the character's placement, the bone's model matrix and the mesh's offset. Where no
//! view of the frame sees the character, its bones are not posed, and the mesh becomes a point.
//!
//! If the scene keeps its last frame, the operation also keeps the product of bone and offset, of the frame and of the one
//! before, and writes the transform that the mesh had then. A mesh whose character was not seen then, or that was attached
//! since, counts as if its bone had been where it is.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{AttachBuffers, AttachPass};

pub use crate::shared::lod::attach::{AttachParams, Attachment, KeptBone, NO_MESH};

/// The largest difference allowed between an entry of a row and the reference, on any device, relative to the same entry of
/// the product of the three transforms with all their entries' absolute values. With ε = 2⁻²³, to which every
/// operation may round on a device, an entry of the placement's axes carries 7ε; each of the two products multiplies (ε), adds
/// twice (2ε), and adds the translation (ε): 15ε, and half of that on the host: 2.7e-6, rounded up.
pub const ATTACH_BOUND: f32 = 3e-6;
