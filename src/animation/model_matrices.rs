//! Model matrices of a crowd's bones on the device, with the record of the matrices that frames update and of the consumers
//! that were prepared.

use std::sync::{Arc, OnceLock};

use crate::InputError;
use crate::animation::updated_bones::UpdatedBones;
use crate::asset::Affine;
use crate::gpu::{Buffer, Gpu, GpuError};

/// Handle to the model matrices of instances' bones, at `instance · bones + bone`. Clones share the buffer and the record of
/// prepared consumers.
///
/// A crowd under [`Gate::Bounded`](super::Gate::Bounded) cannot be skinned by dual quaternions, because the gate's bound holds
/// for linear blending only. Whichever of the two is prepared first excludes the other, as long as a handle exists.
#[derive(Debug, Clone)]
pub struct ModelMatrices {
    matrices: Buffer<Affine>,
    updated_bones: Option<UpdatedBones>,
    consumer: ExclusiveConsumer,
}

impl ModelMatrices {
    /// Wraps matrices that the caller writes; all of them may change in every frame. For a crowd's matrices, use
    /// [`Crowd::model_matrices`](super::crowd::Crowd::model_matrices).
    pub fn new(matrices: &Buffer<Affine>) -> Self {
        Self { matrices: matrices.clone(), updated_bones: None, consumer: ExclusiveConsumer::default() }
    }

    /// The same matrices with a record of updates: frames change only matrices whose bit is set in `updated`.
    #[must_use]
    pub fn with_updated_bones(&self, updated: &UpdatedBones) -> Self {
        Self { updated_bones: Some(updated.clone()), ..self.clone() }
    }

    /// Bones updated since skinning last followed them. `None` means that any matrix may have changed.
    pub fn updated_bones(&self) -> Option<&UpdatedBones> {
        self.updated_bones.as_ref()
    }

    /// The wgpu buffer, to bind or to copy: three rows of four `f32` per matrix.
    pub fn raw(&self) -> &wgpu::Buffer {
        self.matrices.raw()
    }

    /// Reads the matrices; see [`Buffer::read`].
    ///
    /// # Errors
    /// Errors of the device.
    pub async fn read(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.matrices.read(gpu).await
    }

    /// As [`ModelMatrices::read`], but blocks; see [`Buffer::read_blocking`].
    ///
    /// # Errors
    /// Errors of the device, or [`GpuError::Hung`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_blocking(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.matrices.read_blocking(gpu)
    }

    /// The typed buffer. It is not public, because a second handle made from it would not share the record.
    pub fn buffer(&self) -> &Buffer<Affine> {
        &self.matrices
    }

    /// The record of prepared consumers, shared by all handles to these matrices.
    pub(crate) fn consumer(&self) -> &ExclusiveConsumer {
        &self.consumer
    }
}

/// A use of model matrices that excludes the other use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Consumer {
    /// A gate that bounds the error of linearly blended vertices.
    BoundedGate,
    /// Dual quaternion skinning.
    DualQuaternions,
}

/// The first [`Consumer`] that was prepared.
#[derive(Debug, Clone, Default)]
pub(crate) struct ExclusiveConsumer(Arc<OnceLock<Consumer>>);

impl ExclusiveConsumer {
    /// Records a consumer permanently.
    ///
    /// # Errors
    /// [`InputError`] if the other consumer came first.
    pub(crate) fn claim(&self, consumer: Consumer) -> Result<(), InputError> {
        refuse_other(*self.0.get_or_init(|| consumer), consumer)
    }

    /// Checks like [`ExclusiveConsumer::claim`], but records nothing.
    ///
    /// # Errors
    /// [`InputError`] if the other consumer came first.
    pub(crate) fn check(&self, consumer: Consumer) -> Result<(), InputError> {
        self.0.get().map_or(Ok(()), |first| refuse_other(*first, consumer))
    }

    /// Refuses a list of active bones of another crowd, because that crowd would not know of the gate's bound.
    ///
    /// # Errors
    /// [`InputError`] for another crowd.
    pub(crate) fn check_same(&self, of_list: &Self) -> Result<(), InputError> {
        if Arc::ptr_eq(&self.0, &of_list.0) {
            return Ok(());
        }
        Err(InputError::new("crowd", "another", "must be the one that the active bones were made for"))
    }
}

fn refuse_other(first: Consumer, consumer: Consumer) -> Result<(), InputError> {
    match consumer {
        _ if first == consumer => Ok(()),
        Consumer::DualQuaternions => {
            let bound = "must be Linear under the gate Bounded, whose bound holds for linear blending alone";
            Err(InputError::new("blend", "DualQuaternion", bound))
        }
        Consumer::BoundedGate => {
            let bound = "must not be Bounded, whose bound holds for linear blending alone: dual quaternions blend the crowd";
            Err(InputError::new("gate", "Bounded", bound))
        }
    }
}
