//! How many pages of skinned vertices a character needs in a frame: the host foresees what the device will decide, so that
//! memory follows what is seen and no frame waits for an answer.

use std::ops::Range;

use crate::lod::allowed::allowed_by;
use crate::lod::select::reference::{is_shown, nearly_seen, placed_sphere};
use crate::lod::{LodObject, SceneInstance, SelectView};
use crate::skinning::pages::{KEEPING_PAGE_BYTES, PAGE_BYTES};

/// Up to this size, pages for all instances in full detail are allocated at once: 4 MiB.
const SMALL: usize = 4 << 20;

/// The factor by which rounding may make the device allow less than the host.
const CAUTION: f32 = 0.999;

/// The factor between the displacements that are tried where pages for what is seen exceed the memory.
const COARSER: f32 = 1.25;

/// The largest factor that is tried.
const COARSEST: f32 = 1e6;

/// The pages of one mesh for some instances, in numbers.
#[derive(Debug, Clone)]
pub(super) struct Paging {
    /// Clusters at each level of detail.
    clusters: Vec<u32>,
    /// Pages for all instances in full detail.
    full: u32,
    /// As many as a binding holds, or as memory is left for.
    pub most: u32,
    /// The bytes of a page.
    bytes: usize,
}

impl Paging {
    /// Of a mesh with so many clusters at each level, for so many instances, with bindings of so many bytes, with last
    /// positions or without.
    pub fn new(clusters: Vec<u32>, instances: usize, binding: u64, keeps_last: bool) -> Self {
        let bytes = if keeps_last { KEEPING_PAGE_BYTES } else { PAGE_BYTES };
        let full = clusters.first().map_or(0, |clusters| instances * *clusters as usize);
        let most = (binding / bytes as u64).min(u64::from(u32::MAX)) as u32;
        Self { clusters, full: u32::try_from(full).unwrap_or(u32::MAX), most, bytes }
    }

    /// Whether so many pages are enough for all instances in full detail.
    pub fn is_full(&self, pages: usize) -> bool {
        pages as u64 >= u64::from(self.full)
    }

    /// The number of pages to begin with.
    pub fn initial(&self) -> u32 {
        self.full.min((SMALL / self.bytes) as u32).min(self.most).max(1)
    }

    /// The number of pages for a frame that needs `needed`: more than that, so that the next frames need no others.
    pub fn enough(&self, needed: u32) -> u32 {
        needed.saturating_add(needed / 2).min(self.full).min(self.most).max(1)
    }

    fn needed(&self, levels: impl Iterator<Item = u32>) -> u64 {
        let clusters = |level: u32| self.clusters.get(level as usize).or(self.clusters.last());
        levels.filter_map(clusters).map(|clusters| u64::from(*clusters)).sum()
    }
}

/// What the views of a frame see of the instances of a character.
#[derive(Debug)]
pub(super) struct Seen<'a> {
    object: &'a LodObject,
    /// The smallest displacement that a view allows each instance, `None` if none may see it.
    allowed: Vec<Option<f32>>,
}

impl<'a> Seen<'a> {
    /// All instances, in the views of a frame. `object` has the fraction of the displacement that levels of detail use by
    /// themselves.
    pub fn new(views: &[SelectView], object: &'a LodObject, instances: &[SceneInstance]) -> Self {
        let allowed = instances.iter().map(|instance| allowed(views, object, instance)).collect();
        Self { object, allowed }
    }

    /// The pages that some of the instances need, for each mesh, where levels may be off by so many times more.
    fn exactly(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> Vec<u64> {
        let fraction = CAUTION * lod_bias * self.object.mesh_fraction;
        let seen = || self.allowed[slots.clone()].iter().flatten();
        let levels = || seen().map(|allowed| level(self.object, fraction * allowed));
        meshes.iter().map(|mesh| mesh.needed(levels())).collect()
    }

    /// As many pages as [`Seen::fits`] allows, for each mesh.
    pub fn pages(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> Vec<u32> {
        let pages = self.exactly(slots, meshes, lod_bias);
        pages.iter().zip(meshes).map(|(pages, mesh)| (*pages).min(mesh.most.into()) as u32).collect()
    }

    /// Whether the pages that some of the instances need are no more than there may be.
    pub fn fits(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> bool {
        let pages = self.exactly(slots, meshes, lod_bias);
        pages.iter().zip(meshes).all(|(pages, mesh)| *pages <= u64::from(mesh.most))
    }

    /// The factor by which the displacement that levels may use must grow, so that all chunks fit: 1 unless there is more to
    /// see than there is memory for.
    pub fn lod_bias<'b>(
        &self,
        chunks: impl Iterator<Item = (&'b Range<usize>, &'b [Paging])> + Clone,
    ) -> f32 {
        let mut lod_bias = 1.0;
        while lod_bias < COARSEST && chunks.clone().any(|(slots, meshes)| !self.fits(slots, meshes, lod_bias))
        {
            lod_bias *= COARSER;
        }
        lod_bias
    }
}

/// The smallest displacement that a view allows an instance, `None` if none may see it. What is nearly seen counts.
fn allowed(views: &[SelectView], object: &LodObject, instance: &SceneInstance) -> Option<f32> {
    let of_view = |view: &SelectView| {
        let (center, radius) = placed_sphere(instance, view.cell);
        let is_seen = is_shown(view, object, instance) && nearly_seen(view, center, radius);
        is_seen.then(|| allowed_by(view.cameras(), center, radius, instance.largest_scale()))
    };
    views.iter().filter_map(of_view).reduce(f32::min)
}

/// The coarsest level whose error is at most `error`.
fn level(object: &LodObject, error: f32) -> u32 {
    let errors = object.errors.as_flattened();
    (1..object.levels).take_while(|level| errors[*level as usize] <= error).count() as u32
}
