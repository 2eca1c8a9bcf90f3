//! Traces rays and draws pictures, on the adapter or the CPU.

use image::RgbaImage;
use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::surface::relief::ReliefPass;
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::{Address, HeightMap, March, ReliefHit, ReliefMethod, ReliefRay, SurfaceTextures};
use relievo::render::Offscreen;
use relievo::render::target::LINEAR_FORMAT;

use crate::measure::relief::ReliefSquare;
use crate::measure::relief::picture::Scene;
use crate::measure::relief::square::camera;

/// Largest number of rays of a list: the hits of so many rays fit a binding of any device.
const LIST: usize = 1 << 22;

/// A method with its acceleration maps, ready to trace rays.
pub(super) enum Tracer<'a> {
    Cpu(ReliefMethod, ReliefSurface<'a>),
    Gpu(Box<Device>),
}

pub(super) struct Device {
    gpu: Gpu,
    textures: SurfaceTextures,
    pass: ReliefPass,
}

impl<'a> Tracer<'a> {
    pub fn new(
        map: &'a HeightMap,
        method: ReliefMethod,
        address: Address,
        gpu: Option<&Gpu>,
    ) -> Result<Self, Error> {
        let Some(gpu) = gpu else { return Ok(Self::Cpu(method, ReliefSurface::new(map, method, address))) };
        let textures = SurfaceTextures::new(gpu, map, method, address)?;
        let pass = ReliefPass::new(gpu, method)?;
        Ok(Self::Gpu(Box::new(Device { gpu: gpu.clone(), textures, pass })))
    }

    pub fn trace(&self, rays: &[ReliefRay], march: &March) -> Result<Vec<ReliefHit>, Error> {
        match self {
            Self::Cpu(method, surface) => Ok(surface.trace_all(*method, rays, march)),
            Self::Gpu(device) => device.trace(rays, march),
        }
    }

    /// Draws the picture with `finer` × `finer` samples per pixel.
    pub fn picture(
        &self,
        square: &ReliefSquare,
        background: [f32; 3],
        finer: u32,
    ) -> Result<RgbaImage, Error> {
        match self {
            Self::Cpu(method, surface) => {
                let scene = Scene {
                    surface,
                    method: *method,
                    march: &square.march,
                    albedo: &square.albedo,
                    normals: square.normals.as_ref(),
                    green: square.green,
                    shadow: square.shadow,
                    silhouette: square.silhouette,
                    material: &square.material,
                    view: square.view.scaled(finer),
                };
                Ok(scene.draw(background).reduced(finer).encoded())
            }
            Self::Gpu(device) => device.picture(square, background, finer),
        }
    }
}

impl Device {
    fn trace(&self, rays: &[ReliefRay], march: &March) -> Result<Vec<ReliefHit>, Error> {
        let mut all = Vec::with_capacity(rays.len());
        for list in rays.chunks(LIST) {
            let input = Buffer::from_slice(&self.gpu, "rays", list)?;
            let output = Buffer::new(&self.gpu, "hits", list.len())?;
            let job = self.pass.prepare(&self.gpu, &self.textures, march, &input, &output)?;
            self.gpu.run("relief", |encoder| job.record(encoder))?;
            all.extend(output.read_blocking(&self.gpu)?);
        }
        Ok(all)
    }

    fn picture(&self, square: &ReliefSquare, background: [f32; 3], finer: u32) -> Result<RgbaImage, Error> {
        let size = square.view.scaled(finer).size;
        let finer = if Offscreen::fits(&self.gpu, size, LINEAR_FORMAT) { finer } else { 1 };
        let view = square.view.scaled(finer);
        let target = Offscreen::linear(&self.gpu, view.size)?;
        target.draw(&mut square.scene(&self.gpu, &self.textures)?, camera(&view), background)?;
        Ok(target.read_linear(&self.gpu)?.reduced(finer).encoded())
    }
}
