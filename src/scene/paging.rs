//! Counts the pages of 64 skinned vertices that a character needs in a frame. The host predicts the device's decisions,
//! so that memory follows visibility and no frame waits for a readback.

use std::ops::Range;

use crate::lod::allowed::allowed_by;
use crate::lod::criterion::{Placed, metric};
use crate::lod::select::reference::{is_shown, nearly_seen, placed_sphere};
use crate::lod::transition::level_within;
use crate::lod::{LodCamera, LodObject, SceneInstance, SelectView};
use crate::scene::object_kind::SeenBy;
use crate::shared::lod::criterion::{CRITERION_DISTANCE, CRITERION_NEAREST};
use crate::shared::lod::object::{FADE_PROGRESS, object_flags_criterion, object_flags_never_culled};
use crate::shared::lod::view::POSITION_SLACK;
use crate::skinning::pages::{KEEPING_PAGE_BYTES, PAGE_BYTES};

/// Memory for the first pages of a mesh, in bytes (4 MiB). If this memory suffices for all instances in full detail, the mesh
/// never needs more.
const SMALL: usize = 4 << 20;

/// Safety factor of the metric, because rounding may make the device allow a smaller displacement than the host.
const CAUTION: f32 = 0.999;

/// Ratio of successive LOD biases that are tried if the pages for the visible instances exceed the memory.
const COARSER: f32 = 1.25;

/// The largest LOD bias that is tried.
const COARSEST: f32 = 1e6;

/// The level of detail that every instance is assumed to have had in the last frame: the finest. With hysteresis or
/// fades, the present level depends on the last one, and the finest last level leads to the finest present level.
const FINEST: u32 = 0;

/// Page counts of one mesh for a number of instances.
#[derive(Debug, Clone)]
pub(super) struct Paging {
    /// Number of clusters of each level of detail. A cluster of an instance takes a page.
    clusters: Vec<u32>,
    /// Number of pages for all instances in full detail.
    full: u32,
    /// The largest number of pages that fit into a binding, or into the device's memory.
    pub most: u32,
    /// Size of a page in bytes.
    bytes: usize,
}

impl Paging {
    /// The page counts of a mesh. `clusters` has the number of clusters of each level, and `binding` is the size of a
    /// binding in bytes. With `keeps_last`, pages also hold the last frame's positions.
    pub fn new(clusters: Vec<u32>, instances: usize, binding: u64, keeps_last: bool) -> Self {
        let bytes = if keeps_last { KEEPING_PAGE_BYTES } else { PAGE_BYTES };
        let full = clusters.first().map_or(0, |clusters| instances * *clusters as usize);
        let most = (binding / bytes as u64).min(u64::from(u32::MAX)) as u32;
        Self { clusters, full: u32::try_from(full).unwrap_or(u32::MAX), most, bytes }
    }

    /// Whether a number of pages suffices for all instances in full detail.
    pub fn is_full(&self, pages: usize) -> bool {
        pages as u64 >= u64::from(self.full)
    }

    /// The number of pages to allocate when the character is added.
    pub fn initial(&self) -> u32 {
        self.full.min((SMALL / self.bytes) as u32).min(self.most).max(1)
    }

    /// The number of pages to allocate for a frame that needs `needed` pages. The result includes a reserve, so that
    /// the next frames need no new allocation.
    pub fn enough(&self, needed: u32) -> u32 {
        needed.saturating_add(needed / 2).min(self.full).min(self.most).max(1)
    }

    fn needed(&self, levels: impl Iterator<Item = u32>) -> u64 {
        let clusters = |level: u32| self.clusters.get(level as usize).or(self.clusters.last());
        levels.filter_map(clusters).map(|clusters| u64::from(*clusters)).sum()
    }
}

/// Sliding minimum of an instance's metric. A fade may still show the level that belongs to the smallest recent metric.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held {
    metric: f32,
    /// Scene time of `metric`, in seconds.
    time: f64,
    /// The smallest metric since `time`, without `metric` itself.
    next: f32,
}

impl Held {
    const NONE: Self = Self { metric: f32::MAX, time: f64::MIN, next: f32::MAX };

