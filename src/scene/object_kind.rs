//! The interface of a scene to its kinds of objects: terrain, meshes, reliefs, characters and caller-defined kinds.

use std::any::Any;
use std::fmt::Debug;
use std::pin::Pin;

use glam::{DAffine3, DVec3, Vec3};

use crate::animation::Frame;
use crate::gpu::{Gpu, Group, Staged};
use crate::lod::assign::AssignPass;
use crate::lod::{LodObject, SceneInstance, SelectView};
use crate::scene::camera::Camera;
use crate::scene::chunk::Chunk;
use crate::scene::layout::Layout;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::Looks;
use crate::scene::quality::ErrorBudget;
use crate::scene::ray::{Surface, SurfaceHit};
use crate::scene::stage::Stage;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::{Error, InputError};

/// A kind of object. The default methods suit static objects with spawned instances.
pub(super) trait ObjectKind: Any + Debug + wgpu::WasmNotSendSync {
    /// Name of the kind in errors.
    fn name(&self) -> &'static str;

    /// Whether the caller spawns the instances; otherwise the kind has its own.
    fn is_spawned(&self) -> bool {
        true
    }

    /// Whether instances can be attached to bones of characters.
    fn is_attachable(&self) -> bool {
        false
    }

    /// The corners of a box around the model at rest; `None` for a cube around the object's sphere.
    fn model_box(&self) -> Option<[Vec3; 2]> {
        None
    }

    /// A sphere around an instance in all of its motion; `None` for the object's sphere.
    fn sphere_of(&self, index: u32) -> Option<BoundingSphere> {
        let _ = index;
        None
    }

    /// Notes that an instance was spawned. Returns a sphere around it if that differs from the object's.
    fn spawned(&mut self, index: u32) -> Option<BoundingSphere> {
        let _ = index;
        None
    }

    /// Notes that an instance was removed.
    fn despawned(&mut self, index: u32) {
        let _ = index;
    }

    // On the device.

    /// Makes room for `capacity` instances, all of which start afresh. Changes nothing if it fails.
    fn renew(
        &mut self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        capacity: usize,
        chunks: &mut Vec<Chunk>,
    ) -> Result<(), Error> {
        let _ = (gpu, layouts);
        chunks.iter_mut().for_each(|chunk| chunk.slots = 0..capacity);
        Ok(())
    }

    /// Creates the kind's resources on another device, with the object's materials and room for `capacity` instances.
    fn made_on<'a>(&'a self, target: MakeOn<'a>) -> Making<'a>;

    /// Takes the resources besides chunks that were made on another device: [`OnDevice::other`].
    fn adopt(&mut self, other: Box<dyn Made>) {
        let _ = other;
    }

    /// Sets whether motion history is kept, once the object is refreshed.
    fn keep_last(&mut self, keeps: bool) {
        let _ = keeps;
    }

    /// The kind's resources for one view, which become bind group 1 there. `None` if group 1 is the same in all views.
    /// `number` is the object's number.
    fn in_view(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        number: u32,
    ) -> Result<Option<Box<dyn KindInView>>, Error> {
        let _ = (gpu, layouts, number);
        Ok(None)
    }

    // In a frame, in this order.

    /// Finishes fades that end by scene time `now`. Returns the instances whose spheres changed.
    fn settle(&mut self, now: f64) -> Vec<u32> {
        let _ = now;
        Vec::new()
    }

    /// Allocates the memory that a frame's views need.
    fn provide(
        &mut self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        seen: &SeenBy<'_>,
        chunks: &mut Vec<Chunk>,
    ) -> Result<Provided, Error> {
        let _ = (gpu, layouts, seen, chunks);
        Ok(Provided::default())
    }

    /// Prepares the jobs of a frame.
    fn fit(&mut self, gpu: &Gpu, fitted: &Fitted<'_>, staged: &mut Staged) -> Result<(), Error> {
        let _ = (gpu, fitted, staged);
        Ok(())
    }

    /// Stages the changes since the last frame. `now` is the scene's time in seconds.
    fn stage(&mut self, staged: &mut Staged, frame: &Frame, now: f64) -> Result<(), Error> {
        let _ = (staged, frame, now);
        Ok(())
    }

