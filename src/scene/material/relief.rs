//! Device resources of a relief on a part of a static mesh.

use crate::gpu::bindings::render::scene_relief::Group2;
use crate::gpu::{Gpu, Group, Uniform};
use crate::scene::layouts::SceneLayouts;
use crate::shared::render::scene_relief::ReliefParams;
use crate::shared::surface::ray::SurfaceMarch;
use crate::surface::relief::March;
use crate::surface::{ReliefMaps, ReliefMaterial, ReliefOptions};
use crate::{Error, InputError};

/// The relief of a part, bound in place of materials.
#[derive(Debug, Clone)]
pub(crate) struct ReliefBindings {
    /// Bind group 2 of `render/scene_relief`.
    pub group: Group,
    /// Options for which the part's pipelines are compiled.
    pub options: ReliefOptions,
}

/// Parameters of a relief, without its maps and options.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ReliefLook {
    /// Depth and plane of the relief, and softness of its shadows. The material's light is ignored, because the scene
    /// has one light.
    pub material: ReliefMaterial,
    /// Settings of the ray march.
    pub march: March,
    /// Range of the mesh's texture coordinates: lowest and highest (u, v).
    pub range: [[f32; 2]; 2],
    /// Length of one uv unit in model units, above 0.
    pub world: f32,
    /// Factor of the albedo: linear red, green and blue.
    pub color: [f32; 3],
}

impl ReliefBindings {
    /// Binds a relief's maps, each with its own sampler.
    ///
    /// # Errors
    /// [`InputError`] for arguments that are out of range or do not match each other; [`crate::gpu::GpuError`].
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        maps: ReliefMaps<'_>,
        options: ReliefOptions,
        look: &ReliefLook,
    ) -> Result<Self, Error> {
        look.validate()?;
        maps.textures.check(options.method, &look.march).map_err(|error| match &*error.path {
            "method" => error.below("options"),
            _ => error,
        })?;
        if options.normal_map.is_some() && maps.normals.is_none() {
            let bound = "must be a normal map, which the options ask for";
            return Err(InputError::new("maps.normals", "nothing", bound).into());
        }
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let [heights, acceleration] = &maps.textures.views();
        let group = Group2 {
            relief: &Uniform::new(gpu, "scene relief", &look.params())?,
            march: &Uniform::new(gpu, "scene relief march", &SurfaceMarch::from(look.march))?,
            heights,
            acceleration,
            albedo: &view(&maps.albedo.texture),
            normals: &view(&maps.normals.unwrap_or(maps.albedo).texture),
            filtering: &maps.albedo.sampler,
            normal_filtering: &maps.normals.unwrap_or(maps.albedo).sampler,
        };
        Ok(Self { group: group.bind(gpu, &layouts.relief)?, options })
    }
}

impl ReliefLook {
    fn validate(&self) -> Result<(), InputError> {
        self.material.validate().map_err(|error| error.below("material"))?;
        self.march.validate().map_err(|error| error.below("march"))?;
        let bound = || "must be finite and above 0: the length of a unit of uv";
        InputError::check(self.world > 0.0 && self.world.is_finite(), "mesh", self.world, bound)?;
        Ok(())
    }

    fn params(&self) -> ReliefParams {
        let ReliefMaterial { scale, plane, shadow_steps, softness, .. } = self.material;
        let [[low_u, low_v], [high_u, high_v]] = self.range;
        ReliefParams {
            range: glam::Vec4::new(low_u, low_v, high_u, high_v),
            color: glam::Vec3::from(self.color).extend(1.0),
            scale,
            plane,
            world: self.world,
            shadow_steps,
            softness,
        }
    }
}
