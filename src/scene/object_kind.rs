//! What an object is: what a scene asks of terrain, meshes, reliefs, characters and kinds of the caller's alike.

use std::any::Any;
use std::fmt::Debug;
use std::pin::Pin;

use glam::{DAffine3, DVec3};

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

/// What an object is. The methods that have a body are for what is drawn as it is, at rest, of instances that are spawned.
pub(super) trait ObjectKind: Any + Debug + wgpu::WasmNotSendSync {
    /// What errors call it.
    fn name(&self) -> &'static str;

    /// Whether the caller spawns its instances; else they are its own.
    fn is_spawned(&self) -> bool {
        true
    }

    /// Whether instances can be attached to bones of characters.
    fn is_attachable(&self) -> bool {
        false
    }

    /// A sphere around an instance as it moves; `None` for that of the object.
    fn sphere_of(&self, index: u32) -> Option<BoundingSphere> {
        let _ = index;
        None
    }

    /// An instance was spawned; returns a sphere around it if that is not the object's.
    fn spawned(&mut self, index: u32) -> Option<BoundingSphere> {
        let _ = index;
        None
    }

    /// An instance was removed.
    fn despawned(&mut self, index: u32) {
        let _ = index;
    }

    // On the device.

    /// Makes room for so many instances, all of which start afresh. If it fails, nothing has changed.
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

    /// Makes on another device what it has on its own, with the materials of the object and room for so many instances.
    fn made_on<'a>(
        &'a self,
        gpu: &'a Gpu,
        layouts: &'a SceneLayouts,
        looks: Option<&'a Looks>,
        capacity: usize,
    ) -> Making<'a>;

    /// Takes what was made on another device besides chunks: [`OnDevice::other`].
    fn adopt(&mut self, other: Box<dyn Made>) {
        let _ = other;
    }

    /// Keeps the last frame, once it is refreshed, or does no longer.
    fn keep_last(&mut self, keeps: bool) {
        let _ = keeps;
    }

    /// What it has in a view by itself, which is bind group 1 there; `None` if its group is the same in all views. `number` is
    /// that of the object.
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

    /// Ends what has reached its end by a time of the scene; returns the instances whose spheres are others.
    fn settle(&mut self, now: f64) -> Vec<u32> {
        let _ = now;
        Vec::new()
    }

    /// Provides what the views of a frame need.
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

    /// Prepares what a frame needs.
    fn fit(&mut self, gpu: &Gpu, fitted: &Fitted<'_>, staged: &mut Staged) -> Result<(), Error> {
        let _ = (gpu, fitted, staged);
        Ok(())
    }

    /// Stages the fraction of the allowed displacement that levels of detail use, after it has changed.
    fn stage_mesh_fraction(&self, staged: &mut Staged, fraction: f32) -> Result<(), Error> {
        let _ = (staged, fraction);
        Ok(())
    }

    /// Stages what has changed since the last frame; `now` is the time of the scene in seconds.
    fn stage(&mut self, staged: &mut Staged, frame: &Frame, now: f64) -> Result<(), Error> {
        let _ = (staged, frame, now);
        Ok(())
    }

    /// Records what comes before the stages of the frame.
    fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let _ = encoder;
    }

    /// Adds a stage to a compute pass.
    fn dispatch(&self, stage: Stage, pass: &mut wgpu::ComputePass<'_>) {
        let _ = (stage, pass);
    }

    // On the host.

    /// The triangles of an instance at a time of the scene, in full detail.
    fn surfaces(&self, index: u32, now: f64) -> Result<Vec<Surface<'_>>, InputError> {
        let _ = (index, now);
        Ok(Vec::new())
    }

    /// The first hit of an instance by a ray, up to a distance.
    fn hit(&self, instance: &Placed, ray: &UnitRay) -> Result<Option<SurfaceHit>, InputError> {
        let UnitRay { origin, direction, limit } = *ray;
        let surfaces = self.surfaces(instance.index, instance.now)?;
        let hits = surfaces.iter().map(|surface| surface.hit(instance.place, [origin, direction], limit));
        Ok(hits.fold(None, SurfaceHit::nearer))
    }

    /// The corners of the smallest box around an instance, in the space into which its place leads.
    fn tight_box(&self, instance: &Placed) -> Result<[DVec3; 2], InputError> {
        let surfaces = self.surfaces(instance.index, instance.now)?;
        let boxes = surfaces.iter().map(|surface| surface.bounds(instance.place));
        let around = boxes.reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)]);
        Ok(around.unwrap_or([instance.place.translation; 2]))
    }

    /// The corners of a larger box, which costs less; `None` if the smallest costs as little.
    fn wide_box(&self, instance: &Placed) -> Result<Option<[DVec3; 2]>, InputError> {
        let _ = instance;
        Ok(None)
    }

    /// Whether an instance may reach beyond its sphere, so that its larger box decides what a ray may hit.
    fn may_leave_sphere(&self, index: u32) -> bool {
        let _ = index;
        false
    }
}

