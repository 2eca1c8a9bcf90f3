//! The GPU pass of `kernels/surface/shade.wgsl`.

use encase::ShaderType;
use glam::{Mat4, Vec4};

use super::{Shade, ShadePoint};
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Step, Uniform, shaders};
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::relief::{March, Method, SurfaceMarch};
use crate::{Error, InputError};

/// The shader's `ShadeView`.
#[derive(Debug, Clone, Copy, ShaderType)]
struct ShadeView {
    clip_from_world: Mat4,
    eye: Vec4,
    shadow_steps: u32,
    softness: f32,
}

/// Shades lists of points. Hard shadows trace the light's rays with one method.
#[derive(Debug, Clone)]
pub struct ShadePass {
    kernel: Kernel,
    method: Method,
}

impl ShadePass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, method: Method) -> Result<Self, GpuError> {
        let overrides = [("METHOD", method.code().into())];
        Ok(Self { kernel: Kernel::new(gpu, &shaders::SURFACE_SHADE, &overrides)?, method })
    }

    /// Prepares the shading of all `points`, with one [`Shade`] each.
    ///
    /// # Errors
    /// [`InputError`] for a view or a march out of bounds, for textures of another method or address mode, and
    /// for a buffer with too few shades; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        textures: &SurfaceTextures,
        march: &March,
        view: &super::ShadeView,
        points: &Buffer<ShadePoint>,
        shades: &Buffer<Shade>,
    ) -> Result<Job, Error> {
        view.validate()?;
        march.validate()?;
        textures.check(self.method, march)?;
        if shades.len() < points.len() {
            let bound = format!("must be at least {}, one a point", points.len());
            return Err(InputError::new("shades.len", shades.len(), bound).into());
        }
        let super::ShadeView { clip_from_world, eye, shadow_steps, softness } = *view;
        let view =
            Uniform::new(gpu, "shade view", &ShadeView { clip_from_world, eye, shadow_steps, softness })?;
        let march = Uniform::new(gpu, "march", &SurfaceMarch::from(*march))?;
        let plane = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (heights, acceleration) = (plane(&textures.heights), plane(&textures.acceleration));
        let resources = [
            view.raw().as_entire_binding(),
            march.raw().as_entire_binding(),
            wgpu::BindingResource::TextureView(&heights),
            wgpu::BindingResource::TextureView(&acceleration),
            points.raw().as_entire_binding(),
            shades.raw().as_entire_binding(),
        ];
        let step = Step {
            kernel: self.kernel.clone(),
            groups: vec![self.kernel.bind(gpu, 0, &resources)?],
            workgroups: self.kernel.spread(gpu, points.len() as u32),
        };
        Ok(Job::new(gpu, "surface/shade", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::layout_test;
    use std::mem::offset_of;

    layout_test!(view_layout: ShadeView = SURFACE_SHADE "ShadeView");

    #[test]
    fn points_and_shades_are_laid_out_as_the_shader_sees_them() {
        let layout = |name: &str| {
            let layout = shaders::SURFACE_SHADE.structs.iter().find(|layout| layout.name == name);
            let layout = layout.expect("a struct of the shader");
            (
                layout.size as usize,
                layout.members.iter().map(|member| member.offset as usize).collect::<Vec<_>>(),
            )
        };
        let point = [
            offset_of!(ShadePoint, light),
            offset_of!(ShadePoint, position),
            offset_of!(ShadePoint, ray),
            offset_of!(ShadePoint, hit),
        ];
        assert_eq!(layout("ShadePoint"), (size_of::<ShadePoint>(), point.to_vec()));
        let shade = [offset_of!(Shade, hard), offset_of!(Shade, soft), offset_of!(Shade, depth)];
        assert_eq!(layout("Shade"), (size_of::<Shade>(), shade.to_vec()));
    }
}
