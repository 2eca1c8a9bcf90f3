//! Model matrices of a crowd's bones on the device: which of them a frame updates, and what was prepared over them.

use std::sync::{Arc, OnceLock};

use crate::InputError;
use crate::asset::Affine;
use crate::gpu::{Buffer, Gpu, GpuError};

/// Model matrices of the bones of instances, `instance · bones + bone`: a handle. Clones share the buffer, and what was
/// prepared over it: a crowd under [`Gate::Bounded`](super::Gate::Bounded) cannot be skinned by dual quaternions, since
/// its bound holds for linear blending alone. Whichever of both is prepared first excludes the other, as long as there
/// is a handle.
#[derive(Debug, Clone)]
pub struct ModelMatrices {
    matrices: Buffer<Affine>,
    updated_bones: Option<Buffer<u32>>,
    consumer: ExclusiveConsumer,
}

impl ModelMatrices {
    /// Matrices that the caller writes, all of them up to date in every frame. Those of a crowd are
    /// [`Crowd::model_matrices`](super::crowd::Crowd::model_matrices).
    pub fn new(matrices: &Buffer<Affine>) -> Self {
        Self { matrices: matrices.clone(), updated_bones: None, consumer: ExclusiveConsumer::default() }
    }

    /// The same, of which those alone change in a frame that have their bit in this buffer, laid out as
    /// [`Active::updated_bones`](super::active::Active::updated_bones).
    #[must_use]
    pub fn with_updated_bones(&self, bits: &Buffer<u32>) -> Self {
        Self { updated_bones: Some(bits.clone()), ..self.clone() }
    }

    /// Another buffer of the same crowd: what is prepared over one of both is prepared over the other.
    pub(crate) fn beside(&self, matrices: Buffer<Affine>) -> Self {
        Self { matrices, updated_bones: None, consumer: self.consumer.clone() }
    }

    /// A bit for each slot of each instance whose matrix a frame updated, as
    /// [`Active::updated_bones`](super::active::Active::updated_bones). Without, any may have changed.
    pub fn updated_bones(&self) -> Option<&Buffer<u32>> {
        self.updated_bones.as_ref()
    }

    /// How many matrices.
    pub fn len(&self) -> usize {
        self.matrices.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.matrices.is_empty()
    }

    /// The wgpu buffer, to bind or to copy: three rows of four `f32` a matrix.
    pub fn raw(&self) -> &wgpu::Buffer {
        self.matrices.raw()
    }

    /// The matrices: see [`Buffer::read`].
    ///
    /// # Errors
    /// Whatever the device reports.
    pub async fn read(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.matrices.read(gpu).await
    }

    /// [`ModelMatrices::read`], blocking: see [`Buffer::read_blocking`].
    ///
    /// # Errors
    /// Whatever the device reports, or [`GpuError::Hung`].
    pub fn read_blocking(&self, gpu: &Gpu) -> Result<Vec<Affine>, GpuError> {
        self.matrices.read_blocking(gpu)
    }

    /// The buffer itself, which no caller gets: a second handle made of it would not know of the first.
    pub(crate) fn buffer(&self) -> &Buffer<Affine> {
        &self.matrices
    }

    /// Who was prepared over these matrices, shared by all handles to them.
    pub(crate) fn consumer(&self) -> &ExclusiveConsumer {
        &self.consumer
    }
}

/// What excludes other uses of the same model matrices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Consumer {
    /// A gate that bounds the error of what is blended linearly.
    BoundedGate,
    /// Skinning by dual quaternions.
    DualQuaternions,
}

/// The first [`Consumer`] that was prepared.
#[derive(Debug, Clone, Default)]
pub(crate) struct ExclusiveConsumer(Arc<OnceLock<Consumer>>);

impl ExclusiveConsumer {
    /// Prepares for a consumer, for good.
    ///
    /// # Errors
    /// [`InputError`] where the other one came first.
    pub(crate) fn claim(&self, consumer: Consumer) -> Result<(), InputError> {
        refuse_other(*self.0.get_or_init(|| consumer), consumer)
    }

    /// Refuses what [`ExclusiveConsumer::claim`] would, and prepares nothing.
    ///
    /// # Errors
    /// [`InputError`] where the other one came first.
    pub(crate) fn check(&self, consumer: Consumer) -> Result<(), InputError> {
        self.0.get().map_or(Ok(()), |first| refuse_other(*first, consumer))
    }

    /// Refuses a list of active bones that was made for another crowd: what a gate promises would not be known there.
    ///
    /// # Errors
    /// [`InputError`].
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
