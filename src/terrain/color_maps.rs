//! Computes the colour maps of a batch of patches, seen from above, on the host or on the device.

use rayon::prelude::*;

use super::blend::Shading;
use super::blend::reference::blend;
use super::config::Config;
use super::texture::{Texture, map_zones};
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
use {
    super::blend::BlendPass,
    super::fields::Fields,
    crate::Error,
    crate::gpu::{Buffer, Gpu},
};

/// The zones, textures and light of colour maps. A map has one sRGB pixel per sample, as RGBA with red in the
/// lowest byte.
#[derive(Debug, Clone, Copy)]
pub struct ColorMaps<'a> {
    /// The configuration: its zones, and the distance between samples.
    pub config: &'a Config,
    /// One texture per zone; only its mean colour is used.
    pub textures: &'a [Texture],
    /// The light, and how zone weights are blended.
    pub shading: &'a Shading,
}

impl ColorMaps<'_> {
    /// Computes the maps of windows of heights with one sample of margin, in parallel; `progress` is called
    /// for each map.
    pub fn on_host(&self, windows: &[Vec<i32>], progress: &(dyn Fn() + Sync)) -> Vec<Vec<u32>> {
        let zones = map_zones(&self.config.zones, self.textures);
        let width = self.config.patch_size as usize + 2;
        let map = |window: &Vec<i32>| {
            let pixels = blend(window, width, self.config.terrain_scale, &zones, self.shading);
            progress();
            pixels
        };
        windows.par_iter().map(map).collect()
    }

    /// Computes the maps of fields with one sample of margin on the device, and waits for it.
    ///
    /// # Errors
    /// The errors of [`BlendPass::prepare`].
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn on_device(&self, gpu: &Gpu, parts: &[Fields]) -> Result<Vec<Vec<u32>>, Error> {
        let pass = BlendPass::new(gpu)?;
        let zones = map_zones(&self.config.zones, self.textures);
        let points = (self.config.patch_size as usize).pow(2);
        let mut maps = Vec::new();
        for part in parts {
            let pixels = Buffer::new(gpu, "colour map", points * part.count as usize)?;
            let job = pass.prepare(gpu, self.config.terrain_scale, &zones, self.shading, part, &pixels)?;
            gpu.run("colour map", |encoder| job.record(encoder))?;
            maps.extend(pixels.read_blocking(gpu)?.chunks_exact(points).map(<[u32]>::to_vec));
        }
        Ok(maps)
    }
}
