//! What benchmarks of `kernels/surface/` share: rays, and bare texel loads to measure them against.

use crate::Error;
use crate::baseline::loads::LoadsPass;
use crate::gpu::{Buffer, Gpu, Job};
use crate::surface::material::Material;
use crate::surface::relief::Ray;
use crate::surface::relief::textures::SurfaceTextures;

/// Rays that meet a tile in `edge` places along each edge, row by row; `view` is the unit vector towards the eye.
pub(crate) fn rays(edge: u32, view: [f32; 3]) -> Vec<Ray> {
    let at = |index: u32| (index as f32 + 0.5) / edge as f32;
    let places = (0..edge).flat_map(|y| (0..edge).map(move |x| [at(x), at(y)]));
    places.map(|uv| Ray::new(uv, view, Material::default().scale, 1.0)).collect()
}

/// As many bare loads of texels as `loads` of `edge`² rays, and nothing else.
pub(crate) fn bare_loads(gpu: &Gpu, textures: &SurfaceTextures, edge: u32, loads: u64) -> Result<Job, Error> {
    let threads = u64::from(edge).pow(2);
    let sums = Buffer::new(gpu, "sums", threads as usize)?;
    let mean = (loads as f64 / threads as f64).round() as u32;
    LoadsPass::new(gpu)?.prepare(gpu, &textures.heights, [edge; 2], mean, &sums)
}
