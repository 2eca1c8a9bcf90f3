//! The interface between a scene and its kinds of objects: terrain, meshes, reliefs, characters and caller-defined
//! kinds.

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
use crate::scene::placement::Placement;
use crate::scene::quality::ErrorBudget;
use crate::scene::ray::{Surface, SurfaceHit};
use crate::scene::stage::Stage;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::{Error, InputError};

/// A kind of object. The default methods suit static objects whose instances the caller spawns.
pub(super) trait ObjectKind: Any + Debug + wgpu::WasmNotSendSync {
    /// The kind's name in error messages, such as `a mesh`.
    fn name(&self) -> &'static str;

    /// Whether the caller spawns the instances. If not, the kind creates them itself.
    fn is_spawned(&self) -> bool {
        true
    }

    /// Whether instances can be attached to bones of characters.
    fn is_attachable(&self) -> bool {
        false
    }

    /// The lowest and highest corner of a box around the model at rest, in model space. `None` means a cube around the
    /// object's bounding sphere.
    fn model_box(&self) -> Option<[Vec3; 2]> {
        None
    }

    /// A sphere that contains an instance in all of its motion. `None` means the object's bounding sphere.
    fn sphere_of(&self, index: u32) -> Option<BoundingSphere> {
        let _ = index;
        None
    }

    /// Is called when an instance is spawned. Returns the instance's bounding sphere if it differs from the object's.
    fn spawned(&mut self, index: u32) -> Option<BoundingSphere> {
        let _ = index;
        None
    }

    /// Is called when an instance is removed.
    fn despawned(&mut self, index: u32) {
        let _ = index;
    }

    /// Whether the kind's settings keep the error that views allow.
    fn is_bounded(&self) -> bool {
        true
    }

    /// Whether the last frame had all detail that its views asked for.
    fn is_complete(&self) -> bool {
        true
    }

    /// Whether an instance needs all bones of its skeleton, so that it cannot have a reduced one.
    fn needs_skeleton(&self, index: u32) -> bool {
        let _ = index;
        false
    }

    // Device resources.

    /// Allocates memory for the capacity in `target`, on the same device, and resets the state of all instances. If this
    /// fails, nothing changes.
    fn renew(&mut self, target: MakeOn<'_>, chunks: &mut Vec<Chunk>) -> Result<(), Error> {
        chunks.iter_mut().for_each(|chunk| chunk.slots = 0..target.capacity);
        Ok(())
    }

    /// Creates the kind's resources on another device, with the materials and the capacity in `target`.
    fn made_on<'a>(&'a self, target: MakeOn<'a>) -> Making<'a>;

    /// Takes over the kind's resources that were made on another device, except the chunks
    /// ([`OnDevice::other`]).
    fn adopt(&mut self, other: Box<dyn Made>) {
        let _ = other;
    }

    /// Takes over the state of instances from `last`, the same kind with another model, whose place it takes.
    fn follow(&mut self, last: &mut dyn ObjectKind) {
        let _ = last;
    }

    /// Sets whether motion history is kept. It takes effect when the object is refreshed.
    fn keep_last(&mut self, keeps: bool) {
        let _ = keeps;
    }

    /// The kind's resources for one view, which the view binds as group 1. `None` if group 1 is the same in all views. `number`
    /// is the object's number.
    fn in_view(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        number: u32,
    ) -> Result<Option<Box<dyn KindInView>>, Error> {
        let _ = (gpu, layouts, number);
        Ok(None)
    }

    // Methods of a frame, in the order of their calls.

    /// Ends all cross-fades between clips that are complete at scene time `now`, in seconds. Returns the indices of
    /// instances whose bounding spheres changed.
    fn settle(&mut self, now: f64) -> Vec<u32> {
        let _ = now;
        Vec::new()
    }

    /// Allocates the memory that the views of a frame need.
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

    /// Prepares the kind's compute jobs of a frame.
    fn fit(&mut self, gpu: &Gpu, fitted: &Fitted<'_>, staged: &mut Staged) -> Result<(), Error> {
        let _ = (gpu, fitted, staged);
        Ok(())
    }

    /// Stages the kind's changes since the last frame. `now` is the scene's time in seconds.
    fn stage(&mut self, staged: &mut Staged, frame: &Frame, now: f64) -> Result<(), Error> {
        let _ = (staged, frame, now);
        Ok(())
    }

    /// Records copies and jobs that run before the stages of the frame.
    fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let _ = encoder;
    }

    /// Adds the kind's work of a stage to a compute pass.
    fn dispatch(&self, stage: Stage, pass: &mut wgpu::ComputePass<'_>) {
        let _ = (stage, pass);
    }

    // Queries on the host.

    /// The triangles of an instance in full detail, posed at scene time `now`, in seconds.
    fn surfaces(&self, index: u32, now: f64) -> Result<Vec<Surface<'_>>, InputError> {
        let _ = (index, now);
        Ok(Vec::new())
    }

    /// The first hit of a ray on an instance, within the ray's limit.
    fn hit(&self, instance: &Placed, ray: &UnitRay) -> Result<Option<SurfaceHit>, InputError> {
        let UnitRay { origin, direction, limit } = *ray;
        let surfaces = self.surfaces(instance.index, instance.now)?;
        let hits = surfaces.iter().map(|surface| surface.hit(instance.place, [origin, direction], limit));
        Ok(hits.fold(None, SurfaceHit::nearer))
    }

    /// The lowest and highest corner of the smallest box around an instance, in the space that [`Placed::place`] maps
    /// to.
    fn tight_box(&self, instance: &Placed) -> Result<[DVec3; 2], InputError> {
        let surfaces = self.surfaces(instance.index, instance.now)?;
        let boxes = surfaces.iter().map(|surface| surface.bounds(instance.place));
        let around = boxes.reduce(|[low, high], [lower, higher]| [low.min(lower), high.max(higher)]);
        Ok(around.unwrap_or([instance.place.translation; 2]))
    }

    /// The lowest and highest corner of a box that may be larger than [`ObjectKind::tight_box`], but is faster to
    /// compute. `None` if the kind has no such box.
    fn wide_box(&self, instance: &Placed) -> Result<Option<[DVec3; 2]>, InputError> {
        let _ = instance;
        Ok(None)
    }

    /// Whether an instance may reach beyond its bounding sphere. If so, rays are first tested against
    /// [`ObjectKind::wide_box`].
    fn may_leave_sphere(&self, index: u32) -> bool {
        let _ = index;
        false
    }
}

