//! Helpers of the parity and benchmark cases of `kernels/surface/`.

pub mod bounds;
pub mod cone_map;
pub mod depth;
pub mod height_pyramid;
pub mod penumbra;
pub mod relief;
pub mod shade;
pub mod tangent;

use relievo::gpu::{Buffer, Gpu, Job};
use relievo::ops::surface::ReliefMaterial;
use relievo::ops::surface::map::HeightMap;
use relievo::ops::surface::relief::ReliefRay;
use relievo::ops::surface::relief::textures::SurfaceTextures;
use relievo::{Error, InputError};

use crate::baseline::loads::LoadsPass;
use crate::cases::terrain::random_words;

/// The shapes of random maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Every texel is independent.
    Noise,
    /// Values 0, ½ and 1: flat plains, walls one texel thick, and the ends of the range.
    Plateaus,
    /// Low ground with single high texels.
    Posts,
    /// Slopes that rise and fall slowly.
    Hills,
}

impl Shape {
    /// Every shape.
    pub const ALL: [Self; 4] = [Self::Noise, Self::Plateaus, Self::Posts, Self::Hills];
}

/// A random map of a test case, the same on every machine.
///
/// # Errors
/// [`InputError`] for a size that no map can have.
pub fn random_map(case: u32, [width, height]: [u32; 2], shape: Shape) -> Result<HeightMap, InputError> {
    let words = random_words(case, (width * height) as usize);
    // 24 bits, which f32 represents exactly.
    let unit = |word: u32| (word >> 8) as f32 / 16_777_215.0;
    let heights = words.iter().enumerate().map(|(index, &word)| {
        let (x, y) = (index as u32 % width, index as u32 / width);
        match shape {
            Shape::Noise => unit(word),
            Shape::Plateaus => (word % 3) as f32 / 2.0,
            Shape::Posts if word % 37 == 0 => 0.9 + 0.1 * unit(word),
            Shape::Posts => 0.05 * unit(word),
            Shape::Hills => {
                let turn = |at: u32, waves: f32| (at as f32 / 8.0 * waves).sin();
                (0.5 + 0.2 * turn(x, 1.0) + 0.2 * turn(y, 1.7) + 0.1 * unit(word)).clamp(0.0, 1.0)
            }
        }
    });
    HeightMap::new(width, height, heights.collect())
}

/// Random rays: from straight down to flatter than the marching limit, along the axes, from behind, and
/// starting far outside the tile.
pub fn random_rays(case: u32, count: usize) -> Vec<ReliefRay> {
    let words = random_words(case ^ 0x5eed, 6 * count);
    let rays = words.chunks_exact(6).map(|words| {
        let unit = |word: u32| (word >> 8) as f32 / 16_777_216.0;
        let tiles = if words[0].is_multiple_of(8) { 40.0 } else { 1.0 };
        let uv = [tiles * (unit(words[0]) - 0.25), tiles * (unit(words[1]) - 0.25)];
        let turn = match words[2] % 8 {
            0 => (words[2] >> 28) as f32 * std::f32::consts::FRAC_PI_2,
            _ => unit(words[2]) * std::f32::consts::TAU,
        };
        let cosine = match words[3] % 16 {
            0 => 1.0,
            1 => -unit(words[3]),
            2 => 0.01 * unit(words[3]),
            _ => unit(words[3]),
        };
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let scale = [0.0, 0.02, 0.1, 0.3][words[4] as usize % 4];
        let plane = [1.0, 0.5, 0.0][words[5] as usize % 3];
        ReliefRay::new(uv, [turn.cos() * sine, turn.sin() * sine, cosine], scale, plane)
    });
    rays.collect()
}

/// Rays that meet a tile in `edge` places along each edge, row by row; `view` is the unit vector towards the eye.
pub(crate) fn rays(edge: u32, view: [f32; 3]) -> Vec<ReliefRay> {
    let at = |index: u32| (index as f32 + 0.5) / edge as f32;
    let places = (0..edge).flat_map(|y| (0..edge).map(move |x| [at(x), at(y)]));
    places.map(|uv| ReliefRay::new(uv, view, ReliefMaterial::default().scale, 1.0)).collect()
}

/// As many bare loads of texels as `loads` of `edge`² rays, and nothing else.
pub(crate) fn bare_loads(gpu: &Gpu, textures: &SurfaceTextures, edge: u32, loads: u64) -> Result<Job, Error> {
    let threads = u64::from(edge).pow(2);
    let sums = Buffer::new(gpu, "sums", threads as usize)?;
    let mean = (loads as f64 / threads as f64).round() as u32;
    LoadsPass::new(gpu)?.prepare(gpu, &textures.heights, [edge; 2], mean, &sums)
}
