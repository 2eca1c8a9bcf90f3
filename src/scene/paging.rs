//! Pages of skinned vertices that a character needs in a frame. The host predicts the device's decisions, so that memory
//! follows visibility and no frame waits for a readback.

use std::ops::Range;

use crate::lod::allowed::allowed_by;
use crate::lod::select::reference::{is_shown, nearly_seen, placed_sphere};
use crate::lod::{LodObject, SceneInstance, SelectView};
use crate::skinning::pages::{KEEPING_PAGE_BYTES, PAGE_BYTES};

/// Up to this size (4 MiB), pages for all instances in full detail are allocated at once.
const SMALL: usize = 4 << 20;

/// Safety factor: rounding may make the device allow less than the host.
const CAUTION: f32 = 0.999;

/// Ratio of successive displacements to try, if pages for the visible instances exceed the memory.
const COARSER: f32 = 1.25;

/// Largest factor to try.
const COARSEST: f32 = 1e6;

/// Page counts of one mesh, for some instances.
#[derive(Debug, Clone)]
pub(super) struct Paging {
    /// Clusters per level of detail.
    clusters: Vec<u32>,
    /// Pages for all instances in full detail.
    full: u32,
    /// Largest number of pages that a binding holds, or that there is memory for.
    pub most: u32,
    /// Bytes per page.
    bytes: usize,
}

impl Paging {
    /// Page counts of a mesh: `clusters` per level, a number of instances, bytes per binding, and whether previous
    /// positions are kept.
    pub fn new(clusters: Vec<u32>, instances: usize, binding: u64, keeps_last: bool) -> Self {
        let bytes = if keeps_last { KEEPING_PAGE_BYTES } else { PAGE_BYTES };
        let full = clusters.first().map_or(0, |clusters| instances * *clusters as usize);
        let most = (binding / bytes as u64).min(u64::from(u32::MAX)) as u32;
        Self { clusters, full: u32::try_from(full).unwrap_or(u32::MAX), most, bytes }
    }

    /// Whether `pages` suffice for all instances in full detail.
    pub fn is_full(&self, pages: usize) -> bool {
        pages as u64 >= u64::from(self.full)
    }

    /// The initial number of pages.
    pub fn initial(&self) -> u32 {
        self.full.min((SMALL / self.bytes) as u32).min(self.most).max(1)
    }

    /// The number of pages to allocate for a frame that needs `needed`. It is larger, so that the next frames need no new
    /// allocation.
    pub fn enough(&self, needed: u32) -> u32 {
        needed.saturating_add(needed / 2).min(self.full).min(self.most).max(1)
    }

    fn needed(&self, levels: impl Iterator<Item = u32>) -> u64 {
        let clusters = |level: u32| self.clusters.get(level as usize).or(self.clusters.last());
        levels.filter_map(clusters).map(|clusters| u64::from(*clusters)).sum()
    }
}

/// Visibility of a character's instances in a frame's views.
#[derive(Debug)]
pub(super) struct Seen<'a> {
    object: &'a LodObject,
    /// Smallest displacement that any view allows, per instance; `None` if no view may see it.
    allowed: Vec<Option<f32>>,
}

impl<'a> Seen<'a> {
    /// All instances, in the views of a frame. `object` has the levels' fraction of the displacement before LOD bias.
    pub fn new(views: &[SelectView], object: &'a LodObject, instances: &[SceneInstance]) -> Self {
        let allowed = instances.iter().map(|instance| allowed(views, object, instance)).collect();
        Self { object, allowed }
    }

    /// Pages that some of the instances need, per mesh, if the displacement of levels is scaled by `lod_bias`.
    fn exactly(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> Vec<u64> {
        let fraction = CAUTION * lod_bias * self.object.mesh_fraction;
        let seen = || self.allowed[slots.clone()].iter().flatten();
        let levels = || seen().map(|allowed| level(self.object, fraction * allowed));
        meshes.iter().map(|mesh| mesh.needed(levels())).collect()
    }

    /// The same pages, per mesh, limited to [`Paging::most`].
    pub fn pages(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> Vec<u32> {
        let pages = self.exactly(slots, meshes, lod_bias);
        pages.iter().zip(meshes).map(|(pages, mesh)| (*pages).min(mesh.most.into()) as u32).collect()
    }

    /// Whether the needed pages of every mesh are within [`Paging::most`].
    pub fn fits(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> bool {
        let pages = self.exactly(slots, meshes, lod_bias);
        pages.iter().zip(meshes).all(|(pages, mesh)| *pages <= u64::from(mesh.most))
    }

    /// The LOD bias with which all chunks fit: 1 unless the visible instances need more memory than there is.
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

/// The smallest displacement that any view allows an instance; `None` if no view may see it. Nearly visible instances
/// count.
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
