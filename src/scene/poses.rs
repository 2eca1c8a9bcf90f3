//! The buffers that hold poses.

use crate::animation::crowd::Local;
use crate::gpu::Buffer;

/// The buffers that hold the pose of an instance, among those of others of its object, for kernels of the caller;
/// [`Poses::write`](crate::scene::Poses::write) writes from the host. They are the same from frame to frame,
/// until the object grows, what is seen of it exceeds a binding of the device, or [`Scene::refresh`](crate::scene::Scene::refresh) is
/// called.
#[derive(Debug, Clone, Copy)]
pub struct PoseBuffers<'a> {
    /// The local transform of each bone, in its parent's space: three `vec4<f32>` at 3 · (instance · bones + bone), where
    /// `instance` is [`PoseBuffers::index`]. The first holds the translation and the scale along x, the second the rotation, a
    /// unit quaternion (x, y, z, w), and the third the scale along y and z in its first two components. Storage, to
    /// be read and written.
    pub locals: &'a Buffer<Local>,
    /// The model matrices of the frame before: three `vec4<f32>` at 3 · (instance · bones + bone), the rows of the transform
    /// from the bone's space to the model's. Storage, to be read.
    pub model_matrices: &'a wgpu::Buffer,
    /// Number of bones of the skeleton.
    pub bones: u32,
    /// Number of instances that there is room for.
    pub instances: u32,
    /// The instance's number in these buffers.
    pub index: u32,
}
