//! Buffers that hold poses.

use crate::animation::crowd::Local;
use crate::gpu::Buffer;

/// Buffers with the poses of an instance and of other instances of the same object, for the caller's kernels.
/// [`PoseBuffers::index`] is the instance's index in these buffers. To write poses from the host, use
/// [`Poses::write`](crate::scene::Poses::write) instead.
///
/// The buffers stay the same from frame to frame until one of three events: the object grows, its visible instances
/// exceed a binding of the device, or [`Scene::refresh`](crate::scene::Scene::refresh) is called.
#[derive(Debug, Clone, Copy)]
pub struct PoseBuffers<'a> {
    /// The local transform of each bone, relative to the bone's parent. A transform takes three `vec4<f32>`, from index
    /// 3 · (instance · bones + bone) on, where `instance` is [`PoseBuffers::index`]. The first vector holds the
    /// translation and the scale along x. The second holds the rotation, a unit quaternion (x, y, z, w). The third
    /// holds the scale along y and z in its first two components. Use: read-write storage.
    pub locals: &'a Buffer<Local>,
    /// The model matrix of each bone in the previous frame: the transform from bone space to model space. A matrix has
    /// three rows, each a `vec4<f32>`, from index 3 · (instance · bones + bone) on. Use: read-only storage.
    pub model_matrices: &'a wgpu::Buffer,
    /// Number of bones of all of the character's skeletons. Those of the whole skeleton come first.
    pub bones: u32,
    /// Number of instances that fit into the buffers.
    pub instances: u32,
    /// Index of the requested instance in these buffers.
    pub index: u32,
}
