//! Terrain zones and their textures on the device.

use crate::gpu::{Buffer, Gpu};
use crate::terrain::config::Zone;
use crate::terrain::cover::{ShaderZone, zone_of};
use crate::terrain::texture::{TEXTURE_SIZE, TerrainTexture};
use crate::{Error, InputError};

/// Zones of ground and the zones' textures on the device.
#[derive(Debug, Clone)]
pub struct Materials {
    pub(crate) zones: Buffer<ShaderZone>,
    pub(crate) zone_count: u32,
    pub(crate) textures: wgpu::Texture,
    pub(crate) sampler: wgpu::Sampler,
}

impl Materials {
    /// Uploads zones and their textures, one texture per zone in the same order.
    ///
    /// # Errors
    /// [`InputError`] when there are no zones or when the numbers of zones and textures differ; [`crate::gpu::GpuError`].
    pub fn new(gpu: &Gpu, zones: &[Zone], textures: &[TerrainTexture]) -> Result<Self, Error> {
        if zones.is_empty() || zones.len() != textures.len() {
            let bound = format!("must be one for each of the {} zones", zones.len());
            return Err(InputError::new("textures.len", textures.len(), bound).into());
        }
        let shader_zones: Vec<_> = zones.iter().map(zone_of).collect();
        let zone_buffer = Buffer::from_slice(gpu, "zones", &shader_zones)?;
        let (textures, sampler) =
            gpu.scoped(|| (upload(gpu, textures), gpu.trilinear_sampler("zone textures", true)))?;
        Ok(Self { zones: zone_buffer, zone_count: zones.len() as u32, textures, sampler })
    }

    /// View of the textures as a texture array with one layer per zone, for binding.
    pub(crate) fn view(&self) -> wgpu::TextureView {
        self.textures.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        })
    }
}

fn upload(gpu: &Gpu, layers: &[TerrainTexture]) -> wgpu::Texture {
    let (size, levels) = ([TEXTURE_SIZE, TEXTURE_SIZE, layers.len() as u32], TEXTURE_SIZE.ilog2() + 1);
    let format = wgpu::TextureFormat::Rgba8UnormSrgb;
    let texture = gpu.sampled_texture("zone textures", size, levels, format);
    for (layer, image) in (0..).zip(layers) {
        for (level, texels) in (0..).zip(&image.mips) {
            gpu.fill_level(&texture, [level, layer], texels);
        }
    }
    texture
}
