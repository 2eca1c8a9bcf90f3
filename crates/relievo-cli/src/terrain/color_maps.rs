//! Computes the colour maps of a batch of patches, seen from above, on the host or on the device.

use rayon::prelude::*;

use relievo::gpu::{Buffer, Gpu};
use relievo::ops::terrain::blend::reference::blend;
use relievo::ops::terrain::blend::{BlendBuffers, BlendPass, Shading};
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::cover::Cover;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::texture::TerrainTexture;
use relievo::{Error, InputError};

/// The zones, textures and light of colour maps. A map has one sRGB pixel per sample, as RGBA with red in the
/// lowest byte.
#[derive(Debug, Clone, Copy)]
pub struct ColorMaps<'a> {
    /// The configuration: its zones, how their textures lie on the ground, and the distance between samples.
    pub config: &'a TerrainConfig,
    /// One texture per zone.
    pub textures: &'a [TerrainTexture],
    /// The patches, in the order of the windows.
    pub patches: &'a [[i32; 2]],
    /// The light, and how zone weights are blended.
    pub shading: &'a Shading,
}

impl ColorMaps<'_> {
    /// Computes the maps of windows of heights with one sample of margin, in parallel; `progress` is called
    /// for each map.
    ///
    /// # Errors
    /// The errors of [`Cover::new`].
    pub fn on_host(
        &self,
        windows: &[Vec<i32>],
        progress: &(dyn Fn() + Sync),
    ) -> Result<Vec<Vec<u32>>, InputError> {
        let cover = Cover::new(self.config, self.textures)?;
        let size = self.config.patch_size;
        let map = |(window, patch): (&Vec<i32>, &[i32; 2])| {
            let pixels = blend(window, size as usize + 2, &cover, self.shading, cover.place(*patch, size));
            progress();
            pixels
        };
        Ok(windows.par_iter().zip(self.patches).map(map).collect())
    }

    /// Computes the maps of fields with one sample of margin on the device, and waits for it.
    ///
    /// # Errors
    /// The errors of [`Cover::new`] and [`BlendPass::prepare`].
    pub fn on_device(&self, gpu: &Gpu, parts: &[Fields]) -> Result<Vec<Vec<u32>>, Error> {
        let pass = BlendPass::new(gpu)?;
        let cover = Cover::new(self.config, self.textures)?;
        let size = self.config.patch_size;
        let points = (size as usize).pow(2);
        let mut rest = self.patches;
        let mut maps = Vec::new();
        for part in parts {
            let (here, after) = rest.split_at(rest.len().min(part.count as usize));
            let places: Vec<_> = here.iter().map(|patch| cover.place(*patch, size)).collect();
            let places = Buffer::from_slice(gpu, "places", &places)?;
            let pixels = Buffer::new(gpu, "colour map", points * part.count as usize)?;
            let buffers = BlendBuffers { windows: part, places: &places, pixels: &pixels };
            let job = pass.prepare(gpu, &cover, self.shading, buffers)?;
            gpu.run("colour map", |encoder| job.record(encoder))?;
            maps.extend(pixels.read_blocking(gpu)?.chunks_exact(points).map(<[u32]>::to_vec));
            rest = after;
        }
        Ok(maps)
    }
}

/// Fields of heights that the host has, `width`² each, in parts of at most [`Fields::most`].
pub fn fields_of(gpu: &Gpu, width: u32, windows: &[Vec<i32>]) -> Result<Vec<Fields>, Error> {
    let part = |windows: &[Vec<i32>]| {
        let fields = Fields::new(gpu, "terrain heights", width, windows.len() as u32)?;
        fields.heights.write(gpu, &windows.concat())?;
        Ok(fields)
    };
    windows.chunks(Fields::most(gpu, width)).map(part).collect()
}
