//! What skinning takes of a crowd's animation: the model matrices of its bones, which of them a frame updated, and who
//! decides that.

use super::crowd::Crowd;
use super::decide::Choice;
use super::gate::Gate;
use crate::animation::active::Active;
use crate::asset::Affine;
use crate::gpu::Buffer;

/// Model matrices of the bones of a crowd's instances, as [`super::concat`] writes them, with what is known of them.
/// Clones share the buffers.
#[derive(Debug, Clone)]
pub struct ModelMatrices {
    matrices: Buffer<Affine>,
    updated_bones: Option<Buffer<u32>>,
    choice: Option<Choice>,
}

impl ModelMatrices {
    /// Matrices that are all up to date in every frame: `instance · bones + bone`. Of a crowd under a gate, take
    /// [`ModelMatrices::gated`].
    pub fn new(matrices: &Buffer<Affine>) -> Self {
        Self { matrices: matrices.clone(), updated_bones: None, choice: None }
    }

    /// The same, of which those alone change in a frame that have their bit in this buffer, which the caller writes as
    /// [`Active::dirty`] is laid out.
    #[must_use]
    pub fn with_updated_bones(self, bits: &Buffer<u32>) -> Self {
        Self { updated_bones: Some(bits.clone()), ..self }
    }

    /// Those of a crowd whose bones are chosen by a gate or a budget, as
    /// [`GatedFrame::model_matrices`](super::frame::GatedFrame::model_matrices) has them. Under [`Gate::Bounded`] they
    /// may be blended linearly alone.
    pub fn gated(crowd: &Crowd, active: &Active, choice: Choice) -> Self {
        Self { choice: Some(choice), ..Self::new(&crowd.models).with_updated_bones(&active.dirty) }
    }

    /// `instance · bones + bone`.
    pub fn matrices(&self) -> &Buffer<Affine> {
        &self.matrices
    }

    /// A bit for each slot of each instance whose matrix a frame updated, as [`Active::dirty`]. Without, any may have
    /// changed.
    pub fn updated_bones(&self) -> Option<&Buffer<u32>> {
        self.updated_bones.as_ref()
    }

    /// Whether they are off by what [`Gate::Bounded`] allows.
    pub fn are_bounded(&self) -> bool {
        self.choice == Some(Choice::Gate(Gate::Bounded))
    }
}
