//! The GPU pass of `kernels/terrain/blend.wgsl`.

use super::Shading;
use crate::Error;
use crate::gpu::bindings::terrain::blend as bindings;
use crate::gpu::{Buffer, Gpu, Job, Step, Uniform, pass};
use crate::shared::terrain::blend::MapParams;
use crate::shared::terrain::light::Light;
use crate::terrain::config::HEIGHT_ONE;
use crate::terrain::cover::Cover;
use crate::terrain::fields::Fields;

pass! {
    /// Draws top-down colour maps of patches.
    pub struct BlendPass;
}

/// Buffers of a [`BlendPass`] job.
#[derive(Debug, Clone, Copy)]
pub struct BlendBuffers<'a> {
    /// Read: windows of heights, each with one sample of margin on every side.
    pub windows: &'a Fields,
    /// Read: texture position of each window's first inner sample ([`Cover::place`]), in 2^-22 tiles.
    pub places: &'a Buffer<[u32; 2]>,
    /// Written: one sRGB pixel per sample inside each window's outermost ring. A pixel is RGBA with 8 bits per channel, red in
    /// the lowest byte.
    pub pixels: &'a Buffer<u32>,
}

impl BlendPass {
    /// Uploads the ground cover and prepares a job that draws the colour maps of all windows.
    ///
    /// # Errors
    /// [`crate::InputError`] for a cover or a shading out of bounds, for windows with nothing inside the outermost ring, and for
    /// `places` or `pixels` that are too short; [`crate::gpu::GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        cover: &Cover,
        shading: &Shading,
        buffers: BlendBuffers<'_>,
    ) -> Result<Job, Error> {
        let BlendBuffers { windows, places, pixels } = buffers;
        cover.validate()?;
        shading.validate()?;
        windows.check("windows", 1)?;
        places.check_holds("places", windows.count as usize)?;
        pixels.check_holds("pixels", windows.points(1))?;
        let zones = Buffer::from_slice(gpu, "zones", &cover.zones)?;
        let texels = Buffer::from_slice(gpu, "texels", &cover.packed_texels())?;
        let group = bindings::Group {
            params: &Uniform::new(gpu, "colour map", &params(cover, shading, windows))?,
            windows: windows.heights.slice(),
            zones: zones.slice(),
            texels: texels.slice(),
            places: places.slice(),
            pixels: pixels.slice(),
        };
        let groups = vec![group.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, windows.threads(1));
        Ok(Job::new(gpu, "terrain/blend", vec![step])?)
    }
}

fn params(cover: &Cover, shading: &Shading, windows: &Fields) -> MapParams {
    let [tiles_per_sample, tiles_per_unit] = cover.steps();
    MapParams {
        light: Light { direction: shading.light.into(), ambient: shading.ambient },
        width: windows.width,
        run: (2.0 * cover.terrain_scale * HEIGHT_ONE) as f32,
        zone_count: cover.zones.len() as u32,
        additive: shading.weights.code(),
        planes: cover.planes(),
        tiles_per_sample,
        tiles_per_unit,
        variation: cover.variation,
    }
}
