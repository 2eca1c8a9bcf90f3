//! How many pages of skinned vertices a character needs in a frame: the host foresees what the device will decide, so that
//! memory follows what is seen and no frame waits for an answer.

use crate::lod::select::reference::{is_shown, nearly_seen, placed_sphere, view_allows};
use crate::lod::{LodObject, SceneInstance, SelectView};
use crate::skinning::pages::{KEEPING_PAGE_BYTES, PAGE_BYTES};

/// Up to this size, pages for all instances in full detail are allocated at once: 4 MiB.
const SMALL: usize = 4 << 20;

/// The factor by which rounding may make the device allow less than the host.
const CAUTION: f32 = 0.999;

/// The factor between the displacements that are tried where pages for what is seen exceed a binding.
const COARSER: f32 = 1.25;

/// The pages of one mesh, in numbers.
#[derive(Debug, Clone)]
pub(super) struct Paging {
    /// Clusters at each level of detail.
    pub clusters: Vec<u32>,
    /// Pages for all instances in full detail.
    pub full: u32,
    /// As many as a binding holds.
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

    /// The number of pages to begin with.
    pub fn initial(&self) -> u32 {
        self.full.min((SMALL / self.bytes) as u32).min(self.most).max(1)
    }

    /// The number of pages for a frame that needs `needed`: more than that, so that the next frames need no others.
    pub fn enough(&self, needed: u32) -> u32 {
        (needed + needed / 2).min(self.full).min(self.most).max(1)
    }

    fn needed(&self, levels: &[u32]) -> u64 {
        let clusters = |level: &u32| self.clusters.get(*level as usize).or(self.clusters.last());
        levels.iter().filter_map(clusters).map(|clusters| u64::from(*clusters)).sum()
    }
}

/// What a frame needs of a character.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Needs {
    /// Pages, for each of its meshes.
    pub pages: Vec<u32>,
    /// The factor by which the displacement that its levels may use must grow, so that the pages fit: 1 unless there is more
    /// to see than a binding holds.
    pub coarsening: f32,
}

/// What the views of a frame need of the instances of a character.
pub(super) fn needs(
    views: &[SelectView],
    object: &LodObject,
    instances: &[SceneInstance],
    meshes: &[Paging],
) -> Needs {
    let seen: Vec<f32> = instances.iter().filter_map(|instance| allowed(views, object, instance)).collect();
    let mut coarsening = 1.0;
    loop {
        let fraction = CAUTION * coarsening * object.mesh_fraction;
        let levels: Vec<u32> = seen.iter().map(|allowed| level(object, fraction * allowed)).collect();
        let pages: Vec<u64> = meshes.iter().map(|mesh| mesh.needed(&levels)).collect();
        let fits = pages.iter().zip(meshes).all(|(pages, mesh)| *pages <= u64::from(mesh.most));
        if fits || coarsening > 1e6 {
            let pages = pages.iter().map(|pages| (*pages).min(u64::from(u32::MAX)) as u32).collect();
            return Needs { pages, coarsening };
        }
        coarsening *= COARSER;
    }
}

/// The smallest displacement that a view allows an instance, `None` if none may see it. What is nearly seen counts.
fn allowed(views: &[SelectView], object: &LodObject, instance: &SceneInstance) -> Option<f32> {
    let of_view = |view: &SelectView| {
        let (center, radius) = placed_sphere(instance, view.cell);
        let is_seen = is_shown(view, object, instance) && nearly_seen(view, center, radius);
        is_seen.then(|| view_allows(view, center, radius, instance.largest_scale()))
    };
    views.iter().filter_map(of_view).reduce(f32::min)
}

/// The coarsest level whose error is at most `error`.
fn level(object: &LodObject, error: f32) -> u32 {
    let errors = object.errors.as_flattened();
    (1..object.levels).take_while(|level| errors[*level as usize] <= error).count() as u32
}
