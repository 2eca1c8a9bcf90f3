//! What traces rays and draws pictures: the adapter or the CPU.

use image::RgbaImage;
use relievo::Error;
use relievo::surface::picture::Scene;
use relievo::surface::relief::reference::Surface;
use relievo::surface::{Address, HeightMap, Hit, March, Method, Ray};

use super::Plan;
use crate::Context;
use crate::terrain::Backend;

/// A method with its maps, ready to trace.
pub enum Tracer<'a> {
    Cpu(Method, Surface<'a>),
    #[cfg(feature = "gpu")]
    Gpu(Box<device::Device>),
}

impl<'a> Tracer<'a> {
    pub fn new(
        map: &'a HeightMap,
        method: Method,
        address: Address,
        backend: Backend,
        context: &Context,
    ) -> Result<Self, Error> {
        match backend {
            Backend::Cpu => {
                let _ = context;
                Ok(Self::Cpu(method, Surface::new(map, method, address)))
            }
            #[cfg(feature = "gpu")]
            Backend::Gpu => {
                Ok(Self::Gpu(Box::new(device::Device::new(context.gpu()?, map, method, address)?)))
            }
            #[cfg(not(feature = "gpu"))]
            Backend::Gpu => {
                Err(relievo::InputError::new("backend", "gpu", "must be cpu: built without gpu").into())
            }
        }
    }

    pub fn trace(&self, rays: &[Ray], march: &March) -> Result<Vec<Hit>, Error> {
        match self {
            Self::Cpu(method, surface) => Ok(surface.trace_all(*method, rays, march)),
            #[cfg(feature = "gpu")]
            Self::Gpu(device) => device.trace(rays, march),
        }
    }

    /// The picture, drawn with `finer` × `finer` samples a pixel.
    pub fn picture(&self, plan: &Plan, background: [f32; 3], finer: u32) -> Result<RgbaImage, Error> {
        match self {
            Self::Cpu(method, surface) => {
                let scene = Scene {
                    surface,
                    method: *method,
                    march: &plan.march,
                    albedo: &plan.albedo,
                    normals: plan.normals.as_ref(),
                    green: plan.green,
                    shadow: plan.shadow,
                    silhouette: plan.silhouette,
                    material: &plan.material,
                    view: plan.view.scaled(finer),
                };
                Ok(scene.draw(background).reduced(finer).encoded())
            }
            #[cfg(feature = "gpu")]
            Self::Gpu(device) => device.picture(plan, background, finer),
        }
    }

    /// Name and driver of the adapter.
    pub fn adapter(&self) -> Option<[String; 2]> {
        match self {
            Self::Cpu(..) => None,
            #[cfg(feature = "gpu")]
            Self::Gpu(device) => Some(device.adapter()),
        }
    }
}

#[cfg(feature = "gpu")]
mod device {
    use super::*;
    use relievo::gpu::{Buffer, Gpu};
    use relievo::render::SquarePicture;
    use relievo::surface::relief::ReliefPass;
    use relievo::surface::relief::textures::SurfaceTextures;

    /// Rays of one list: their hits fit a binding of any device.
    const LIST: usize = 1 << 22;

    pub struct Device {
        gpu: Gpu,
        textures: SurfaceTextures,
        pass: ReliefPass,
    }

    impl Device {
        pub fn new(gpu: Gpu, map: &HeightMap, method: Method, address: Address) -> Result<Self, Error> {
            let textures = SurfaceTextures::new(&gpu, map, method, address)?;
            let pass = ReliefPass::new(&gpu, method)?;
            Ok(Self { gpu, textures, pass })
        }

        pub fn trace(&self, rays: &[Ray], march: &March) -> Result<Vec<Hit>, Error> {
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

        pub fn picture(&self, plan: &Plan, background: [f32; 3], finer: u32) -> Result<RgbaImage, Error> {
            let available = self.gpu.device().limits().max_texture_dimension_2d;
            let bytes = 4
                * u64::from(finer * finer)
                * plan.view.size.iter().map(|edge| u64::from(*edge)).product::<u64>();
            let fits = plan.view.size.iter().all(|edge| finer * edge <= available)
                && bytes <= self.gpu.max_binding();
            let finer = if fits { finer } else { 1 };
            let picture = SquarePicture {
                textures: &self.textures,
                albedo: &plan.albedo,
                normals: plan.normals.as_ref(),
                green: plan.green,
                shadow: plan.shadow,
                silhouette: plan.silhouette,
                material: plan.material,
                march: plan.march,
                view: plan.view.scaled(finer),
            };
            let image = picture.draw(&self.gpu, background)?;
            Ok(image.reduced(finer).encoded())
        }

        pub fn adapter(&self) -> [String; 2] {
            [self.gpu.adapter().name.clone(), self.gpu.adapter().driver.clone()]
        }
    }
}
