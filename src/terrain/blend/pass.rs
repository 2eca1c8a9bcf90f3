//! The GPU pass of `kernels/terrain/blend.wgsl`.

use encase::ShaderType;
use glam::Vec3;

use super::{MapZone, Shading, check_map_zones};
use crate::Error;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders, storage};
use crate::terrain::config::{HEIGHT_ONE, check_terrain_scale};
use crate::terrain::fields::Fields;

/// `Light` of the shaders.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct Light {
    pub direction: Vec3,
    pub ambient: f32,
}

/// `MapParams` of the kernel.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct MapParams {
    pub light: Light,
    pub in_width: u32,
    pub run: f32,
    pub zone_count: u32,
    pub additive: u32,
}

/// `Zone` of the shaders.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct ZoneRange {
    pub min: f32,
    pub max: f32,
}

/// `MapZone` of the shaders.
#[derive(Debug, Clone, Copy, ShaderType)]
pub(crate) struct ShaderZone {
    pub color: Vec3,
    pub zone: ZoneRange,
}

impl From<&MapZone> for ShaderZone {
    fn from(zone: &MapZone) -> Self {
        Self { color: zone.color.into(), zone: ZoneRange { min: zone.min, max: zone.max } }
    }
}

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
        Ok(Self { kernel: Kernel::new(gpu, &shaders::TERRAIN_BLEND, &[])? })
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
        let zones: Vec<_> = zones.iter().map(ShaderZone::from).collect();
        let zones = storage(gpu, "zones", &zones)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            windows.heights.raw().as_entire_binding(),
            zones.raw().as_entire_binding(),
            pixels.raw().as_entire_binding(),
        ];
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: windows.workgroups(&self.kernel, 1),
        };
        Ok(Job::new(gpu, "terrain/blend", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;

    layout_test!(map_params_layout: MapParams = TERRAIN_BLEND "MapParams");
    layout_test!(light_layout: Light = TERRAIN_BLEND "Light");
    layout_test!(shader_zone_layout: ShaderZone = TERRAIN_BLEND "MapZone");
    layout_test!(zone_range_layout: ZoneRange = TERRAIN_BLEND "Zone");
}