    /// Adds the metric at scene time `now`. Returns the smallest metric of the last `seconds` seconds.
    fn with(&mut self, metric: f32, now: f64, seconds: f64) -> f32 {
        if metric <= self.metric {
            *self = Self { metric, time: now, next: f32::MAX };
        } else if (now - self.time).abs() > seconds {
            *self = Self { metric: metric.min(self.next), time: now, next: f32::MAX };
        } else {
            self.next = self.next.min(metric);
        }
        self.metric
    }
}

/// Visibility of a character's instances in the views of a frame.
#[derive(Debug)]
pub(super) struct Seen<'a> {
    object: &'a LodObject,
    /// For each instance, its smallest metric in any view, not yet multiplied by the object's metric scale. `None` if
    /// no view may see the instance.
    metrics: Vec<Option<f32>>,
}

impl<'a> Seen<'a> {
    /// Computes the visibility of all instances in the views of a frame. `held` keeps recent metrics from frame to
    /// frame.
    pub fn new(seen: &SeenBy<'a>, held: &mut Vec<Held>) -> Self {
        let SeenBy { views, object, instances, now, .. } = *seen;
        let mut metrics: Vec<Option<f32>> =
            instances.iter().map(|instance| least_metric(views, object, instance)).collect();
        if object.rate > 0.0 {
            // Duration of a fade and of a second fade that waited for it, with a reserve for rounded steps.
            let seconds = 3.0 * f64::from(FADE_PROGRESS as f32 / object.rate) + 0.1;
            held.resize(instances.len(), Held::NONE);
            for (metric, held) in metrics.iter_mut().zip(held) {
                match metric {
                    Some(metric) => *metric = held.with(*metric, now, seconds),
                    None => *held = Held::NONE,
                }
            }
        }
        Self { object, metrics }
    }

    /// For each mesh, the number of pages that the visible instances of `slots` need. The metric is scaled by
    /// `lod_bias`.
    fn exactly(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> Vec<u64> {
        let factor = CAUTION * lod_bias * self.object.metric_scale;
        let seen = || self.metrics[slots.clone()].iter().flatten();
        let levels = || seen().map(|metric| level_within(self.object, factor * metric, FINEST));
        meshes.iter().map(|mesh| mesh.needed(levels())).collect()
    }

    /// For each mesh, the number of pages that the visible instances of `slots` need, but at most [`Paging::most`].
    pub fn pages(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> Vec<u32> {
        let pages = self.exactly(slots, meshes, lod_bias);
        pages.iter().zip(meshes).map(|(pages, mesh)| (*pages).min(mesh.most.into()) as u32).collect()
    }

    /// Whether each mesh needs at most [`Paging::most`] pages for the visible instances of `slots`.
    pub fn fits(&self, slots: &Range<usize>, meshes: &[Paging], lod_bias: f32) -> bool {
        let pages = self.exactly(slots, meshes, lod_bias);
        pages.iter().zip(meshes).all(|(pages, mesh)| *pages <= u64::from(mesh.most))
    }

    /// The LOD bias at which all chunks fit into memory. It is 1 unless the visible instances need more memory than
    /// there is.
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

/// The smallest metric of an instance in all cameras of all views, reduced by its rounding error. `None` if no view may
/// see the instance. An instance just outside a view counts as visible.
fn least_metric(views: &[SelectView], object: &LodObject, instance: &SceneInstance) -> Option<f32> {
    let of_view = |view: &SelectView| {
        let (center, radius) = placed_sphere(instance, view.cell);
        let is_culled = object_flags_never_culled(object.flags) == 0 && !nearly_seen(view, center, radius);
        if !is_shown(view, object, instance) || is_culled {
            return None;
        }
        let (axes, at) = (instance.axes(), instance.position(view.cell));
        let (placed, scale) = (Placed { axes, at, center, radius }, instance.largest_scale());
        let of_camera = |camera: &LodCamera| {
            let allowed = allowed_by(std::slice::from_ref(camera), center, radius, scale);
            let lengths = at.length() + center.length() + camera.eye.length();
            let rounding = if is_distance(object) { 4.0 * POSITION_SLACK * lengths } else { 0.0 };
            metric(object, camera, &placed, allowed) - rounding
        };
        view.cameras().iter().map(of_camera).reduce(f32::min)
    };
    views.iter().filter_map(of_view).reduce(f32::min)
}

fn is_distance(object: &LodObject) -> bool {
    (CRITERION_DISTANCE..=CRITERION_NEAREST).contains(&object_flags_criterion(object.flags))
}
