//! Counts of a view's instances and triangles, copied from the arguments of its indirect draws.

use std::sync::Arc;

use super::{BudgetStatistics, FRAMES, LevelStatistics, ObjectStatistics, ViewStatistics};
use crate::gpu::{Gpu, GpuError, ReadbackRing};
use crate::lod::{BudgetState, OBJECT_LISTS, SceneDraw};
use crate::scene::handles::Slots;
use crate::scene::layout::{Counted, CountedObject};
use crate::scene::object::Object;

/// Facts about a frame whose counts are in flight.
#[derive(Debug)]
struct About {
    counted: Arc<Counted>,
    /// LOD bias of each object; empty if all biases are 1.
    lod_bias: Vec<f32>,
    of_view: FrameOfView,
}

/// Facts about a view in a frame.
#[derive(Debug)]
pub(in crate::scene) struct FrameOfView {
    pub frame: u64,
    pub pixels: f32,
    /// Smallest focal length of the view's perspective cameras, in pixels; `None` if the view has no perspective
    /// camera.
    pub focal: Option<f32>,
    /// Whether the view has a budget of triangles.
    pub has_budget: bool,
    /// Error in pixels of each object at full detail, where it exceeds `pixels`; empty if none does.
    pub finest: Vec<f32>,
}

/// Readback of the counts of one view.
#[derive(Debug)]
pub(in crate::scene) struct ViewCounts {
    counted: Arc<Counted>,
    ring: ReadbackRing<About>,
    last: Option<ViewStatistics>,
}

impl ViewCounts {
    /// Allocates readback buffers for the arguments of a view's draws.
    pub fn new(gpu: &Gpu, counted: &Arc<Counted>, draws: &wgpu::Buffer) -> Result<Self, GpuError> {
        let size = draws.size() + size_of::<BudgetState>() as u64;
        let ring = ReadbackRing::new(gpu, "statistics of a view", FRAMES, size)?;
        Ok(Self { counted: counted.clone(), ring, last: None })
    }

    /// Whether the buffers were made for these objects.
    pub fn is_of(&self, counted: &Arc<Counted>) -> bool {
        Arc::ptr_eq(&self.counted, counted)
    }

    /// Records the copy of the draws' arguments in a frame, if a readback buffer is free.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        draws: &wgpu::Buffer,
        budget: &wgpu::Buffer,
        of_view: FrameOfView,
        objects: &Slots<Object>,
    ) {
        self.arrive();
        // What is drawn coarser than the view asks for has no bound.
        let bias = |object: &Object| if object.kind.is_complete() { object.lod_bias } else { f32::INFINITY };
        let is_coarser = objects.iter().any(|object| bias(object) != 1.0);
        let lod_bias = objects.iter().filter(|_| is_coarser).map(bias).collect();
        let about = About { counted: self.counted.clone(), lod_bias, of_view };
        self.ring.record(encoder, about, |encoder, to| {
            encoder.copy_buffer_to_buffer(draws, 0, to, 0, draws.size());
            encoder.copy_buffer_to_buffer(budget, 0, to, draws.size(), size_of::<BudgetState>() as u64);
        });
    }

    /// The statistics of the last frame whose counts have arrived.
    pub fn last(&mut self) -> Option<&ViewStatistics> {
        self.arrive();
        self.last.as_ref()
    }

    fn arrive(&mut self) {
        let Some((about, bytes)) = self.ring.take() else { return };
        let FrameOfView { frame, pixels: allowed, focal, has_budget, finest } = about.of_view;
        let (bytes, state) = bytes.split_at(bytes.len() - size_of::<BudgetState>());
        let state: BudgetState = bytemuck::pod_read_unaligned(state);
        let whole = bytes.len() / size_of::<SceneDraw>() * size_of::<SceneDraw>();
        let draws = bytemuck::pod_collect_to_vec::<u8, SceneDraw>(&bytes[..whole]);
        let objects: Vec<_> = (about.counted.objects.iter().enumerate())
            .map(|(at, counted)| {
                let coarser = about.lod_bias.get(at).copied().unwrap_or(1.0);
                let coarser = coarser * counted.bias * state.factor(counted.rank);
                let factor = 1.0 + counted.mesh_fraction * (coarser - 1.0).max(0.0);
                let bound = coarser_pixels(allowed, factor, focal);
                let bound = finest.get(at).copied().unwrap_or(0.0).max(bound);
                let pixels = if counted.is_bounded { bound } else { f32::INFINITY };
                let levels = (0..counted.levels).map(|level| counted.level(level, &draws)).collect();
                ObjectStatistics { object: counted.object, pixels, levels }
            })
            .collect();
        let pixels = objects.iter().map(|object| object.pixels).fold(allowed, f32::max);
        let factors = state.factors.as_flattened().iter();
        let budget = has_budget.then(|| BudgetStatistics {
            factor: factors.copied().fold(1.0, f32::max),
            is_missed: state.is_missed != 0,
            fades_ended: state.ends_fades != 0,
        });
        self.last = Some(ViewStatistics { frame, pixels, budget, objects });
    }
}

impl CountedObject {
    /// The instances and triangles in all draws of one level of detail.
    fn level(&self, level: u32, draws: &[SceneDraw]) -> LevelStatistics {
        let mut found = LevelStatistics::default();
        let passes = if self.fades { 2 } else { 1 };
        let lists = (0..passes).flat_map(|pass| [0, 1].map(|side| 2 * (pass * self.levels + level) + side));
        for (list, first) in lists.flat_map(|list| self.first_draws.iter().map(move |first| (list, first))) {
            for part in 0..self.parts {
                let at = (first + OBJECT_LISTS * part + list) as usize;
                let Some(draw) = draws.get(at) else { continue };
                found.instances += if part == 0 { draw.instance_count } else { 0 };
                found.triangles += u64::from(draw.index_count / 3) * u64::from(draw.instance_count);
            }
        }
        found
    }
}

/// The error in pixels if the displacement that `pixels` allows is multiplied by `factor`. On the view axis at depth z,
/// the displacement that `pixels` allows is d = z · pixels / (focal + pixels). A displacement of e is at most focal · e
/// / (z − e) pixels on the screen.
fn coarser_pixels(pixels: f32, factor: f32, focal: Option<f32>) -> f32 {
    match focal {
        _ if factor <= 1.0 => pixels,
        None => factor * pixels,
        Some(focal) => {
            let share = factor * pixels / (focal + pixels);
            if share < 1.0 { focal * share / (1.0 - share) } else { f32::INFINITY }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coarser_levels_are_more_pixels_off() {
        assert_eq!(coarser_pixels(1.0, 1.0, Some(100.0)), 1.0);
        assert_eq!(coarser_pixels(1.0, 3.0, None), 3.0);
        // A displacement of 3/101 of the depth is 100 · 3/98 pixels.
        assert!((coarser_pixels(1.0, 3.0, Some(100.0)) - 300.0 / 98.0).abs() < 1e-5);
        assert_eq!(coarser_pixels(1.0, 200.0, Some(100.0)), f32::INFINITY);
    }
}
