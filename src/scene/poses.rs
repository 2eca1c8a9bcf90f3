//! Buffers that hold poses.

use crate::animation::crowd::Local;
use crate::gpu::Buffer;

/// Buffers with the pose of an instance, for the caller's kernels; they also hold other instances of its object.
/// [`Poses::write`](crate::scene::Poses::write) writes from the host. The buffers stay the same from frame to frame until
/// one of three events: the object grows, its visible instances exceed a binding of the device, or
/// [`Scene::refresh`](crate::scene::Scene::refresh) is called.
#[derive(Debug, Clone, Copy)]
pub struct PoseBuffers<'a> {
    /// The local transform of each bone, in its parent's space: three `vec4<f32>` at 3 · (instance · bones + bone), where
    /// `instance` is [`PoseBuffers::index`]. The first vector holds the translation and the scale along x. The second holds
    /// the rotation, a unit quaternion (x, y, z, w). The third holds the scale along y and z in its first two components.
    /// Use: read-write storage.
    pub locals: &'a Buffer<Local>,
    /// The model matrices of the frame before: three `vec4<f32>` at 3 · (instance · bones + bone), the rows of the
    /// transform from bone space to model space. Use: read-only storage.
    pub model_matrices: &'a wgpu::Buffer,
    /// Number of bones of the skeleton.
    pub bones: u32,
    /// Number of instances there is room for.
    pub instances: u32,
    /// The instance's index in these buffers.
    pub index: u32,
}
