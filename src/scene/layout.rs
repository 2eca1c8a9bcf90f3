//! The positions of all objects' instances, lists and draws in the buffers of a scene and its views.

use std::sync::Arc;

use glam::Vec4;

use crate::Error;
use crate::gpu::{Buffer, Gpu};
use crate::lod::sorted::SortedDraw;
use crate::scene::handles::ObjectId;
use crate::shared::lod::allowed::Allowed;
use crate::shared::lod::instance::SceneInstance;
use crate::shared::lod::object::{BLOCK, LodObject, OBJECT_LEVELS, SceneDraw};

/// Where an object's data begin in the buffers of the scene and its views.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ObjectRange {
    /// Index of the first instance in the scene's instance buffers.
    pub first: u32,
    /// Word offset of the object's first list in a view's lists.
    pub first_list: u32,
    /// Index of the object's first draw in a view's draws.
    pub first_draw: u32,
}

/// The instance buffers of a scene, sized for all objects.
#[derive(Debug)]
pub(crate) struct Layout {
    /// Version number of the layout in its scene. Jobs prepared for another version are outdated.
    pub version: u64,
    pub instances: Buffer<SceneInstance>,
    /// With motion history: the instances in the last frame. Otherwise: the same buffer as `instances`.
    pub last_instances: Buffer<SceneInstance>,
    pub keeps_last: bool,
    /// Allowed displacement per instance, in its model's units; −1 for instances that no view sees.
    pub allowed: Buffer<Allowed>,
    /// Per instance: the finest level that any of the frame's views draws.
    pub finest: Buffer<u32>,
    pub objects: Buffer<LodObject>,
    pub object_count: u32,
    /// Per block of 64 instances ([`BLOCK`]): the index of the object that the block belongs to.
    pub block_objects: Buffer<u32>,
    /// Number of blocks of 64 instances ([`BLOCK`]) in all objects.
    pub blocks: u32,
    /// Number of words in the instance lists of a view.
    pub list_words: u32,
    /// Binary logarithm of the unit in which budgets count triangles.
    pub triangle_unit: u32,
    /// Draw arguments of a view that sees no instance.
    pub draws: Vec<SceneDraw>,
    /// The parts whose instances are drawn one by one, from back to front.
    pub sorted: Buffer<SortedDraw>,
    /// The objects whose draws are counted for statistics.
    pub counted: Arc<Counted>,
}

/// Objects that are laid out one after the other.
#[derive(Debug)]
pub(super) struct LaidOut<'a> {
    pub objects: &'a [LodObject],
    pub draws: Vec<SceneDraw>,
    pub sorted: &'a [SortedDraw],
    /// The total numbers of instances, list words and draws.
    pub end: ObjectRange,
    pub counted: Counted,
    pub triangle_unit: u32,
}

impl Layout {
    /// Allocates the buffers.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub(super) fn new(
        gpu: &Gpu,
        laid_out: LaidOut<'_>,
        version: u64,
        keeps_last: bool,
    ) -> Result<Self, Error> {
        let LaidOut { objects, draws, sorted, end, counted, triangle_unit } = laid_out;
        let of_object =
            |(at, object): (u32, &LodObject)| std::iter::repeat_n(at, (object.instances / BLOCK) as usize);
        let block_objects: Vec<u32> = (0..).zip(objects).flat_map(of_object).collect();
        let count = end.first as usize;
        let instances = Buffer::new(gpu, "instances", count)?;
        let last_instances = match keeps_last {
            true => Buffer::new(gpu, "instances in the last frame", count)?,
            false => instances.clone(),
        };
        Ok(Self {
            version,
            instances,
            last_instances,
            keeps_last,
            allowed: Buffer::new(gpu, "allowed displacements", count)?,
            finest: Buffer::new(gpu, "finest levels", count)?,
            objects: Buffer::from_slice(gpu, "objects", objects)?,
            object_count: objects.len() as u32,
            block_objects: Buffer::from_slice(gpu, "objects of blocks", &block_objects)?,
            blocks: block_objects.len() as u32,
            list_words: end.first_list,
            triangle_unit,
            draws,
            sorted: Buffer::from_slice(gpu, "single instances", sorted)?,
            counted: Arc::new(counted),
        })
    }
}

/// Errors per level of detail in kernel format. Missing levels get the largest `f32`.
pub(super) fn error_vectors(errors: &[f32]) -> [Vec4; OBJECT_LEVELS as usize / 4] {
    let error = |at: usize| errors.get(at).copied().unwrap_or(f32::MAX);
    std::array::from_fn(|at| Vec4::from_array(std::array::from_fn(|lane| error(4 * at + lane))))
}

/// An object whose draws are counted for statistics.
#[derive(Debug, Clone)]
pub(super) struct CountedObject {
    pub object: ObjectId,
    /// Index of the first draw of each chunk.
    pub first_draws: Vec<u32>,
    pub parts: u32,
    pub levels: u32,
    pub mesh_fraction: f32,
    /// Largest factor by which the object's settings enlarge the allowed displacement.
    pub bias: f32,
    /// The object's rank within a budget of triangles, in device format: 0 to 7, or `NO_RANK`.
    pub rank: u32,
    /// Whether the object's instances may fade.
    pub fades: bool,
    /// Whether the object keeps the error that views allow.
    pub is_bounded: bool,
}

/// All objects of a layout whose draws are counted for statistics.
#[derive(Debug)]
pub(crate) struct Counted {
    pub(super) objects: Vec<CountedObject>,
}
