//! Draws terrain in the caller's render pass, straight from the heights: no mesh and no index buffer.

mod scene;

use glam::Mat4;

pub use scene::{FieldsId, TerrainScene};

use crate::gpu::{Buffer, Gpu, GpuError, Uniform, shaders};
use crate::render::pipeline::{Draws, bind};
use crate::shared::render::terrain::View;
use crate::shared::terrain::light::Light;
use crate::shared::terrain::zones;
use crate::terrain::blend::Shading;
use crate::terrain::config::Zone;
use crate::terrain::texture::{TEXTURE_SIZE, Texture};
use crate::{Error, InputError};

/// How terrain is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Zone textures and lighting.
    #[default]
    Textured,
    /// Triangle edges on dark ground.
    Wireframe,
}

/// Draws terrain on targets of one format.
#[derive(Debug, Clone)]
pub struct TerrainRenderer {
    pipeline: wgpu::RenderPipeline,
    layouts: Vec<wgpu::BindGroupLayout>,
}

impl TerrainRenderer {
    /// Compiles the pipeline, unless it is cached for this device, for targets of `color` format with a
    /// [`DEPTH_FORMAT`](crate::render::target::DEPTH_FORMAT) depth buffer.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, color: wgpu::TextureFormat, style: Style) -> Result<Self, GpuError> {
        let draws = Draws {
            shader: &shaders::RENDER_TERRAIN,
            fragment: "fragment",
            constants: &[("WIREFRAME", f64::from(u8::from(style == Style::Wireframe)))],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            cull: None,
            vertices: &[],
        };
        let (pipeline, layouts) = draws.pipeline(gpu, color)?;
        Ok(Self { pipeline, layouts })
    }

    /// Makes an empty scene with these materials.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn scene(
        &self,
        gpu: &Gpu,
        materials: &Materials,
        shading: &Shading,
    ) -> Result<TerrainScene, GpuError> {
        let view = View {
            clip_from_world: Mat4::IDENTITY,
            light: Light { direction: shading.light.into(), ambient: shading.ambient },
            zone_count: materials.zone_count,
            additive: shading.weights.code(),
        };
        let uniform = Uniform::new(gpu, "view", &view)?;
        let texture = materials.textures.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let resources = [
            uniform.raw().as_entire_binding(),
            materials.zones.raw().as_entire_binding(),
            wgpu::BindingResource::TextureView(&texture),
            wgpu::BindingResource::Sampler(&materials.sampler),
        ];
        let group = bind(gpu, &shaders::RENDER_TERRAIN, &self.layouts, 0, &resources)?;
        Ok(TerrainScene::new(self.clone(), view, uniform, group))
    }
}

/// Zone ranges and textures on the device.
#[derive(Debug, Clone)]
pub struct Materials {
    zones: Buffer<zones::Zone>,
    zone_count: u32,
    textures: wgpu::Texture,
    sampler: wgpu::Sampler,
}

impl Materials {
    /// Uploads zones and their textures, one texture per zone.
    ///
    /// # Errors
    /// [`InputError`] when their numbers differ; [`GpuError`].
    pub fn new(gpu: &Gpu, zones: &[Zone], textures: &[Texture]) -> Result<Self, Error> {
        if zones.is_empty() || zones.len() != textures.len() {
            let bound = format!("must be one for each of the {} zones", zones.len());
            return Err(InputError::new("textures.len", textures.len(), bound).into());
        }
        let range = |zone: &Zone| zones::Zone { min: zone.min as f32, max: zone.max as f32 };
        let ranges: Vec<_> = zones.iter().map(range).collect();
        let zone_buffer = Buffer::from_slice(gpu, "zones", &ranges)?;
        let (textures, sampler) = gpu.scoped(|| (upload(gpu, textures), sampler(gpu)))?;
        Ok(Self { zones: zone_buffer, zone_count: zones.len() as u32, textures, sampler })
    }
}

fn upload(gpu: &Gpu, layers: &[Texture]) -> wgpu::Texture {
    let size = |level: u32| wgpu::Extent3d {
        width: TEXTURE_SIZE >> level,
        height: TEXTURE_SIZE >> level,
        depth_or_array_layers: 1,
    };
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("zone textures"),
        size: wgpu::Extent3d { depth_or_array_layers: layers.len() as u32, ..size(0) },
        mip_level_count: TEXTURE_SIZE.ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (layer, image) in layers.iter().enumerate() {
        for (level, texels) in image.mips.iter().enumerate() {
            let to = wgpu::TexelCopyTextureInfo {
                mip_level: level as u32,
                origin: wgpu::Origin3d { z: layer as u32, ..Default::default() },
                ..texture.as_image_copy()
            };
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * (TEXTURE_SIZE >> level)),
                rows_per_image: None,
            };
            gpu.queue().write_texture(to, texels, layout, size(level as u32));
        }
    }
    texture
}

fn sampler(gpu: &Gpu) -> wgpu::Sampler {
    gpu.device().create_sampler(&wgpu::SamplerDescriptor {
        label: Some("zone textures"),
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}
