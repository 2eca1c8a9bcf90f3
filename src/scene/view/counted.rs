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
    /// What the view saw in the last frame whose counts have arrived; `None` before the first, and unless
    /// [`Scene::set_statistics`](crate::scene::Scene::set_statistics) asked for them. Nothing is waited for: they arrive
    /// when the device has executed the frame and is polled, as each submission does.
    pub fn statistics(&mut self) -> Option<&ViewStatistics> {
        self.counts.as_mut()?.last()
    }

    /// Allocates what the counts of these objects need, or gives it up.
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

    /// Records the copies of a frame's counts.
    pub(in crate::scene) fn count(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: u64,
        objects: &Slots<Object>,
    ) {
        let focal = self.shortest_focal();
        let (Some(counts), Some(lists)) = (&mut self.counts, &self.lists) else { return };
        counts.record(encoder, lists.arguments.raw(), (frame, self.quality.pixels, focal), objects);
    }

    /// The smallest focal length, in pixels, of the perspective cameras that decide how fine the view is.
    fn shortest_focal(&self) -> Option<f32> {
        let (_, view) = self.select_view(0, false).ok()?;
        let perspective = view.cameras().iter().filter(|camera| camera.perspective > 0.0);
        perspective.map(|camera| camera.focal).reduce(f32::min)
    }
}
