//! An object's work in a frame: allocating memory for visible instances, laying out buffers, and staging changes.

use glam::Vec4;

use super::Object;
use crate::Error;
use crate::animation::Frame;
use crate::gpu::{Buffer, Gpu, Staged, Upload as _};
use crate::lod::assign::AssignPass;
use crate::lod::{SceneInstance, SelectView};
use crate::scene::chunk::{Chunk, common};
use crate::scene::handles::{ObjectId, Slots};
use crate::scene::instances;
use crate::scene::layout::{Counted, CountedObject, LaidOut, Layout, ObjectRange};
use crate::scene::layouts::SceneLayouts;
use crate::scene::object_kind::{Fitted, Provided, Replaced, SeenBy};
use crate::scene::quality::ErrorBudget;
use crate::shared::lod::object::{BLOCK, LodObject, OBJECT_LISTS};
use crate::shared::render::scene_instances::SceneObject;

impl Object {
    /// Allocates the memory that the views of a frame need. If memory is short, levels of detail become coarser.
    /// Returns true if the chunks changed.
    pub(in crate::scene) fn provide(
        &mut self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        views: &[SelectView],
        triangle_limits: &[Option<u32>],
        now: f64,
    ) -> Result<bool, Error> {
        let all = Chunk::new(0..self.instances.capacity(), Vec::new());
        let lod = self.biased_lod_object(&all, 1.0);
        let seen = SeenBy { views, triangle_limits, object: &lod, instances: self.instances.all(), now };
        let Provided { lod_bias, replaced, placed } =
            self.kind.provide(gpu, layouts, &seen, &mut self.chunks)?;
        for (index, placement, sphere) in placed {
            self.instances.change(index, |instance| {
                instances::place(instance, &placement);
                instances::bound(instance, &sphere);
            });
        }
        self.is_rebound |= replaced == Replaced::Buffers;
        self.is_retuned |= lod_bias != self.lod_bias;
        self.lod_bias = lod_bias;
        Ok(replaced == Replaced::Chunks)
    }

    /// Stages the object's changes since the last frame. `now` is the scene's time in seconds.
    pub(in crate::scene) fn stage(
        &mut self,
        staged: &mut Staged,
        layout: &Layout,
        frame: &Frame,
        now: f64,
    ) -> Result<(), Error> {
        for (at, last) in self.instances.take_last() {
            stage_instances(staged, &layout.last_instances, &self.chunks, at, &last)?;
        }
        for (at, changed) in self.instances.take_changed() {
            stage_instances(staged, &layout.instances, &self.chunks, at, changed)?;
        }
        if std::mem::take(&mut self.is_rebound) {
            self.chunks
                .iter()
                .try_for_each(|chunk| stage_params(staged, chunk, self.handle, &self.errors))?;
        }
        if std::mem::take(&mut self.is_retuned) {
            for chunk in &self.chunks {
                staged.elements(&layout.objects, chunk.number, &[self.lod_object(chunk)])?;
            }
        }
        self.kind.stage(staged, frame, now)
    }

    /// Prepares the object's jobs and uniforms for a layout.
    pub(in crate::scene) fn fit(
        &mut self,
        gpu: &Gpu,
        layout: &Layout,
        pass: &AssignPass,
        budget: ErrorBudget,
        staged: &mut Staged,
    ) -> Result<(), Error> {
        let is_new = self.fitted != layout.version;
        if is_new {
            let lods: Vec<LodObject> = self.chunks.iter().map(|chunk| self.lod_object(chunk)).collect();
            for (chunk, mut lod) in self.chunks.iter_mut().zip(lods) {
                chunk.lods.clear();
                for drawable in &chunk.drawables {
                    chunk.lods.push(lod);
                    lod.first_draw += OBJECT_LISTS * drawable.part_count() as u32;
                }
                stage_params(staged, chunk, self.handle, &self.errors)?;
            }
        }
        let fitted = Fitted { layout, is_new, assign: pass, budget, chunks: &self.chunks };
        self.kind.fit(gpu, &fitted, staged)?;
        self.fitted = layout.version;
        Ok(())
    }
}

