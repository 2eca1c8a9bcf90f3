//! The GPU pass of `kernels/baseline/texels.wgsl`: loads the texels of colour maps.

use relievo::Error;
use relievo::gpu::bindings::baseline::texels as bindings;
use relievo::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform};
use relievo::shared::baseline::texels::TexelsParams;
use relievo::terrain::blend::BlendBuffers;
use relievo::terrain::blocks::{Columns, Order};
use relievo::terrain::cover::{Cover, planes};

/// Loads the texels of colour maps.
#[derive(Debug, Clone)]
pub struct TexelsPass {
    /// By whether textures lie on the ground from the sides too.
    kernels: [Kernel; 2],
}

impl TexelsPass {
    /// Compiles the pipelines.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let Order { downwards, .. } = Order::of(gpu.tuning());
        let kernel = |triplanar| {
            bindings::kernel(gpu, &bindings::Constants { quads: 1, downwards, planes: planes(triplanar) })
        };
        Ok(Self { kernels: [kernel(false)?, kernel(true)?] })
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
        let blocks = Columns { quads: 1, order: Order::of(gpu.tuning()) }.blocks(windows);
        let [tiles_per_sample, tiles_per_unit] = cover.steps();
        let params = TexelsParams {
            blocks,
            in_width: windows.width,
            zone_count: cover.zones.len() as u32,
            tiles_per_sample,
            tiles_per_unit,
        };
        let zones = Uniform::new(gpu, "zones", &cover.packed_zones())?;
        let texels = Buffer::from_slice(gpu, "texels", &cover.packed_texels())?;
        let group = bindings::Group {
            params: &Uniform::new(gpu, "texels", &params)?,
            windows: windows.heights.slice().cast(),
            zones: &zones,
            texels: texels.slice(),
            places: places.slice(),
            words: pixels.slice(),
        };
        let kernel = &self.kernels[usize::from(cover.triplanar)];
        let step = Step {
            kernel: kernel.clone(),
            groups: vec![group.bind(gpu, kernel)?],
            workgroups: blocks.workgroups(gpu, kernel),
        };
        Ok(Job::new(gpu, "baseline/texels", vec![step])?)
    }
}