impl dyn ObjectKind {
    /// The kind as the type `K`; `None` if it has another type.
    pub fn downcast<K: ObjectKind>(&self) -> Option<&K> {
        (self as &dyn Any).downcast_ref()
    }

    /// Mutable form of `downcast`: the kind as the type `K`.
    pub fn downcast_mut<K: ObjectKind>(&mut self) -> Option<&mut K> {
        (self as &mut dyn Any).downcast_mut()
    }
}

/// A view of a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct ViewOfFrame<'a> {
    pub camera: &'a Camera,
    /// Number of the view in the frame.
    pub number: usize,
    /// Whether the view was in the last frame too, without a cut since.
    pub is_next: bool,
}

/// Resources that a kind of object keeps for one view.
pub(super) trait KindInView: Debug + wgpu::WasmNotSendSync {
    /// Bind group 1 in this view.
    fn group(&self) -> &Group;

    /// Stages the resources for a frame. Returns one bit per instance of the object, whether the view draws it; an empty list
    /// leaves all bits as they are, at first 1.
    fn stage(&self, staged: &mut Staged, view: ViewOfFrame<'_>) -> Result<Vec<u32>, Error>;
}

/// A future that creates an object's resources on another device. Outside browsers, it may move to another thread.
#[cfg(not(target_arch = "wasm32"))]
pub(super) type Making<'a> = Pin<Box<dyn Future<Output = Result<OnDevice, Error>> + Send + 'a>>;
/// A future that creates an object's resources on another device.
#[cfg(target_arch = "wasm32")]
pub(super) type Making<'a> = Pin<Box<dyn Future<Output = Result<OnDevice, Error>> + 'a>>;

/// Target for creating an object's resources again: a device, and the parameters of the object.
#[derive(Debug, Clone, Copy)]
pub(super) struct MakeOn<'a> {
    pub gpu: &'a Gpu,
    pub layouts: &'a SceneLayouts,
    /// Materials and images of the object, if it has any.
    pub looks: Option<&'a Looks>,
    /// Number of instances to allocate memory for.
    pub capacity: usize,
}

/// A resource of any type, made on a device.
pub(super) trait Made: Any + Debug + wgpu::WasmNotSend {}

impl<T: Any + Debug + wgpu::WasmNotSend> Made for T {}

/// All device resources of an object.
#[derive(Debug)]
pub(super) struct OnDevice {
    pub chunks: Vec<Chunk>,
    /// Resources of the kind other than chunks, for [`ObjectKind::adopt`].
    pub other: Box<dyn Made>,
}

impl OnDevice {
    /// Resources that consist only of chunks.
    pub fn chunks(chunks: Vec<Chunk>) -> Self {
        Self { chunks, other: Box::new(()) }
    }
}

/// Inputs that decide which instances of an object the views of a frame may see.
#[derive(Debug, Clone, Copy)]
pub(super) struct SeenBy<'a> {
    pub views: &'a [SelectView],
    /// For each view, the largest number of triangles for an object that coarsens itself; `None` without a limit.
    pub triangle_limits: &'a [Option<u32>],
    /// The object in kernel format. Its metric scale does not contain the LOD bias yet.
    pub object: &'a LodObject,
    pub instances: &'a [SceneInstance],
    /// The scene's time in seconds.
    pub now: f64,
}

/// Result of [`ObjectKind::provide`].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Provided {
    /// The object's LOD bias, a factor of the allowed displacement. It is 1, or more if the device has no memory for
    /// the finer levels.
    pub lod_bias: f32,
    pub replaced: Replaced,
    /// Instances that are placed anew, for kinds that create their instances themselves.
    pub placed: Vec<(u32, Placement, BoundingSphere)>,
}

impl Default for Provided {
    fn default() -> Self {
        Self { lod_bias: 1.0, replaced: Replaced::Nothing, placed: Vec::new() }
    }
}

/// Which resources [`ObjectKind::provide`] replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Replaced {
    Nothing,
    /// Only buffers of some chunks.
    Buffers,
    /// The chunks themselves. The state of instances in a divided chunk is reset.
    Chunks,
}

/// Inputs of [`ObjectKind::fit`], which prepares the jobs of a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fitted<'a> {
    pub layout: &'a Layout,
    /// Whether the layout changed since the last frame.
    pub is_new: bool,
    pub assign: &'a AssignPass,
    pub budget: ErrorBudget,
    pub chunks: &'a [Chunk],
}

/// A placed instance, for queries on the host.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub index: u32,
    /// The scene's time in seconds.
    pub now: f64,
    /// The transform from model space to world axes, relative to the corner of `cell`.
    pub place: DAffine3,
    pub cell: [i32; 3],
    /// The lowest and highest corner of a box around the placed bounding sphere.
    pub sphere_box: [DVec3; 2],
}

/// A ray relative to the corner of a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitRay {
    pub origin: DVec3,
    /// Direction of the ray, of length 1.
    pub direction: DVec3,
    /// The largest distance from `origin` at which a hit counts.
    pub limit: f64,
}