impl dyn ObjectKind {
    /// The kind, if it is this one.
    pub fn downcast<K: ObjectKind>(&self) -> Option<&K> {
        (self as &dyn Any).downcast_ref()
    }

    /// As `downcast`, to be changed.
    pub fn downcast_mut<K: ObjectKind>(&mut self) -> Option<&mut K> {
        (self as &mut dyn Any).downcast_mut()
    }
}

/// What a kind has in a view by itself.
pub(super) trait KindInView: Debug + wgpu::WasmNotSendSync {
    /// Bind group 1.
    fn group(&self) -> &Group;

    /// Stages it for a frame of the view's camera.
    fn stage(&self, staged: &mut Staged, camera: &Camera) -> Result<(), Error>;
}

/// Something that is made on another device. Natively it may move to another thread meanwhile.
#[cfg(not(target_arch = "wasm32"))]
pub(super) type Making<'a> = Pin<Box<dyn Future<Output = Result<OnDevice, Error>> + Send + 'a>>;
/// Something that is made on another device.
#[cfg(target_arch = "wasm32")]
pub(super) type Making<'a> = Pin<Box<dyn Future<Output = Result<OnDevice, Error>> + 'a>>;

/// Anything that was made on a device.
pub(super) trait Made: Any + Debug + wgpu::WasmNotSend {}

impl<T: Any + Debug + wgpu::WasmNotSend> Made for T {}

/// What an object has on a device.
#[derive(Debug)]
pub(super) struct OnDevice {
    pub chunks: Vec<Chunk>,
    /// What the kind takes besides ([`ObjectKind::adopt`]).
    pub other: Box<dyn Made>,
}

impl OnDevice {
    /// Chunks alone.
    pub fn chunks(chunks: Vec<Chunk>) -> Self {
        Self { chunks, other: Box::new(()) }
    }
}

/// What the views of a frame may see of an object.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeenBy<'a> {
    pub views: &'a [SelectView],
    /// The object, with the fraction of the displacement that its levels use by themselves.
    pub object: &'a LodObject,
    pub instances: &'a [SceneInstance],
}

/// What was provided for a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Provided {
    /// The factor by which levels of detail must be coarser: 1 unless memory has ended.
    pub lod_bias: f32,
    pub replaced: Replaced,
}

impl Default for Provided {
    fn default() -> Self {
        Self { lod_bias: 1.0, replaced: Replaced::Nothing }
    }
}

/// What is another than before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Replaced {
    Nothing,
    /// Buffers of some chunks.
    Buffers,
    /// The chunks. The instances of those that were divided start afresh.
    Chunks,
}

/// For what a kind prepares itself in a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fitted<'a> {
    pub layout: &'a Layout,
    /// Whether the layout is another than in the last frame.
    pub is_new: bool,
    pub assign: &'a AssignPass,
    pub budget: ErrorBudget,
    /// The fraction of the allowed displacement that levels of detail use.
    pub mesh_fraction: f32,
    pub chunks: &'a [Chunk],
    /// For each level the metric from which on it is drawn.
    pub thresholds: &'a [f32],
}

/// An instance in a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub index: u32,
    /// The time of the scene.
    pub now: f64,
    /// The transform from the model's space to the corner of the cell.
    pub place: DAffine3,
    pub cell: [i32; 3],
    /// The corners of a box around its bounding sphere there.
    pub sphere_box: [DVec3; 2],
}

/// A ray relative to the corner of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitRay {
    pub origin: DVec3,
    /// Of length 1.
    pub direction: DVec3,
    /// The largest distance of a hit.
    pub limit: f64,
}
