//! Draws terrain in the caller's render pass, straight from the heights: no mesh and no index buffer.

mod scene;

use glam::Mat4;

pub use scene::{FieldsId, TerrainScene};

use crate::gpu::{Gpu, GpuError, Uniform, shaders};
use crate::render::pipeline::{Draws, bind};
use crate::shared::render::terrain::View;
use crate::shared::terrain::light::Light;
use crate::terrain::blend::Shading;
pub use crate::terrain::materials::Materials;

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
        let texture = materials.view();
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