    /// Records copies and jobs that precede the stages of the frame.
    fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let _ = encoder;
    }

    /// Adds a stage to a compute pass.
    fn dispatch(&self, stage: Stage, pass: &mut wgpu::ComputePass<'_>) {
        let _ = (stage, pass);
    }

    // On the host.

    /// The triangles of an instance in full detail, at scene time `now`.
    fn surfaces(&self, index: u32, now: f64) -> Result<Vec<Surface<'_>>, InputError> {
        let _ = (index, now);
        Ok(Vec::new())
    }

    /// The first hit of an instance by a ray, within the ray's limit.
    fn hit(&self, instance: &Placed, ray: &UnitRay) -> Result<Option<SurfaceHit>, InputError> {
        let UnitRay { origin, direction, limit } = *ray;
        let surfaces = self.surfaces(instance.index, instance.now)?;
        let hits = surfaces.iter().map(|surface| surface.hit(instance.place, [origin, direction], limit));
        Ok(hits.fold(None, SurfaceHit::nearer))
    }

    /// The corners of the smallest box around an instance, in the space of its place.
    fn tight_box(&self, instance: &Placed) -> Result<[DVec3; 2], InputError> {
        let surfaces = self.surfaces(instance.index, instance.now)?;
        let boxes = surfaces.iter().map(|surface| surface.bounds(instance.place));
        let around = boxes.reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)]);
        Ok(around.unwrap_or([instance.place.translation; 2]))
    }

    /// The corners of a looser but cheaper box; `None` if the smallest is as cheap.
    fn wide_box(&self, instance: &Placed) -> Result<Option<[DVec3; 2]>, InputError> {
        let _ = instance;
        Ok(None)
    }

    /// Whether an instance may extend beyond its sphere. Rays are then tested against its looser box.
    fn may_leave_sphere(&self, index: u32) -> bool {
        let _ = index;
        false
    }
}

impl dyn ObjectKind {
    /// The kind as `K`, if it is one.
    pub fn downcast<K: ObjectKind>(&self) -> Option<&K> {
        (self as &dyn Any).downcast_ref()
    }

    /// Mutable form of `downcast`.
    pub fn downcast_mut<K: ObjectKind>(&mut self) -> Option<&mut K> {
        (self as &mut dyn Any).downcast_mut()
    }
}

/// A kind's resources for one view.
pub(super) trait KindInView: Debug + wgpu::WasmNotSendSync {
    /// Bind group 1.
    fn group(&self) -> &Group;

    /// Stages the resources for a frame of the view's camera.
    fn stage(&self, staged: &mut Staged, camera: &Camera) -> Result<(), Error>;
}

/// A future that creates resources on another device. Natively, it may move to another thread.
#[cfg(not(target_arch = "wasm32"))]
pub(super) type Making<'a> = Pin<Box<dyn Future<Output = Result<OnDevice, Error>> + Send + 'a>>;
/// A future that creates resources on another device.
#[cfg(target_arch = "wasm32")]
pub(super) type Making<'a> = Pin<Box<dyn Future<Output = Result<OnDevice, Error>> + 'a>>;

/// Where the resources of an object are made again.
#[derive(Debug, Clone, Copy)]
pub(super) struct MakeOn<'a> {
    pub gpu: &'a Gpu,
    pub layouts: &'a SceneLayouts,
    /// Materials of the object, if it has any.
    pub looks: Option<&'a Looks>,
    /// Number of instances that there is room for.
    pub capacity: usize,
}

/// Any resource made on a device.
pub(super) trait Made: Any + Debug + wgpu::WasmNotSend {}

impl<T: Any + Debug + wgpu::WasmNotSend> Made for T {}

/// Device resources of an object.
#[derive(Debug)]
pub(super) struct OnDevice {
    pub chunks: Vec<Chunk>,
    /// The kind's resources besides chunks ([`ObjectKind::adopt`]).
    pub other: Box<dyn Made>,
}

impl OnDevice {
    /// Chunks without other resources.
    pub fn chunks(chunks: Vec<Chunk>) -> Self {
        Self { chunks, other: Box::new(()) }
    }
}

/// Inputs for deciding which of an object's instances a frame's views may see.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeenBy<'a> {
    pub views: &'a [SelectView],
    /// The object, with the scale of its metric before the LOD bias of memory.
    pub object: &'a LodObject,
    pub instances: &'a [SceneInstance],
    /// The scene's time in seconds.
    pub now: f64,
}

/// Result of providing memory for a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Provided {
    /// LOD bias of the object: 1 unless memory has ended.
    pub lod_bias: f32,
    pub replaced: Replaced,
}

impl Default for Provided {
    fn default() -> Self {
        Self { lod_bias: 1.0, replaced: Replaced::Nothing }
    }
}

/// Resources that were replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Replaced {
    Nothing,
    /// Buffers of some chunks.
    Buffers,
    /// The chunks themselves. Instances of divided chunks start afresh.
    Chunks,
}

/// Inputs for preparing a kind's jobs of a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fitted<'a> {
    pub layout: &'a Layout,
    /// Whether the layout changed since the last frame.
    pub is_new: bool,
    pub assign: &'a AssignPass,
    pub budget: ErrorBudget,
    pub chunks: &'a [Chunk],
}

/// An instance at its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub index: u32,
    /// The scene's time in seconds.
    pub now: f64,
    /// The transform from model space to the cell's corner.
    pub place: DAffine3,
    pub cell: [i32; 3],
    /// The corners of a box around the placed bounding sphere.
    pub sphere_box: [DVec3; 2],
}

/// A ray relative to a cell's corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitRay {
    pub origin: DVec3,
    /// Of length 1.
    pub direction: DVec3,
    /// The largest distance of a hit.
    pub limit: f64,
}
