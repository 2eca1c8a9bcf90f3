//! Erosion of windows on the device: all stages of a recipe. Each iteration drops the outermost ring of samples.

use crate::gpu::{Buffer, Gpu, GpuError, Job};
use crate::terrain::fields::{Fields, after};
use crate::terrain::hydraulic::reference::Flow;
use crate::terrain::hydraulic::{HydraulicBuffers, HydraulicPass};
use crate::terrain::recipe::{ErosionStage as Stage, Recipe};
use crate::terrain::thermal::{ThermalBuffers, ThermalPass};
use crate::{Error, InputError};

/// The erosion of a recipe, with the pipelines that it needs.
#[derive(Debug, Clone)]
pub(crate) struct ErosionPass {
    stages: Vec<Stage>,
    /// Distance between samples in world units.
    scale: f64,
    thermal: ThermalPass,
    /// `None` without hydraulic erosion.
    hydraulic: Option<HydraulicPass>,
}

/// The buffers of windows that are eroded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Eroding<'a> {
    /// The windows, and a second buffer. Iterations alternate between both.
    pub windows: &'a [Fields; 2],
    /// What [`ErosionPass::flows`] allocates for windows of this size.
    pub flows: Option<&'a [Buffer<Flow>; 2]>,
}

impl ErosionPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, recipe: &Recipe) -> Result<Self, Error> {
        let stages: Vec<_> = recipe.erosion().collect();
        let has_rain = stages.iter().any(|stage| matches!(stage, Stage::Hydraulic(_)));
        let hydraulic = has_rain.then(|| HydraulicPass::new(gpu)).transpose()?;
        Ok(Self { stages, scale: recipe.config.terrain_scale, thermal: ThermalPass::new(gpu)?, hydraulic })
    }

    /// Allocates water and sediment of windows, and a second buffer; `None` without hydraulic erosion.
    ///
    /// # Errors
    /// [`GpuError::Limit`] or [`GpuError::OutOfMemory`].
    pub fn flows(&self, gpu: &Gpu, windows: &Fields) -> Result<Option<[Buffer<Flow>; 2]>, GpuError> {
        let points = HydraulicPass::flow_points(windows);
        let flow = |label| Buffer::new(gpu, label, points);
        let both = || Ok([flow("water and sediment")?, flow("water and sediment, in turn")?]);
        self.hydraulic.as_ref().map(|_| both()).transpose()
    }

    /// Prepares all stages. Returns their jobs, and the fields with the result after them.
    ///
    /// # Errors
    /// [`InputError`] for buffers that are missing or too small; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, eroding: Eroding<'_>) -> Result<(Vec<Job>, Fields), Error> {
        let (scale, mut both) = (self.scale, eroding.windows.clone());
        let mut jobs = Vec::new();
        for &stage in &self.stages {
            let [windows, other] = &both;
            match (stage, &self.hydraulic, eroding.flows) {
                (Stage::Thermal(thermal), ..) => {
                    jobs.push(self.thermal.prepare(
                        gpu,
                        thermal,
                        scale,
                        ThermalBuffers { windows, other },
                    )?);
                }
                (Stage::Hydraulic(hydraulic), Some(pass), Some([flows, other_flows])) => {
                    let buffers = HydraulicBuffers { windows, other, flows, other_flows };
                    jobs.push(pass.prepare(gpu, hydraulic, scale, buffers)?);
                }
                (Stage::Hydraulic(_), ..) => {
                    let bound = "must be there for hydraulic erosion";
                    return Err(InputError::new("flows", "none", bound).into());
                }
            }
            both = after(both, stage.iterations());
        }
        let [windows, _] = both;
        Ok((jobs, windows))
    }
}
