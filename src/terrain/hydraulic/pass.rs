//! The GPU pass of `kernels/terrain/hydraulic.wgsl`, with one dispatch per cycle.

use super::Hydraulic;
use super::reference::Flow;
use crate::Error;
use crate::gpu::bindings::terrain::hydraulic as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Step, Uniform, pass};
use crate::terrain::config::check_terrain_scale;
use crate::terrain::fields::Fields;

/// Buffers of hydraulic erosion.
#[derive(Debug, Clone, Copy)]
pub struct HydraulicBuffers<'a> {
    /// Read and written: the windows to erode.
    pub windows: &'a Fields,
    /// Written: a second buffer. The cycles alternate between `windows` and this buffer. It must hold the same number of windows,
    /// each one sample smaller on every side.
    pub other: &'a Fields,
    /// Written: scratch memory for water and sediment, at least [`HydraulicPass::flow_points`] elements.
    pub flows: &'a Buffer<Flow>,
    /// Written: second scratch memory for water and sediment, with the same length as `flows`.
    pub other_flows: &'a Buffer<Flow>,
}

pass! {
    /// Applies hydraulic erosion to windows of heights; see [`Hydraulic`].
    pub struct HydraulicPass;
}

impl HydraulicPass {
    /// Number of elements that [`HydraulicBuffers::flows`] needs for the given windows.
    pub fn flow_points(windows: &Fields) -> usize {
        windows.points(1)
    }

    /// Prepares all cycles. They alternate between `windows` and `other`, and each drops the outermost ring of samples. After an
    /// even number of cycles the result is in `windows`, otherwise in `other`. Heights must not exceed 2^30 − 1 in size, in
    /// 1/65536 height units. The results stay within the same limit.
    ///
    /// # Errors
    /// [`InputError`](crate::InputError) for parameters out of bounds, for windows with fewer rings of samples than cycles, and
    /// for a buffer that is too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        hydraulic: Hydraulic,
        terrain_scale: f64,
        buffers: HydraulicBuffers<'_>,
    ) -> Result<Job, Error> {
        let HydraulicBuffers { windows, other, flows, other_flows } = buffers;
        hydraulic.validate()?;
        check_terrain_scale(terrain_scale)?;
        windows.check("windows", hydraulic.iterations)?;
        if hydraulic.iterations > 0 {
            let points = Self::flow_points(windows);
            other.heights.check_holds("other.heights", points)?;
            flows.check_holds("flows", points)?;
            other_flows.check_holds("other_flows", points)?;
        }
        let steps = (0..hydraulic.iterations).map(|cycle| {
            let sides = [(windows, flows), (other, other_flows)];
            let [from, to] = if cycle % 2 == 0 { sides } else { [sides[1], sides[0]] };
            let at = windows.cropped(cycle);
            let params = hydraulic.params(terrain_scale, cycle, at.width);
            let group = bindings::Group {
                params: &Uniform::new(gpu, "hydraulic", &params)?,
                windows: from.0.heights.slice(),
                outputs: to.0.heights.slice(),
                flows: from.1.slice(),
                flow_outputs: to.1.slice(),
            };
            let groups = vec![group.bind(gpu, &self.kernel)?];
            Ok(Step::covering(&self.kernel, groups, at.threads(1)))
        });
        let steps = steps.collect::<Result<_, GpuError>>()?;
        Ok(Job::new(gpu, "terrain/hydraulic", steps)?)
    }
}
