//! The GPU pass of `kernels/baseline/texels.wgsl`: loads the texels of colour maps.

use relievo::Error;
use relievo::gpu::bindings::baseline::texels as bindings;
use relievo::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use relievo::ops::terrain::blend::BlendBuffers;
use relievo::ops::terrain::cover::Cover;
use relievo::shared::baseline::texels::TexelsParams;

/// Loads the texels of colour maps.
#[derive(Debug, Clone)]
pub struct TexelsPass {
    kernel: Kernel,
}

impl TexelsPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the loads of the colour maps of a cover; each pixel becomes a word.
    ///
    /// # Errors
    /// [`relievo::InputError`] for a cover out of bounds, for windows with nothing inside the outermost ring, and for places or an
    /// output that are too short; [`GpuError`].
    pub fn prepare(&self, gpu: &Gpu, cover: &Cover, buffers: BlendBuffers<'_>) -> Result<Job, Error> {
        let BlendBuffers { windows, places, pixels } = buffers;
        cover.validate()?;
        windows.check("windows", 1)?;
        places.check_holds("places", windows.count as usize)?;
        pixels.check_holds("pixels", windows.points(1))?;
        let [tiles_per_sample, tiles_per_unit] = cover.steps();
        let params = TexelsParams {
            width: windows.width,
            zone_count: cover.zones.len() as u32,
            planes: cover.planes(),
            tiles_per_sample,
            tiles_per_unit,
        };
        let zones = Buffer::from_slice(gpu, "zones", &cover.zones)?;
        let texels = Buffer::from_slice(gpu, "texels", &cover.packed_texels())?;
        let group = bindings::Group {
            params: &Uniform::new(gpu, "texels", &params)?,
            windows: windows.heights.slice(),
            zones: zones.slice(),
            texels: texels.slice(),
            places: places.slice(),
            words: pixels.slice(),
        };
        let groups = vec![group.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, windows.threads(1));
        Ok(Job::new(gpu, "baseline/texels", vec![step])?)
    }
}
