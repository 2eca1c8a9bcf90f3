//! Statistics of a view.

use std::sync::Arc;

use super::View;
use crate::gpu::{Gpu, GpuError};
use crate::scene::handles::Slots;
use crate::scene::layout::Counted;
use crate::scene::object::Object;
use crate::scene::statistics::ViewStatistics;
use crate::scene::statistics::view::{FrameOfView, ViewCounts};

impl View {
    /// Statistics of the last frame whose counts have arrived. `None` if statistics are off
    /// ([`Scene::set_statistics`](crate::scene::Scene::set_statistics)), and before the first counts arrive. The call
    /// does not wait. Counts arrive when the device has executed the frame and is polled; each submission polls the
    /// device.
    pub fn statistics(&mut self) -> Option<&ViewStatistics> {
        self.counts.as_mut()?.last()
    }

    /// Allocates readback buffers for the counts of these objects. With `None`, frees the buffers.
    pub(in crate::scene) fn fit_counts(
        &mut self,
        gpu: &Gpu,
        counted: Option<&Arc<Counted>>,
    ) -> Result<(), GpuError> {
        let (Some(counted), Some(lists)) = (counted, &self.lists) else {
            self.counts = None;
            return Ok(());
        };
        if self.counts.as_ref().is_none_or(|counts| !counts.is_of(counted)) {
            self.counts = Some(ViewCounts::new(gpu, counted, lists.arguments.raw())?);
        }
        Ok(())
    }

    /// Records commands that copy a frame's counts to a readback buffer.
    pub(in crate::scene) fn count(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: u64,
        objects: &Slots<Object>,
    ) {
        let (pixels, focal, has_budget) = (self.quality.pixels, self.shortest_focal(), self.has_budget());
        let finest = self.finest_pixels(objects);
        let (Some(counts), Some(lists)) = (&mut self.counts, &self.lists) else { return };
        let of_view = FrameOfView { frame, pixels, focal, has_budget, finest };
        counts.record(encoder, lists.arguments.raw(), lists.budget_state.raw(), of_view, objects);
    }

    /// For each object, an upper bound in pixels of the error of its instances at full detail, where this error is above what the
    /// view allows; otherwise 0. The list is empty if all are 0. Instances that the view does not show count too.
    fn finest_pixels(&self, objects: &Slots<Object>) -> Vec<f32> {
        let Ok((_, view)) = self.select_view(0, false) else { return Vec::new() };
        let of_object = |object: &Object| match object.finest_error > 0.0 && object.is_drawn() {
            true => object.finest_pixels(view.cameras(), view.cell),
            false => 0.0,
        };
        let all: Vec<f32> = objects.iter().map(of_object).collect();
        if all.iter().any(|pixels| *pixels > 0.0) { all } else { Vec::new() }
    }

    /// The smallest focal length, in pixels, among the perspective cameras that decide the view's levels of detail.
    fn shortest_focal(&self) -> Option<f32> {
        let (_, view) = self.select_view(0, false).ok()?;
        let perspective = view.cameras().iter().filter(|camera| camera.perspective > 0.0);
        perspective.map(|camera| camera.focal).reduce(f32::min)
    }
}
