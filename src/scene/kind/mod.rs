//! Caller-defined kinds of objects, such as grass, particles or imposters.
//!
//! A kind consists of a type that implements [`Kind`], and one WGSL text ([`KindProgram`]). The scene selects the instances
//! of a kind as it does for built-in kinds (views, culling, levels of detail, masks). Renderers draw them in every layer.
//! See `examples/kind/`.

mod own;

use std::fmt::Debug;
use std::ops::Range;

use glam::DVec3;

use crate::gpu::{Gpu, Staged, Upload as _};
use crate::mesh::ray::distance_to;
pub use crate::scene::program::KindProgram;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::{Error, InputError};
pub(in crate::scene) use own::OwnKind;

/// A kind of object: the data that all instances of one object share, on the host and on the device.
///
/// [`Scene::add_kind`](crate::scene::Scene::add_kind) adds an object of a kind, and
/// [`Scene::spawn`](crate::scene::Scene::spawn) its instances. The getters must return the same values as long as the scene
/// holds the object.
pub trait Kind: Debug + wgpu::WasmNotSendSync + 'static {
    /// The kind's shader.
    fn program(&self) -> &KindProgram;

    /// The triangles of all levels and parts, as `u32` vertex indices, counter-clockwise seen from outside. The buffer
    /// needs the usage `INDEX`.
    fn indices(&self) -> &wgpu::Buffer;

    /// The parts of the triangles, at least one. Each part takes one draw per level of detail.
    fn parts(&self) -> &[KindPart];

    /// The error of each level of detail in the model's units, ascending from 0; at most 8 levels. A view draws the
    /// coarsest level whose error is within [`Quality::pixels`](crate::scene::Quality).
    fn errors(&self) -> &[f32] {
        &[0.0]
    }

    /// A sphere, in model space, around everything that an instance draws. Views cull instances by this sphere.
    fn bounding_sphere(&self) -> BoundingSphere;

    /// Uploads the kind's changes since the last frame. [`Scene::record`](crate::scene::Scene::record) calls this function
    /// in each frame.
    ///
    /// # Errors
    /// The errors of [`KindUploads::write`], and errors of the kind itself. After an error, the frame is not recorded.
    fn upload(&mut self, frame: &KindFrame, uploads: &mut KindUploads<'_>) -> Result<(), Error> {
        let _ = (frame, uploads);
        Ok(())
    }

    /// Creates the same kind on another device, after the kind's device was lost
    /// ([`Scene::rebuild`](crate::scene::Scene::rebuild)).
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`], and errors of the kind itself. After an error, the scene is unchanged.
    fn rebuild(&self, gpu: &Gpu) -> Result<Box<dyn Kind>, Error>;

    /// The first point at which a ray hits an instance, for [`Scene::pick`](crate::scene::Scene::pick); `None` if the ray
    /// misses. The default is the point at which the ray enters the bounding sphere.
    fn hit(&self, ray: &KindRay) -> Option<KindHit> {
        let sphere = self.bounding_sphere();
        let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
        let from = ray.origin - center;
        let (a, b) = (ray.direction.length_squared(), from.dot(ray.direction));
        let inside = b * b - a * (from.length_squared() - radius * radius);
        let distance = (-b - inside.sqrt()) / a;
        // For a ray that misses, the root and the distance are NaN, and the comparison is false.
        (distance >= 0.0).then(|| KindHit { distance, normal: from + distance * ray.direction })
    }
}

/// A part of a kind: triangles with their own resources and pipelines.
#[derive(Debug, Clone)]
pub struct KindPart {
    /// Bind group 2, from [`KindProgram::bind`].
    pub group: wgpu::BindGroup,
    /// Range of indices in [`Kind::indices`] to draw, per level of detail. A range may be empty.
    pub levels: Vec<Range<u32>>,
    /// Whether pixels with `Surface.alpha` below `Surface.cutoff` are discarded. The cutoff is 0 unless the shader sets it.
    pub cut_out: bool,
    /// Whether the part is drawn only in [`Layer::Transparent`](crate::render::Layer::Transparent), blended by
    /// `Surface.alpha`.
    pub blended: bool,
    /// Whether the part writes `Surface.depth` instead of the depth of its triangles.
    pub own_depth: bool,
    /// Whether both sides of the triangles are visible.
    pub double_sided: bool,
}

impl KindPart {
    /// An opaque, single-sided part.
    pub fn new(group: wgpu::BindGroup, levels: Vec<Range<u32>>) -> Self {
        Self { group, levels, cut_out: false, blended: false, own_depth: false, double_sided: false }
    }
}

/// Times of the frame in which a kind uploads its changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KindFrame {
    /// The scene's time in seconds ([`Scene::time`](crate::scene::Scene::time)).
    pub seconds: f64,
    /// The scene's time in the last frame, for velocities.
    pub last_seconds: f64,
    /// Whether the kind must write everything again: in its first frame, after its object grew, and if the scene starts afresh
    /// ([`Scene::refresh`](crate::scene::Scene::refresh), a dropped encoder, another device).
    pub is_fresh: bool,
}

/// Collects a kind's buffer writes for a frame. The writes are recorded into the frame's encoder, at the start of the frame.
/// Each frame therefore sees its own values, even if several frames are submitted at once.
#[derive(Debug)]
pub struct KindUploads<'a>(pub(in crate::scene) &'a mut Staged);

impl KindUploads<'_> {
    /// Writes `bytes` into a buffer, from byte `offset` on. The buffer needs the usage `COPY_DST`.
    ///
    /// # Errors
    /// [`InputError`] for a buffer without that usage, for an offset or a length that is not a multiple of 4, and for bytes
    /// beyond the buffer's end.
    pub fn write(&mut self, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) -> Result<(), Error> {
        let length = bytes.len() as u64;
        if !buffer.usage().contains(wgpu::BufferUsages::COPY_DST) {
            let value = format!("{:?}", buffer.usage());
            return Err(InputError::new("buffer.usage", value, "must have COPY_DST").into());
        }
        for (path, value) in [("offset", offset), ("bytes.len", length)] {
            if !value.is_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT) {
                return Err(InputError::new(path, value, "must be a multiple of 4").into());
            }
        }
        if offset.checked_add(length).is_none_or(|end| end > buffer.size()) {
            let bound = format!("must end within the {} bytes of the buffer", buffer.size());
            return Err(InputError::new("bytes", format!("{length} bytes from {offset} on"), bound).into());
        }
        Ok(self.0.bytes(buffer, offset, bytes)?)
    }
}

/// A ray in the model space of an instance, for [`Kind::hit`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KindRay {
    /// The start of the ray.
    pub origin: DVec3,
    /// The ray's direction in model space. Its length is one world unit, converted to model space.
    pub direction: DVec3,
}

impl KindRay {
    /// The point at which the ray hits a triangle, from either side; `None` if it misses. `corners` are in model space.
    pub fn triangle(&self, corners: [DVec3; 3]) -> Option<KindHit> {
        let [a, b, c] = corners;
        let distance = distance_to(corners.map(|corner| corner - self.origin), self.direction)?;
        Some(KindHit { distance, normal: (b - a).cross(c - a) })
    }
}

/// The point at which a ray hits an instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KindHit {
    /// The distance along the ray in world units. The hit point is `origin + distance * direction`.
    pub distance: f64,
    /// The outward normal in model space, of any length but 0.
    pub normal: DVec3,
}
