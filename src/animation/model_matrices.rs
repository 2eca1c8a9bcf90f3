//! Model matrices of a crowd's bones on the device. The handle also records which matrices frames updated, and which consumers
//! were prepared.

use std::sync::{Arc, OnceLock};

use crate::InputError;
use crate::animation::updated_bones::UpdatedBones;
use crate::asset::Affine;
use crate::gpu::{Buffer, Gpu, GpuError};

/// Handle to the model matrices of all instances' bones, at index `instance · bones + bone`. Clones share the buffer and the
/// record of prepared consumers.
///
/// A crowd under [`Gate::Bounded`](super::Gate::Bounded) cannot be skinned by dual quaternions, because the gate's error bound
/// holds for linear blending only. Preparing one of the two therefore excludes the other, as long as any handle exists.
#[derive(Debug, Clone)]
pub struct ModelMatrices {
    matrices: Buffer<Affine>,
    updated_bones: Option<UpdatedBones>,
    consumer: ExclusiveConsumer,
}

impl ModelMatrices {
    /// Wraps matrices that the caller writes. Consumers assume that all of them may change in every frame. For a crowd's
    /// matrices, use [`Crowd::model_matrices`](super::crowd::Crowd::model_matrices).
    pub fn new(matrices: &Buffer<Affine>) -> Self {
        Self { matrices: matrices.clone(), updated_bones: None, consumer: ExclusiveConsumer::default() }
    }

    /// Returns a handle to the same matrices, with a record of updates. Consumers of this handle assume that frames change only
    /// matrices whose bit is set in `updated`.
    #[must_use]
    pub fn with_updated_bones(&self, updated: &UpdatedBones) -> Self {
        Self { updated_bones: Some(updated.clone()), ..self.clone() }
    }

    /// Record of the bones that were updated since they were last skinned. `None` means that any matrix may have changed.
    pub fn updated_bones(&self) -> Option<&UpdatedBones> {
        self.updated_bones.as_ref()
    }

    /// The wgpu buffer of the matrices, to bind or to copy. Each matrix has three rows of four `f32`.
    pub fn raw(&self) -> &wgpu::Buffer {
        self.matrices.raw()
    }

    /// Reads the matrices back to the host; see [`Buffer::read`].
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub async fn read(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.matrices.read(gpu).await
    }

    /// Reads the matrices back like [`ModelMatrices::read`], but blocks; see [`Buffer::read_blocking`].
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device, including [`GpuError::Hung`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_blocking(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.matrices.read_blocking(gpu)
    }

    /// The typed buffer. Wrapping it in a second [`ModelMatrices`] loses the record of prepared consumers.
    pub fn buffer(&self) -> &Buffer<Affine> {
        &self.matrices
    }

    /// Record of prepared consumers, shared by all handles to these matrices.
    pub(crate) fn consumer(&self) -> &ExclusiveConsumer {
        &self.consumer
    }
}

/// Uses of model matrices that exclude each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Consumer {
    /// A gate that bounds the error of linearly blended vertices: `Gate::Bounded`.
    BoundedGate,
    /// Dual quaternion skinning.
    DualQuaternions,
}

/// The first [`Consumer`] that was prepared; empty if there is none yet.
#[derive(Debug, Clone, Default)]
pub(crate) struct ExclusiveConsumer(Arc<OnceLock<Consumer>>);

impl ExclusiveConsumer {
    /// Records a consumer permanently. The other kind of consumer is refused from then on.
    ///
    /// # Errors
    /// [`InputError`] if the other kind of consumer was recorded first.
    pub(crate) fn claim(&self, consumer: Consumer) -> Result<(), InputError> {
        refuse_other(*self.0.get_or_init(|| consumer), consumer)
    }

    /// Performs the check of [`ExclusiveConsumer::claim`] without recording the consumer.
    ///
    /// # Errors
    /// [`InputError`] if the other kind of consumer was recorded first.
    pub(crate) fn check(&self, consumer: Consumer) -> Result<(), InputError> {
        self.0.get().map_or(Ok(()), |first| refuse_other(*first, consumer))
    }

    /// Returns an error if a list of active bones belongs to another crowd. With such a list, the gate's error bound would not be
    /// recorded for this crowd.
    ///
    /// # Errors
    /// [`InputError`] if `of_list` and `self` are not one shared record.
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
