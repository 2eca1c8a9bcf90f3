//! Kinds of objects that the caller adds: grass, particles, imposters, whatever the library does not know.
//!
//! A kind is a type that implements [`Kind`] and one WGSL text ([`KindProgram`]). The scene selects its instances as it selects
//! all others (views, culling, levels of detail, masks), and renderers draw it in every layer. `examples/kind/` is one.

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

/// A kind of object: what the instances of one object share, on the host and on the device.
///
/// [`Scene::add_kind`](crate::scene::Scene::add_kind) adds an object of it, [`Scene::spawn`](crate::scene::Scene::spawn) its
/// instances. What these functions return must stay the same while the scene has the object.
pub trait Kind: Debug + wgpu::WasmNotSendSync + 'static {
    /// The shader.
    fn program(&self) -> &KindProgram;

    /// The triangles of all levels and parts, as `u32` indices of vertices: counter-clockwise seen from outside. The buffer has
    /// the usage `INDEX`.
    fn indices(&self) -> &wgpu::Buffer;

    /// The parts, at least one. Each takes a draw for each level.
    fn parts(&self) -> &[KindPart];

    /// The error of each level of detail in the model's units: 0 for the first, ascending, at most 8. A view draws the coarsest
    /// level whose error [`Quality::pixels`](crate::scene::Quality) allows.
    fn errors(&self) -> &[f32] {
        &[0.0]
    }

    /// A sphere around everything that an instance draws, in the model's space. Views do not draw instances whose spheres they
    /// do not see.
    fn bounding_sphere(&self) -> BoundingSphere;

    /// Writes what has changed since the last frame; [`Scene::record`](crate::scene::Scene::record) calls it.
    ///
    /// # Errors
    /// Those of [`KindUploads::write`], and the kind's own. The frame is not recorded then.
    fn upload(&mut self, frame: &KindFrame, uploads: &mut KindUploads<'_>) -> Result<(), Error> {
        let _ = (frame, uploads);
        Ok(())
    }

    /// The same kind on another device, after its own was lost ([`Scene::rebuild`](crate::scene::Scene::rebuild)).
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`], and the kind's own. The scene stays as it was then.
    fn rebuild(&self, gpu: &Gpu) -> Result<Box<dyn Kind>, Error>;

    /// Where a ray hits an instance first, for [`Scene::pick`](crate::scene::Scene::pick). The default is the bounding sphere, from
    /// outside.
    fn hit(&self, ray: &KindRay) -> Option<KindHit> {
        let sphere = self.bounding_sphere();
        let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
        let from = ray.origin - center;
        let (a, b) = (ray.direction.length_squared(), from.dot(ray.direction));
        let inside = b * b - a * (from.length_squared() - radius * radius);
        let distance = (-b - inside.sqrt()) / a;
        // False for a ray that misses, whose root is NaN.
        (distance >= 0.0).then(|| KindHit { distance, normal: from + distance * ray.direction })
    }
}

/// A part of a kind: triangles with resources and pipelines of their own.
#[derive(Debug, Clone)]
pub struct KindPart {
    /// Bind group 2: [`KindProgram::bind`].
    pub group: wgpu::BindGroup,
    /// For each level of detail, the range of [`Kind::indices`] that is drawn; it may be empty.
    pub levels: Vec<Range<u32>>,
    /// Whether pixels with `Surface.alpha` below `Surface.cutoff`, 0 unless it is set, are discarded.
    pub cut_out: bool,
    /// Whether it is drawn in [`Layer::Transparent`](crate::render::Layer::Transparent) alone, blended by `Surface.alpha`.
    pub blended: bool,
    /// Whether its depth is `Surface.depth` and not that of the triangles.
    pub own_depth: bool,
    /// Whether both sides of its triangles are seen.
    pub double_sided: bool,
}

impl KindPart {
    /// An opaque part, seen from outside.
    pub fn new(group: wgpu::BindGroup, levels: Vec<Range<u32>>) -> Self {
        Self { group, levels, cut_out: false, blended: false, own_depth: false, double_sided: false }
    }
}

/// The frame for which a kind writes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KindFrame {
    /// The time of the scene in seconds ([`Scene::time`](crate::scene::Scene::time)).
    pub seconds: f64,
    /// The same in the last frame, for velocities.
    pub last_seconds: f64,
    /// True if the kind must write everything again: in its first frame, after it grew, and after the scene started afresh
    /// ([`Scene::refresh`](crate::scene::Scene::refresh), a dropped encoder, another device).
    pub is_fresh: bool,
}

/// Takes the writes of a kind for a frame. They are recorded at the start of the frame in its encoder: each frame sees its own
/// values, also if several are submitted at once.
#[derive(Debug)]
pub struct KindUploads<'a>(pub(in crate::scene) &'a mut Staged);

impl KindUploads<'_> {
    /// Writes bytes into a buffer with the usage `COPY_DST`, from `offset` on.
    ///
    /// # Errors
    /// [`InputError`] for a buffer without that usage, for an offset or a length that is no multiple of 4, and for bytes that reach
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

/// A ray in the model's space of an instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KindRay {
    /// Where it begins.
    pub origin: DVec3,
    /// One world unit along the ray, in the model's space.
    pub direction: DVec3,
}

impl KindRay {
    /// Where it hits a triangle, from either side; `None` if it does not.
    pub fn triangle(&self, corners: [DVec3; 3]) -> Option<KindHit> {
        let [a, b, c] = corners;
        let distance = distance_to(corners.map(|corner| corner - self.origin), self.direction)?;
        Some(KindHit { distance, normal: (b - a).cross(c - a) })
    }
}

/// Where a ray hits an instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KindHit {
    /// The distance along the ray, in world units: the point is `origin + distance * direction`.
    pub distance: f64,
    /// The outward normal in the model's space, of any length but 0.
    pub normal: DVec3,
}
