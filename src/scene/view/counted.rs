//! Statistics of a view.

use std::sync::Arc;

use super::View;
use crate::gpu::{Gpu, GpuError};
use crate::scene::handles::Slots;
use crate::scene::layout::Counted;
use crate::scene::object::Object;
use crate::scene::statistics::ViewStatistics;
use crate::scene::statistics::view::ViewCounts;

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
        let (focal, has_budget) = (self.shortest_focal(), self.has_budget());
        let (Some(counts), Some(lists)) = (&mut self.counts, &self.lists) else { return };
        let buffers = (lists.arguments.raw(), lists.budget_state.raw());
        counts.record(encoder, buffers, (frame, self.quality.pixels, focal, has_budget), objects);
    }

    /// The smallest focal length, in pixels, among the perspective cameras that decide the view's levels of detail.
    fn shortest_focal(&self) -> Option<f32> {
        let (_, view) = self.select_view(0, false).ok()?;
        let perspective = view.cameras().iter().filter(|camera| camera.perspective > 0.0);
        perspective.map(|camera| camera.focal).reduce(f32::min)
    }
}
