//! The GPU pass of `kernels/terrain/blend.wgsl`.

use super::{MapZone, Shading, check_map_zones};
use crate::Error;
use crate::gpu::bindings::terrain::blend as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use crate::shared::terrain::blend::MapParams;
use crate::shared::terrain::light::Light;
use crate::terrain::config::{HEIGHT_ONE, check_terrain_scale};
use crate::terrain::fields::Fields;

/// Draws the top-down colour maps of patches.
#[derive(Debug, Clone)]
pub struct BlendPass {
    kernel: Kernel,
}

impl BlendPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the colour maps of `windows`: `pixels` receives a pixel for every sample but those of the
    /// outermost ring (RGBA, 8 bits each, red in the lowest byte, sRGB).
    ///
    /// # Errors
    /// [`crate::InputError`] for a spacing, zones or shading out of bounds, for windows with nothing inside the
    /// outermost ring, and for an output that is too short; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        terrain_scale: f64,
        zones: &[MapZone],
        shading: &Shading,
        windows: &Fields,
        pixels: &Buffer<u32>,
    ) -> Result<Job, Error> {
        check_terrain_scale(terrain_scale)?;
        check_map_zones(zones)?;
        shading.validate()?;
        windows.check("windows", 1)?;
        pixels.check_holds("pixels", windows.points(1))?;
        let params = MapParams {
            light: Light { direction: shading.light.into(), ambient: shading.ambient },
            in_width: windows.width,
            run: (2.0 * terrain_scale * HEIGHT_ONE) as f32,
            zone_count: zones.len() as u32,
            additive: shading.weights.code(),
        };
        let uniform = Uniform::new(gpu, "colour map", &params)?;
        let zones = Buffer::from_slice(gpu, "zones", zones)?;
        let group = bindings::Group {
            params: &uniform,
            windows: windows.heights.slice(),
            zones: zones.slice(),
            pixels: pixels.slice(),
        };
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![group.bind(gpu, &self.kernel)?],
            workgroups: windows.workgroups(&self.kernel, 1),
        };
        Ok(Job::new(gpu, "terrain/blend", vec![step])?)
    }
}
