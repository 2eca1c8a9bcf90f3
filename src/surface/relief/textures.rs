//! Textures that shaders trace rays through: height maps and their acceleration maps.

use crate::gpu::{Gpu, GpuError};
use crate::surface::HeightMapBatch;
use crate::surface::cone_map::ConeMapPass;
use crate::surface::height_pyramid::{HeightPyramidPass, Pyramids};
use crate::surface::map::{Address, HeightMap};
use crate::surface::relief::{March, ReliefMethod};
use crate::{Error, InputError};

/// Textures that one method needs: the height map and its acceleration map.
#[derive(Debug, Clone)]
pub struct SurfaceTextures {
    /// Heights in the red channel, `R32Float`, with all mip levels.
    pub heights: wgpu::Texture,
    /// Acceleration map: the height pyramid (`R32Float`) or the cone map (`Rg32Float`). A single texel for methods that need no
    /// acceleration map.
    pub acceleration: wgpu::Texture,
    /// Method that the acceleration map was computed for.
    pub method: ReliefMethod,
    /// Address mode that the acceleration map was computed for.
    pub address: Address,
}

impl SurfaceTextures {
    /// Uploads a height map, and computes the acceleration map of `method` on the device. This is set-up work: it submits
    /// commands to the device, but does not wait for them.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, map: &HeightMap, method: ReliefMethod, address: Address) -> Result<Self, Error> {
        let heights = upload(gpu, map)?;
        let acceleration = match method {
            ReliefMethod::Quadtree | ReliefMethod::Cone => accelerated(gpu, map, method, address)?,
            _ => texture(gpu, "no acceleration", [1, 1], 1, wgpu::TextureFormat::R32Float)?,
        };
        Ok(Self { heights, acceleration, method, address })
    }

    /// Default texture views of the heights and of the acceleration map, to bind.
    pub fn views(&self) -> [wgpu::TextureView; 2] {
        [&self.heights, &self.acceleration]
            .map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()))
    }

    /// Returns an error unless the textures were computed for `method` and for the address mode of `march`.
    pub fn check(&self, method: ReliefMethod, march: &March) -> Result<(), InputError> {
        let bound = || format!("must be {}, which its maps were made for", self.method.name());
        InputError::check(self.method == method, "method", method.name(), bound)?;
        let bound = || format!("must be {}, which its maps were made for", self.address.name());
        InputError::check(self.address == march.address, "march.address", march.address.name(), bound)?;
        Ok(())
    }
}

fn accelerated(
    gpu: &Gpu,
    map: &HeightMap,
    method: ReliefMethod,
    address: Address,
) -> Result<wgpu::Texture, Error> {
    let batch = HeightMapBatch::new(gpu, std::slice::from_ref(map))?;
    let pyramids = Pyramids::new(gpu, &batch, address)?;
    let pyramid_job = HeightPyramidPass::new(gpu)?.prepare(gpu, &batch, &pyramids)?;
    let layout = pyramids.layout;
    if method == ReliefMethod::Quadtree {
        let size = [layout.pitch, layout.rows];
        let plane = texture(gpu, "pyramid", size, 1, wgpu::TextureFormat::R32Float)?;
        gpu.submit("pyramid", |encoder| {
            pyramid_job.record(encoder);
            copy(encoder, pyramids.nodes.raw(), &plane, 4 * layout.pitch);
        })?;
        return Ok(plane);
    }
    let pass = ConeMapPass::new(gpu)?;
    let cones = pass.output(gpu, &pyramids)?;
    let cone_job = pass.prepare(gpu, &batch, &pyramids, &cones)?;
    let plane = texture(gpu, "cones", layout.cells, 1, wgpu::TextureFormat::Rg32Float)?;
    gpu.submit("cones", |encoder| {
        pyramid_job.record(encoder);
        cone_job.record(encoder);
        copy(encoder, cones.cones.raw(), &plane, 8 * cones.pitch);
    })?;
    Ok(plane)
}

fn texture(
    gpu: &Gpu,
    label: &'static str,
    [width, height]: [u32; 2],
    levels: u32,
    format: wgpu::TextureFormat,
) -> Result<wgpu::Texture, GpuError> {
    gpu.check_texture(label, [width, height], "use a smaller height map")?;
    gpu.scoped(|| gpu.sampled_texture(label, [width, height, 1], levels, format))
}

/// Copies the first map of a buffer to a texture. `pitch` is the size of a row in bytes, a multiple of 256.
fn copy(encoder: &mut wgpu::CommandEncoder, from: &wgpu::Buffer, to: &wgpu::Texture, pitch: u32) {
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(pitch), rows_per_image: None };
    let from = wgpu::TexelCopyBufferInfo { buffer: from, layout };
    encoder.copy_buffer_to_texture(from, to.as_image_copy(), to.size());
}

/// Uploads a height map with all its mip levels. Each texel of a level is the mean of four texels of the level before.
fn upload(gpu: &Gpu, map: &HeightMap) -> Result<wgpu::Texture, GpuError> {
    let levels = map.width().max(map.height()).ilog2() + 1;
    let size = [map.width(), map.height()];
    let heights = texture(gpu, "heights", size, levels, wgpu::TextureFormat::R32Float)?;
    let mut level = map.clone();
    for mip in 0..levels {
        if mip > 0 {
            level = level.halved();
        }
        gpu.scoped(|| gpu.fill_level(&heights, [mip, 0], bytemuck::cast_slice(level.heights())))?;
    }
    Ok(heights)
}
