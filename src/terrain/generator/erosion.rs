//! Erosion of windows on the device. Iterations alternate between the windows' buffer and a second buffer.

use super::Generator;
use crate::Error;
use crate::gpu::{Buffer, Gpu};
use crate::terrain::fields::{Fields, REMEDY, after};
use crate::terrain::hydraulic::{Hydraulic, HydraulicBuffers, HydraulicPass};
use crate::terrain::thermal::{Thermal, ThermalBuffers};

impl Generator {
    /// Applies thermal erosion to the first of two buffers. Returns both buffers, the one with the result first.
    pub(super) async fn slide(
        &self,
        gpu: &Gpu,
        thermal: Option<Thermal>,
        both: [Fields; 2],
    ) -> Result<[Fields; 2], Error> {
        let Some(thermal) = thermal.filter(|thermal| thermal.iterations > 0) else { return Ok(both) };
        let buffers = ThermalBuffers { windows: &both[0], other: &both[1] };
        let job = self.thermal.prepare(gpu, thermal, self.recipe.config.terrain_scale, buffers)?;
        job.run_async(gpu).await?;
        Ok(after(both, thermal.iterations))
    }

    /// Applies hydraulic erosion to the first of two buffers. Returns both buffers, the one with the result first.
    pub(super) async fn rain(
        &self,
        gpu: &Gpu,
        (pass, hydraulic): (&HydraulicPass, Hydraulic),
        both: [Fields; 2],
    ) -> Result<[Fields; 2], Error> {
        if hydraulic.iterations == 0 {
            return Ok(both);
        }
        let points = HydraulicPass::flow_points(&both[0]);
        let flow = |label| Buffer::new(gpu, label, points).map_err(|error| error.with_remedy(REMEDY));
        let (flows, other_flows) = (flow("water and sediment")?, flow("other water and sediment")?);
        let [windows, other] = &both;
        let buffers = HydraulicBuffers { windows, other, flows: &flows, other_flows: &other_flows };
        let job = pass.prepare(gpu, hydraulic, self.recipe.config.terrain_scale, buffers)?;
        job.run_async(gpu).await?;
        Ok(after(both, hydraulic.iterations))
    }
}