/// Stages changed instances of an object: `run` holds consecutive instances, the first with index `at`.
fn stage_instances(
    staged: &mut Staged,
    to: &Buffer<SceneInstance>,
    chunks: &[Chunk],
    at: usize,
    run: &[SceneInstance],
) -> Result<(), Error> {
    for chunk in chunks {
        if let Some(own) = common(&(at..at + run.len()), &chunk.slots) {
            staged.elements(to, chunk.place(own.start), &run[own.start - at..own.end - at])?;
        }
    }
    Ok(())
}

/// The largest distance along a view ray between the surfaces of two levels, as a multiple of the coarser level's
/// error. This bound holds for surfaces that are seen at up to 70 degrees from their normal.
const PUSHED_ERRORS: f32 = 3.0;

/// Stages the uniforms of a chunk's drawables. `number` is the object's number; `errors` are the errors of its levels.
fn stage_params(staged: &mut Staged, chunk: &Chunk, number: u32, errors: &[f32]) -> Result<(), Error> {
    let (first_instance, first_slot) = (chunk.range.first, chunk.slots.start as u32);
    let next = |level: usize| errors.get(level + 1).or(errors.last()).copied().unwrap_or(0.0);
    let push = |level: usize| PUSHED_ERRORS * next(level);
    let push = std::array::from_fn(|at| Vec4::from_array(std::array::from_fn(|lane| push(4 * at + lane))));
    let object = SceneObject { first_instance, number, first_slot, push };
    chunk.drawables.iter().try_for_each(|drawable| drawable.stage(staged, &object))
}

/// Lays out the chunks of all objects one after the other in the scene's buffers, and sets each chunk's range.
/// `version` is the number of the new layout; `keeps_last` is whether motion history is kept.
///
/// # Errors
/// [`crate::gpu::GpuError`].
pub(in crate::scene) fn laid_out(
    gpu: &Gpu,
    objects: &mut Slots<Object>,
    version: u64,
    keeps_last: bool,
) -> Result<Layout, Error> {
    let mut range = ObjectRange::default();
    let (mut all, mut draws, mut sorted) = (Vec::new(), Vec::new(), Vec::new());
    // In triangle units, the full meshes of all instances sum to less than 2^31. A fade draws two levels, so no sum
    // reaches 2^32.
    let most = |object: &Object| {
        let triangles = object.triangles().first().copied().unwrap_or(0);
        object.capacity().next_multiple_of(BLOCK as usize) as u64 * u64::from(triangles)
    };
    let triangles: u64 = objects.iter().map(most).sum();
    let triangle_unit = (64 - triangles.leading_zeros()).saturating_sub(31);
    for object in objects.iter_mut() {
        object.triangle_unit = triangle_unit;
        let passes = if object.level_of_detail.transition.fades() { 2 } else { 1 };
        let levels = object.errors.len() as u32;
        for at in 0..object.chunks.len() {
            let chunk = &mut object.chunks[at];
            chunk.range = range;
            chunk.number = all.len();
            chunk.lay_out_sorted(&mut sorted);
            let instances = chunk.room();
            range.first += instances;
            range.first_list += 2 * passes * levels * instances;
            range.first_draw += OBJECT_LISTS * object.parts() as u32;
            draws.extend(object.draws_of_lists());
            all.push(object.lod_object(&object.chunks[at]));
        }
    }
    let counted = Counted::new(objects);
    let laid_out = LaidOut { objects: &all, draws, sorted: &sorted, end: range, counted, triangle_unit };
    Layout::new(gpu, laid_out, version, keeps_last)
}

impl Counted {
    /// The objects with their draws in a layout, for statistics.
    fn new(objects: &Slots<Object>) -> Self {
        let counted = |(object, entry): (ObjectId, &Object)| CountedObject {
            object,
            first_draws: entry.chunks.iter().map(|chunk| chunk.range.first_draw).collect(),
            parts: entry.parts() as u32,
            levels: entry.errors.len() as u32,
            mesh_fraction: entry.error_fraction(),
            bias: entry.level_of_detail.largest_factor(),
            rank: entry.rank_on_device(),
            fades: entry.level_of_detail.transition.fades(),
            is_bounded: entry.level_of_detail.is_bounded() && entry.kind.is_bounded(),
        };
        Self { objects: objects.each().map(counted).collect() }
    }
}
